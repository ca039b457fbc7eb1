"""Loads the .ecore files once and provides their classes as Python classes."""

import re
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

from pyecore.ecore import EClass, EPackage
from pyecore.resources import URI, ResourceSet

from robosc.base.files.resources import locate
from robosc.model.places import Place

PACKAGES = ("expression", "robosc", "sct", "rosgraph", "engine")


class _Undocumented(URI):  # type: ignore[misc]
    """A metamodel's file without its documentation, which is two thirds of its elements and not needed by programs."""

    def create_instream(self) -> BytesIO:
        return BytesIO(re.sub(b"<eAnnotations .*?</eAnnotations>", b"", Path(self.plain).read_bytes(), flags=re.DOTALL))

    def close_stream(self) -> None:
        """Do nothing: no stream is open."""


@cache
def packages(*, documented: bool = False) -> dict[str, EPackage]:
    """Return all metamodels by name, with resolved references. Documented metamodels have no instances."""
    resources = ResourceSet()
    kind = URI if documented else _Undocumented
    loaded = {
        name: resources.get_resource(kind(str(locate(f"metamodel/{name}.ecore")))).contents[0] for name in PACKAGES
    }
    loaded["expression"].getEClassifier("Place").eType = Place
    for package in loaded.values():
        for classifier in package.eClassifiers:
            if isinstance(classifier, EClass):
                # A Python class follows only proxies that are resolved before its creation.
                for parent in classifier.eSuperTypes:
                    _ = parent.name
                for feature in classifier.eStructuralFeatures:
                    _ = feature.eType.name
    return loaded


def classes(package: str) -> dict[str, Any]:
    """Return the Python classes and the enumerations of one metamodel by name."""
    return {
        classifier.name: _python_class(classifier) if isinstance(classifier, EClass) else classifier
        for classifier in packages()[package].eClassifiers
    }


def _python_class(eclass: EClass) -> Any:
    python_class = eclass.python_class
    # Models have no observers. To detect this at every change, pyecore would climb to the root recursively.
    python_class.notify = _nobody_listens
    return python_class


def _nobody_listens(_element: Any, _notification: Any) -> None:
    pass
