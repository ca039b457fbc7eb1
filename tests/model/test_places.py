"""Origins of elements: full paths, which distinguish two files of one name."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.base.diagnostics import START, Span
from robosc.model import sct
from robosc.model.places import Place, SourceFile, place
from robosc.model.validity import load
from robosc.model.xmi import to_texts
from robosc.tools.cli import main


@pytest.mark.parametrize(
    ("text", "file", "span"),
    [
        ("3:5-4:12", None, Span(3, 5, 4, 12)),
        ("models/a:b.rscd:3:5-3:12", "models/a:b.rscd", Span(3, 5, 3, 12)),
        ("1:2:3:5-3:12", "1:2", Span(3, 5, 3, 12)),
    ],
)
def test_text_of_a_place(text: str, file: str | None, span: Span) -> None:
    found = Place.parse(text)
    assert found == Place(SourceFile(file) if file else None, span)
    assert str(found) == text


@pytest.mark.parametrize("text", ["", "3:5", "a:b-c:d", ":3:5-3:12", "3:5-3:1234567890", "a.rscd"])
def test_no_place(text: str) -> None:
    assert Place.parse(text) is None


def test_files_are_known_by_name() -> None:
    files: dict[str, SourceFile] = {}
    place, other = Place.parse("a.rscd:1:1-1:2", files), Place.parse("2:1-2:2", files, "a.rscd")
    assert place is not None
    assert other is not None
    assert place.file is other.file
    files["a.rscd"].path = "../models/a.rscd"
    assert place.file is not None
    assert place.file.path == "../models/a.rscd"


def test_place_of_an_element_without_one() -> None:
    plant = sct.Plant(name="p")
    model = sct.SupervisoryControlModel(name="m", plants=[plant])
    assert place(plant) == ("m", START)
    model.source = Place.parse("3:1-3:4")
    assert place(plant) == ("m", Span(3, 1, 3, 4))
    model.source = Place.parse("a.rscd:3:1-3:4")
    assert place(plant) == ("a.rscd", Span(3, 1, 3, 4))
    assert place(sct.SupervisoryControlModel()) == ("model", START)


#: A library whose file has the name of the robot's file, with a fault near its end that only synthesis finds.
LIBRARY = (
    "library Arms {\n"
    + "\n" * 20
    + """  component Arm {
    outgoing message move with type: none
    behaviour {
      initial marked state Idle { on response from move goto Stuck }
      state Stuck { }
    }
  }
}
"""
)
ROBOT = "robot Two {\n  component Arm from Arms import Arm\n}\n"


@pytest.fixture
def _two(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "r.rscd").write_text(ROBOT)
    (tmp_path / "parts/r.rscd").write_text(LIBRARY)
    monkeypatch.chdir(tmp_path)


def sources(root: object) -> set[str]:
    return {element.source.file.name for element in [root, *root.eAllContents()] if element.source}  # type: ignore[attr-defined]


@pytest.mark.usefixtures("_two")
def test_two_files_of_one_name_stay_two_in_every_model() -> None:
    robot = robosc.load("r.rscd", ["parts"])
    model = robosc.to_sct(robot)
    graph = robosc.to_rosgraph(robot)
    assert sources(model) == {"r.rscd", "parts/r.rscd"}
    assert sources(graph) <= {"r.rscd", "parts/r.rscd"}
    arm, stuck = next(
        (plant, location) for plant in model.plants for location in plant.locations if location.name == "Stuck"
    )
    assert place(stuck) == ("parts/r.rscd", Span(26, 7, 26, 22))
    assert place(arm) == ("r.rscd", Span(2, 3, 2, 37))
    for name, text in to_texts({"Two.sct.xmi": model, "Two.rosgraph.xmi": graph}).items():
        Path(name).write_text(text)
    loaded = load("Two.rosgraph.xmi")
    assert [element.source for element in loaded.model.eAllContents()] == [
        element.source for element in model.eAllContents()
    ]
    assert (
        to_texts({"Two.sct.xmi": loaded.model, "Two.rosgraph.xmi": loaded})["Two.sct.xmi"]
        == Path("Two.sct.xmi").read_text()
    )


@pytest.mark.usefixtures("_two")
@pytest.mark.parametrize("form", ["json", "sarif"])
def test_findings_name_the_right_one(form: str) -> None:
    Path("parts/r.rscd").write_text(LIBRARY.replace("state Stuck", "state Idle"))
    answer = CliRunner().invoke(main, ["check", "r.rscd", "-I", "parts", "--format", form])
    if form == "json":
        found = {(finding["file"], finding["line"]) for finding in json.loads(answer.stdout)}
    else:
        found = set()
        for result in json.loads(answer.stdout)["runs"][0]["results"]:
            where = result["locations"][0]["physicalLocation"]
            found.add((where["artifactLocation"]["uri"], where["region"]["startLine"]))
    assert ("parts/r.rscd", 25) in found
    assert not {line for file, line in found if file == "r.rscd"} - {1, 2, 3}


def test_a_model_that_was_saved_before_places_had_files(tmp_path: Path) -> None:
    path = tmp_path / "Old.robosc.xmi"
    path.write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<robosc:Robot xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:robosc="urn:robosc:robosc:1"'
        ' source="1:1-9:2" name="Old" file="old.rscd">\n'
        '  <definitions xsi:type="robosc:Component" source="2:3-4:4" name="C">\n'
        '    <type xsi:type="robosc:LocalComponent" source="2:15-4:4"/>\n'
        "  </definitions>\n</robosc:Robot>\n"
    )
    robot = load(path)
    assert place(robot.definitions[0]) == ("old.rscd", Span(2, 3, 4, 4))
    located = load(path, locate={"old.rscd": "../old.rscd"}.get)
    assert place(located.definitions[0].type)[0] == "../old.rscd"
