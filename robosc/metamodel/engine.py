"""The classes of `metamodel/engine.ecore`; `engine.pyi`, generated from it, shows them to type checkers."""

from robosc.metamodel._ecore import classes as _classes

globals().update(_classes("engine"))
