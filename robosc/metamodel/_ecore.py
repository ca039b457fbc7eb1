"""Loads the .ecore files once and hands out their classes as Python classes."""

from functools import cache
from typing import Any

from pyecore.ecore import EClass, EPackage
from pyecore.resources import URI, ResourceSet

from robosc.resources import locate

PACKAGES = ("expression", "robosc", "sct", "rosgraph")


@cache
def packages() -> dict[str, EPackage]:
    """All metamodels by name, their references to each other resolved."""
    resources = ResourceSet()
    loaded = {
        name: resources.get_resource(URI(str(locate(f"metamodel/{name}.ecore")))).contents[0] for name in PACKAGES
    }
    for package in loaded.values():
        for classifier in package.eClassifiers:
            if isinstance(classifier, EClass):
                # A Python class follows only the proxies that were resolved before it is made.
                for parent in classifier.eSuperTypes:
                    _ = parent.name
                for feature in classifier.eStructuralFeatures:
                    _ = feature.eType.name
    return loaded


def classes(package: str) -> dict[str, Any]:
    """The classes of one metamodel as Python classes, and its enumerations, by name."""
    return {
        classifier.name: classifier.python_class if isinstance(classifier, EClass) else classifier
        for classifier in packages()[package].eClassifiers
    }
