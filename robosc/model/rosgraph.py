"""Classes of `metamodel/rosgraph.ecore`. `rosgraph.pyi`, generated from it, declares them for type checkers."""

from robosc.model._ecore import classes as _classes

globals().update(_classes("rosgraph"))
