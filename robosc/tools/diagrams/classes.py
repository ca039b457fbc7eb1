"""Contents of the class diagram of a metamodel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.model.reflection import documentation, is_attribute, metamodel

if TYPE_CHECKING:
    from collections.abc import Sequence

_TYPES = {"EString": "String", "EBoolean": "Boolean", "Place": "Place"}
_TYPES |= dict.fromkeys(("ELong", "ELongObject", "EBigInteger"), "Integer")
_TYPES |= dict.fromkeys(("EDouble", "EDoubleObject"), "Double")


@dataclass(frozen=True)
class Feature:
    """An attribute, or a reference if `reference`; `own` is true if its type is of the same metamodel."""

    name: str
    type: str
    multiplicity: str
    reference: bool
    containment: bool
    own: bool


@dataclass(frozen=True)
class Class:
    """A class, or an enumeration if it has literals. Parents of other metamodels are qualified."""

    name: str
    abstract: bool
    documentation: str
    parents: Sequence[str]
    foreign_parents: Sequence[str]
    features: Sequence[Feature]
    literals: Sequence[str]


@dataclass(frozen=True)
class ClassDiagram:
    """The classes of a metamodel, in the order of its .ecore file."""

    name: str
    documentation: str
    classes: Sequence[Class]

    @classmethod
    def of(cls, name: str) -> ClassDiagram:
        """Return the diagram of a metamodel."""
        package = metamodel(name)
        shown = [classifier for classifier in package.eClassifiers if classifier.name not in _TYPES]
        return cls(name, documentation(package), [_class(classifier, package) for classifier in shown])


def _class(classifier: Any, package: Any) -> Class:
    parents = [(parent, parent.ePackage.name == package.name) for parent in getattr(classifier, "eSuperTypes", ())]
    return Class(
        name=classifier.name,
        abstract=getattr(classifier, "abstract", False),
        documentation=documentation(classifier),
        parents=[parent.name for parent, own in parents if own],
        foreign_parents=[f"{parent.ePackage.name}.{parent.name}" for parent, own in parents if not own],
        features=[_feature(feature, package) for feature in getattr(classifier, "eStructuralFeatures", ())],
        literals=[literal.name for literal in getattr(classifier, "eLiterals", ())],
    )


def _feature(feature: Any, package: Any) -> Feature:
    target = feature.eType
    plain = target.name in _TYPES
    own = not plain and target.ePackage.name == package.name
    upper = "*" if feature.upperBound < 0 else str(feature.upperBound)
    lower = str(feature.lowerBound)
    return Feature(
        name=feature.name,
        type=_TYPES[target.name] if plain else target.name if own else f"{target.ePackage.name}.{target.name}",
        multiplicity=lower if lower == upper else f"{lower}..{upper}",
        reference=not is_attribute(feature),
        containment=not is_attribute(feature) and feature.containment,
        own=own,
    )
