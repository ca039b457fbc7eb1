"""Search paths of libraries, and faults in libraries."""

import os
from pathlib import Path

import pytest

from robosc.base.files.resources import locate
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.model import robosc as rsc
from robosc.model.places import place
from tests.language.texts import places, reading, underlined

ROBOT = "robot R {\n  component C from L import C\n}\n"


def library(message: str, name: str = "L") -> str:
    return f"library {name} {{ component C {{ outgoing message {message} with type: none }} }}"


def message_of(base: rsc.Base | None) -> str:
    assert base is not None
    return str(base.definitions[0].type.definition.type.definitions[0].name)


def test_folders_are_searched_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("beside", "first", "second", "environment")
    for name in names:
        (tmp_path / name).mkdir()
        (tmp_path / name / f"some_{name}.rscd").write_text(library(name))
    robot = tmp_path / "beside" / "robot.rscd"
    robot.write_text(ROBOT)
    monkeypatch.setenv("ROBOSC_PATH", os.pathsep.join(["", str(tmp_path / "nowhere"), str(tmp_path / "environment")]))
    given = [tmp_path / "first", str(tmp_path / "second")]
    for name in names:
        assert message_of(read(robot, given).base) == name
        (tmp_path / name / f"some_{name}.rscd").unlink()
    assert underlined(read(robot, given)) == [("unresolved-reference", "L")]


def test_the_standard_library_is_searched_last(tmp_path: Path) -> None:
    robot = "robot R { component C from EmergencyStopLibrary import EmergencyStop }"
    assert message_of(reading(tmp_path, robot).base) == "stop"
    own = library("own", "EmergencyStopLibrary").replace("component C", "component EmergencyStop")
    assert message_of(reading(tmp_path, robot, any_name=own).base) == "own"


def test_the_standard_library_holds_no_fault() -> None:
    files = sorted(locate("stdlib").glob("*.rscd"))
    readings = [read(file) for file in files]
    assert [library_read.findings for library_read in readings] == [[]] * len(files)
    names = {library_read.base.name for library_read in readings if library_read.base}
    assert names >= {"EmergencyStopLibrary", "TurtlebotLibrary"}


@pytest.mark.parametrize(
    ("library_name", "data", "ros_type"),
    [
        ("TurtlebotLibrary", "{ linear: { x: 0.3 } }", "geometry_msgs/Twist"),
        ("StampedTurtlebotLibrary", "{ twist: { linear: { x: 0.3 } } }", "geometry_msgs/TwistStamped"),
    ],
)
def test_the_standard_library_drives_with_and_without_a_stamp(
    tmp_path: Path, library_name: str, data: str, ros_type: str
) -> None:
    provided = f"provide move with {data} provide halt with {data.replace('0.3', '0.0')}"
    robot = f"robot R {{ component Platform from {library_name} import TurtlebotPlatform {provided} }}"
    found = reading(tmp_path, robot)
    assert [*found.findings, *check(found.base, found.findings)] == []
    graph = robosc_to_rosgraph.transform(robosc_to_sct.transform(found.base)[1])
    sent = [
        (publisher.topic, f"{publisher.interface.package}/{publisher.interface.type}") for publisher in graph.publishers
    ]
    assert sent == [("/cmd_vel", ros_type)]


@pytest.mark.parametrize(
    "header",
    ["library L", "\ufeff// library X\n/* library Y */ library\n// L\n ^L", "/**/library/***/L"],
)
def test_a_library_is_found_by_the_name_that_its_file_declares(tmp_path: Path, header: str) -> None:
    text = library("found").replace("library L", header)
    assert message_of(reading(tmp_path, ROBOT, whatever=text).base) == "found"


def test_unrelated_files_are_never_reported(tmp_path: Path) -> None:
    (tmp_path / "binary.rscd").write_bytes(bytes(range(256)))
    (tmp_path / "folder.rscd").mkdir()
    (tmp_path / "L.txt").write_text(library("wrong"))
    os.mkfifo(tmp_path / "pipe.rscd")
    found = reading(
        tmp_path,
        ROBOT,
        broken="library Broken { component",
        robot="robot L { }",
        comment="/* library L",
        longer=library("wrong", "L2"),
        right=library("right"),
        empty="",
    )
    assert found.findings == []
    assert [Path(text).name for text in found.texts] == ["model.rscd", "right.rscd"]


def test_two_files_of_one_folder_with_one_library_are_an_error(tmp_path: Path) -> None:
    found = reading(tmp_path, ROBOT, one=library("a"), two=library("b"))
    assert underlined(found) == [("unresolved-reference", "L")]
    assert found.findings[0].message == (
        f"library `L` is declared by several files of one folder: `{tmp_path}/one.rscd` and `{tmp_path}/two.rscd`"
    )


