"""Write the type stubs of the metamodel modules: `python scripts/metamodel_stubs.py`."""

from pathlib import Path

from pyecore.ecore import EClass, EClassifier, EPackage, EStructuralFeature

from robosc import model
from robosc.model._ecore import PACKAGES, packages
from robosc.model.reflection import documentation

_TYPES = {
    "EString": "str",
    "EBoolean": "bool",
    "ELong": "int",
    "ELongObject": "int",
    "EBigInteger": "int",
    "EDouble": "float",
    "EDoubleObject": "float",
    "Place": "Place",
}


def _type(feature: EStructuralFeature, package: EPackage) -> str:
    target = feature.eType
    name: str = _TYPES.get(target.name, target.name)
    if target.name not in _TYPES and target.ePackage is not package:
        name = f"{target.ePackage.name}.{name}"
    return name


def _parameter(feature: EStructuralFeature, package: EPackage) -> str:
    kind = _type(feature, package)
    return f"{feature.name}: Iterable[{kind}] = ..." if feature.many else f"{feature.name}: {kind} | None = ..."


def _attribute(feature: EStructuralFeature, package: EPackage) -> str:
    kind = _type(feature, package)
    if feature.many:
        return f"{feature.name}: MutableSequence[{kind}]"
    # A required feature exists in every valid model, so its type is not optional.
    return f"{feature.name}: {kind}" if feature.lowerBound else f"{feature.name}: {kind} | None"


def stub(name: str) -> str:
    """Return the text of the stub of one metamodel module."""
    package = packages(documented=True)[name]
    used = _types(package)
    others = [other for other in PACKAGES if other != name and any(target.ePackage.name == other for target in used)]
    lines = [
        f'"""Generated from metamodel/{name}.ecore by `python scripts/metamodel_stubs.py`."""',
        "",
        "from collections.abc import Iterable, MutableSequence",
        "from typing import Any, ClassVar",
        "",
    ]
    lines += [f"from robosc.model import {', '.join(others)}"] if others else []
    lines += ["from robosc.model.places import Place"] if "Place" in {target.name for target in used} else []
    lines += [""]
    for classifier in package.eClassifiers:
        if classifier.name == "Place":
            continue  # a Python class
        doc = f'    """{documentation(classifier)}"""'
        if not isinstance(classifier, EClass):
            lines += [f"class {classifier.name}:", doc, "    name: str"]
            lines += [f"    {literal.name}: ClassVar[{classifier.name}]" for literal in classifier.eLiterals]
            lines += [""]
            continue
        parents = ", ".join(
            parent.name if parent.ePackage is package else f"{parent.ePackage.name}.{parent.name}"
            for parent in classifier.eSuperTypes
        )
        lines += [f"class {classifier.name}({parents}):" if parents else f"class {classifier.name}:", doc]
        lines += [f"    {_attribute(feature, package)}" for feature in classifier.eStructuralFeatures]
        if not parents:
            lines += ["    def eContainer(self) -> Any: ...", "    @property", "    def eClass(self) -> Any: ..."]
        features = classifier.eAllStructuralFeatures()
        parameters = ", ".join(
            ["self", *(["*"] if features else []), *(_parameter(feature, package) for feature in features)]
        )
        lines += [f"    def __init__({parameters}) -> None: ...", ""]
    return "\n".join(lines)


def _types(package: EPackage) -> set[EClassifier]:
    """Return the classifiers that a package's classes inherit from or have features of, if they have a package."""
    used = set()
    for classifier in package.eClassifiers:
        if isinstance(classifier, EClass):
            used |= {*classifier.eSuperTypes, *(feature.eType for feature in classifier.eAllStructuralFeatures())}
    return {target for target in used if target.ePackage is not None}


if __name__ == "__main__":
    for package in PACKAGES:
        Path(model.__file__).with_name(f"{package}.pyi").write_text(stub(package), encoding="utf-8")
