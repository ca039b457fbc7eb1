"""Class diagrams of the metamodels: they are complete, and those in the documentation are up to date."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from robosc.model.reflection import metamodel
from robosc.tools.diagrams import METAMODELS, NOTATIONS, metamodel_diagram

DOCS = Path(__file__).parents[3] / "docs" / "metamodels"
ENDINGS = {"mermaid": "mmd", "plantuml": "puml", "svg": "svg"}
EACH = pytest.mark.parametrize(
    ("name", "notation"), [(name, notation) for name in METAMODELS for notation in NOTATIONS]
)


@EACH
def test_the_documentation_is_up_to_date(name: str, notation: str, golden) -> None:
    golden(DOCS / f"{name}.{ENDINGS[notation]}", metamodel_diagram(name, notation))


@EACH
def test_all_classes_and_features_are_shown(name: str, notation: str) -> None:
    text = metamodel_diagram(name, notation)
    if notation == "svg":
        text = " ".join(ElementTree.fromstring(text).itertext())  # noqa: S314 - our own
    for classifier in metamodel(name).eClassifiers:
        if not hasattr(classifier, "eSuperTypes") and not hasattr(classifier, "eLiterals"):
            continue  # a data type, whose name is with the features
        members = getattr(classifier, "eLiterals", None) or classifier.eStructuralFeatures
        for element in [classifier, *members]:
            assert element.name in text


def test_links_are_those_of_the_metamodel() -> None:
    mermaid, plantuml = (metamodel_diagram("sct", notation) for notation in ("mermaid", "plantuml"))
    for text in (mermaid, plantuml):
        assert 'Plant *-- "1..*" Location : locations' in text
        assert 'Edge --> "1" Location : target' in text
    assert "  NamedElement <|-- Plant\n" in mermaid
    assert "expression.NamedElement <|-- Plant\n" in plantuml


def test_lines_of_svg() -> None:
    root = ElementTree.fromstring(metamodel_diagram("rosgraph", "svg"))  # noqa: S314 - our own
    kinds = [path.get("class") for path in root.iter("{http://www.w3.org/2000/svg}path")]
    inheritances = sum(
        parent.ePackage.name == "rosgraph"
        for classifier in metamodel("rosgraph").eClassifiers
        for parent in getattr(classifier, "eSuperTypes", ())
    )
    assert kinds.count("inheritance") == kinds.count("inheritance open") == inheritances > 0
    assert kinds.count("containment") == kinds.count("containment open") > 10


@pytest.mark.parametrize(("name", "notation"), [("uml", "svg"), ("sct", "png")])
def test_what_there_is_no_diagram_of(name: str, notation: str) -> None:
    with pytest.raises(ValueError, match="no diagram of"):
        metamodel_diagram(name, notation)
