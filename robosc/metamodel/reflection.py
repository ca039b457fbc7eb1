"""What the metamodels declare and what models contain, always in the order of the .ecore text."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from pyecore.ecore import EAttribute, EClass

from robosc.metamodel._ecore import packages


@cache
def features(metaclass: EClass) -> Mapping[str, Any]:
    """The attributes and references of a class by name, inherited ones first."""
    found: dict[str, Any] = {}
    for parent in metaclass.eSuperTypes:
        found |= features(parent)
    return found | {feature.name: feature for feature in metaclass.eStructuralFeatures}


def is_attribute(feature: Any) -> bool:
    """Whether the feature holds plain values; if not it is a reference."""
    return isinstance(feature, EAttribute)


@cache
def _containments(metaclass: EClass) -> Sequence[tuple[str, bool]]:
    """The names of the references of a class that contain, each with whether there may be many."""
    found = features(metaclass).items()
    return [(name, feature.many) for name, feature in found if not is_attribute(feature) and feature.containment]


def contents(element: Any) -> Iterator[tuple[str, Any]]:
    """The elements directly inside an element, each with its step in a fragment path (`@plants.0`, `@guard`)."""
    for name, many in _containments(element.eClass):
        value = getattr(element, name)
        if many:
            yield from ((f"@{name}.{index}", child) for index, child in enumerate(value))
        elif value is not None:
            yield f"@{name}", value


def tree(root: Any) -> Iterator[tuple[str, Any]]:
    """An element and all below it, each before what it contains, with its step in a fragment path, empty for the root.

    Takes time in proportion to the number of elements, however deep they are inside each other.
    """
    pending = [("", root)]
    while pending:
        step, element = pending.pop()
        yield step, element
        pending += reversed(list(contents(element)))


def literals(enumeration: Any) -> list[str]:
    """The names of the values of an enumeration."""
    return [literal.name for literal in enumeration.eLiterals]


def metamodel(name: str) -> Any:
    """The package that an .ecore file declares, with its documentation. Raises KeyError where there is no such file."""
    return packages(documented=True)[name]


def documentation(element: Any) -> str:
    """What the .ecore file says of a package, class or feature."""
    return str(element.eAnnotations[0].details["documentation"])
