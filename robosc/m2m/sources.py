"""Carries the places in the text over to the models that come from it."""

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc


def source(element: ex.Located, home: robosc.Base) -> str | None:
    """`file:line:column-line:column` of an element of a base; None where no text was read."""
    return f"{home.file}:{element.source}" if element.source and home.file else None