def test_a_library_that_is_not_there_has_a_likely_name(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R { component C from EmergencyStoppLibrary import C }")
    assert found.findings[0].hint == "did you mean `EmergencyStopLibrary`?"


def test_a_library_that_only_sounds_alike_is_not_meant(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R { component C from GripperLibrary import C }")
    assert str(found.findings[0].hint).startswith("libraries are searched")


def test_a_library_with_errors_is_reported_as_itself_and_once(tmp_path: Path) -> None:
    robot = """
        robot R {
          component A from L import C
          component B from L import Gone
          component D { incoming message m with type: Lost behaviour { initial state s { on response from lost } } }
          requirement m needs A.lost and B.anything
        }
    """
    broken = "library L {\n  component C { outgoing message lost with type none }\n  datatype objct Lost { }\n}"
    found = reading(tmp_path, robot, l=broken)
    assert places(found) == [
        ("l.rscd", 2, "syntax"),
        ("l.rscd", 3, "syntax"),
        ("model.rscd", 3, "unresolved-reference"),
    ]


def test_unresolved_names_of_a_library_are_reported_in_it(tmp_path: Path) -> None:
    found = reading(tmp_path, ROBOT, l=library("m").replace("none", "Missing"))
    assert places(found) == [("l.rscd", 1, "unresolved-reference")]


def test_libraries_import_from_libraries(tmp_path: Path) -> None:
    robot = "robot R { component X from Outer import Y requirement m needs X.s }"
    outer = "library Outer { component Y from Inner import Z with { m: '/outer' } }"
    inner = (
        "library Inner { component Z { incoming message m with type: none"
        " behaviour { initial marked state s { on request to m } } } }"
    )
    found = reading(tmp_path, robot, outer=outer, inner=inner)
    assert found.findings == []
    assert found.base is not None
    reference = next(
        element for element in found.base.eAllContents() if isinstance(element, rsc.CommunicationReference)
    )
    assert reference.component is found.base.definitions[0]
    assert reference.communicationType.eContainer().eContainer().eContainer().name == "Inner"


def test_a_library_is_looked_for_beside_the_library_that_imports_it(tmp_path: Path) -> None:
    (tmp_path / "shelf").mkdir()
    (tmp_path / "shelf" / "outer.rscd").write_text("library L { component C from Inner import C }")
    (tmp_path / "shelf" / "inner.rscd").write_text(library("inner", "Inner"))
    (tmp_path / "robot.rscd").write_text(ROBOT)
    found = read(tmp_path / "robot.rscd", [tmp_path / "shelf"])
    assert found.findings == []
    assert [Path(text).name for text in found.texts] == ["robot.rscd", "outer.rscd", "inner.rscd"]


def test_a_library_that_several_import_is_one_library(tmp_path: Path) -> None:
    robot = "robot R { component A from One import C component B from Two import C component D from L import C }"
    forward = "library {} {{ component C from L import C }}"
    found = reading(tmp_path, robot, one=forward.format("One"), two=forward.format("Two"), l=library("m"))
    assert found.findings == []
    assert found.base is not None
    first, second, direct = (definition.type for definition in found.base.definitions)
    assert first.definition.type.library is second.definition.type.library is direct.library


@pytest.mark.parametrize(
    ("files", "file", "circle"),
    [
        ({"a": "L"}, "a.rscd", "L -> L"),
        ({"a": "M", "b": "L"}, "b.rscd", "L -> M -> L"),
        ({"a": "M", "b": "N", "c": "M"}, "c.rscd", "M -> N -> M"),
    ],
)
def test_a_circle_of_imports_is_printed(tmp_path: Path, files: dict[str, str], file: str, circle: str) -> None:
    texts = {
        item: f"library {name} {{\n  component C from {imported} import C\n}}"
        for (item, imported), name in zip(files.items(), "LMN", strict=False)
    }
    found = reading(tmp_path, ROBOT, **texts)
    assert places(found) == [(file, 2, "import-cycle")]
    assert found.findings[0].message == f"libraries import each other in a circle: {circle}"


def test_a_library_read_by_itself_finds_the_circle_too(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        "library L { component C from M import C }",
        m="library M { component C from L import C }",
    )
    assert underlined(found) == [("import-cycle", "L")]


def test_paths_are_as_the_user_gave_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "r.rscd").write_text(ROBOT)
    (tmp_path / "robots" / "l.rscd").write_text(library("m").replace("none", "Missing"))
    monkeypatch.chdir(tmp_path)
    found = read("robots/r.rscd")
    assert found.base is not None
    assert (place(found.base)[0], found.base.file) == ("robots/r.rscd", "r.rscd")
    assert [finding.file for finding in found.findings] == ["robots/l.rscd"]
    monkeypatch.chdir(tmp_path / "robots")
    found = read("r.rscd")
    assert [finding.file for finding in found.findings] == ["l.rscd"]
    assert place(rsc.Robot(file="saved.rscd"))[0] == "saved.rscd"


def test_a_file_that_is_not_there_is_the_callers_fault(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "nothing.rscd")
