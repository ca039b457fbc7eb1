"""Eclipse EMF as a second reader of all files that robosc writes in its format."""

import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from robosc.base.files.resources import locate
from robosc.model import robosc
from robosc.model.validity import load
from robosc.model.xmi import to_texts
from tests.sct_models import edge, model, needs, plant

pytestmark = pytest.mark.build

JARS = [
    Path("/usr/share/java") / f"{name}.jar"
    for name in ("eclipse-emf-common", "eclipse-emf-ecore", "eclipse-emf-ecore-xmi", "equinox-common")
]
METAMODELS = [locate(f"metamodel/{name}.ecore") for name in ("expression", "robosc", "sct", "rosgraph", "engine")]


@pytest.fixture(scope="session")
def java(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Run a Java program of the tests; return its exit status and output."""
    absent = [program for program in ("javac", "java") if shutil.which(program) is None]
    absent += [jar.name for jar in JARS if not jar.exists()]
    if absent:
        message = f"no {', '.join(absent)}: install openjdk-17-jdk-headless and libeclipse-emf-ecore-xmi-java"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    classes = tmp_path_factory.mktemp("emf")
    jars = ":".join(map(str, JARS))
    sources = sorted(Path(__file__).parent.glob("*.java"))
    subprocess.run(["javac", "-Xlint:all", "-Werror", "-d", classes, "-cp", jars, *sources], check=True)

    def run(name: str, *arguments: str | Path) -> tuple[int, str]:
        command = ["java", "-XX:TieredStopAtLevel=1", "-Xshare:auto", "-cp", f"{classes}:{jars}", name]
        done = subprocess.run([*command, *arguments], capture_output=True, text=True, check=False)
        assert done.stderr == ""
        return done.returncode, done.stdout

    return run


@pytest.fixture(scope="session")
def emf(java: Any) -> Any:
    """Let EMF load and validate models."""
    return lambda *models, metamodels=METAMODELS: java("EmfCheck", *metamodels, "--", *models)


def test_the_metamodels_are_valid(emf: Any) -> None:
    assert emf() == (0, f"{len(METAMODELS)} files, 0 diagnostics\n")


def test_all_saved_models_are_valid(emf: Any, folder: Path, texts: dict[str, str]) -> None:
    assert emf(*(folder / name for name in texts)) == (0, f"{len(METAMODELS) + len(texts)} files, 0 diagnostics\n")


def test_a_supervisor_and_odd_texts_are_valid(emf: Any, tmp_path: Path) -> None:
    given = model(
        [
            plant(
                "p", {"a": [edge("e", "b")], "b": []}, controllable=["e"], origin=" <&>\"' \n\t\r größer 🤖 ", topic=""
            )
        ],
        [needs("e", "p.a", text="]]>")],
        guards={"e": ("p.a", "not p.b")},
    )
    given.supervisor.controlledStates = 10**40
    given.supervisor.settlingBound = 2**63 - 1
    (tmp_path / "p.sct.xmi").write_bytes(to_texts({"p": given})["p"].encode())
    assert emf(tmp_path / "p.sct.xmi") == (0, f"{len(METAMODELS) + 1} files, 0 diagnostics\n")


def test_what_emf_saves_is_the_same_model(java: Any, folder: Path, texts: dict[str, str]) -> None:
    paths = [folder / name for name in texts]
    assert java("EmfSave", *METAMODELS, *paths) == (0, "")
    assert [path.read_text() for path in paths] != list(texts.values())
    graph, robot = load(folder / "Warehouse.rosgraph.xmi"), load(folder / "Warehouse.robosc.xmi")
    [library] = {
        definition.type.library
        for definition in robot.definitions
        if isinstance(getattr(definition, "type", None), robosc.ImportedComponent)
    }
    roots = {
        "Warehouse.robosc.xmi": robot,
        "Warehouse.sct.xmi": graph.model,
        "Warehouse.rosgraph.xmi": graph,
        "EmergencyStopLibrary.robosc.xmi": library,
    }
    assert to_texts(roots) == texts


FAULTS = [
    ("Warehouse.sct.xmi", 'kind="action"', 'kind="acton"', "Value 'acton' is not legal"),
    ("Warehouse.sct.xmi", "<events source=", "<events sauce=", "Feature 'sauce' not found"),
    ("Warehouse.sct.xmi", "/@events.0", "/@events.9", "Unresolved reference"),
    ("Warehouse.rosgraph.xmi", "Warehouse.sct.xmi", "Nothing.sct.xmi", "Nothing.sct.xmi"),
    ("Warehouse.robosc.xmi", '<type xsi:type="robosc:StringDataType"', '<type xsi:type="robosc:DataType"', "DataType"),
]


@pytest.mark.parametrize("fault", FAULTS, ids=[case[2] for case in FAULTS])
def test_emf_does_complain(emf: Any, folder: Path, fault: tuple[str, str, str, str]) -> None:
    file, old, new, complaint = fault
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new))
    status, said = emf(folder / file)
    assert status == 1
    assert complaint in said


def test_emf_does_complain_about_metamodels(emf: Any, tmp_path: Path) -> None:
    for metamodel in METAMODELS:
        text = metamodel.read_text()
        (tmp_path / metamodel.name).write_text(text.replace('eType="#//Location"', 'eType="#//Place"'))
    status, said = emf(metamodels=[tmp_path / metamodel.name for metamodel in METAMODELS])
    assert status == 1
    assert "Place" in said
