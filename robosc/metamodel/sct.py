"""The classes of `metamodel/sct.ecore`; `sct.pyi`, generated from it, shows them to type checkers."""

from robosc.metamodel._ecore import classes as _classes

globals().update(_classes("sct"))
