"""Features of the metamodels and contents of models, always in the order of the .ecore text."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from pyecore.ecore import EAttribute, EClass

from robosc.model._ecore import packages


@cache
def features(metaclass: EClass) -> Mapping[str, Any]:
    """Return the attributes and references of a class by name, inherited ones first."""
    inherited: dict[str, Any] = {}
    for parent in metaclass.eSuperTypes:
        inherited |= features(parent)
    return inherited | {feature.name: feature for feature in metaclass.eStructuralFeatures}


def is_attribute(feature: Any) -> bool:
    """Return whether the feature is an attribute. If not, it is a reference."""
    return isinstance(feature, EAttribute)


@cache
def _containments(metaclass: EClass) -> Sequence[tuple[str, bool]]:
    """Return the names of the containment references of a class, each with whether it has many values."""
    features_by_name = features(metaclass).items()
    return [
        (name, feature.many) for name, feature in features_by_name if not is_attribute(feature) and feature.containment
    ]


def contents(element: Any) -> Iterator[tuple[str, Any]]:
    """Iterate over the elements directly inside an element, each with its fragment step (`@plants.0`, `@guard`)."""
    for name, many in _containments(element.eClass):
        value = getattr(element, name)
        if many:
            yield from ((f"@{name}.{index}", child) for index, child in enumerate(value))
        elif value is not None:
            yield f"@{name}", value


def place_or_refer(element: Any, name: str, child: Any) -> None:
    """Put a child into an element. A child that is in another element stays there, and the element refers to it.

    An expression can be large and the same in many places. Only readers that do not ask for its container may get it.
    """
    if child.eContainer() is None:
        setattr(element, name, child)
    else:
        getattr(element, name)  # creates the slot
        element.__dict__[name]._value = child  # noqa: SLF001 - `setattr` would take it out of its container


def tree(root: Any) -> Iterator[tuple[str, Any]]:
    """Iterate over an element and all elements below it in preorder, each with its fragment step, "" for the root.

    Takes linear time at any depth.
    """
    pending = [("", root)]
    while pending:
        step, element = pending.pop()
        yield step, element
        pending += reversed(list(contents(element)))


def literals(enumeration: Any) -> list[str]:
    """Return the names of an enumeration's values."""
    return [literal.name for literal in enumeration.eLiterals]


def metamodel(name: str) -> Any:
    """Return the documented package of an .ecore file. Raises KeyError if there is no such file."""
    return packages(documented=True)[name]


def documentation(element: Any) -> str:
    """Return the documentation of a package, class or feature in the .ecore file."""
    return str(element.eAnnotations[0].details["documentation"])
