"""The classes of `metamodel/rosgraph.ecore`; `rosgraph.pyi`, generated from it, shows them to type checkers."""

from robosc.metamodel._ecore import classes as _classes

globals().update(_classes("rosgraph"))
