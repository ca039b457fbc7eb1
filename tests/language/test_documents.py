"""Texts in memory, the meaning of their names, editor positions, and edits that mend a text."""

from pathlib import Path

import pytest

import robosc
from robosc.language.reading import Reading, read
from robosc.language.text import Documents, Text
from robosc.model import robosc as rsc

LIBRARY = """library Wheels {
  component Motors { outgoing message speed with type: double }
}
"""
ROBOT = """robot Cart {
  component Drive from Wheels import Motors
  component Lamp {
    incoming message 💡 with type: boolean
  }
}
"""


def in_memory(text: str, *, folder: Path = Path("/nowhere"), **libraries: str) -> Reading:
    texts = {f"{folder}/{name}.rscd": content for name, content in {"model": text, **libraries}.items()}
    return read(folder / "model.rscd", documents=Documents(texts))


def test_no_file_is_needed() -> None:
    found = in_memory("robot Cart { component Drive from Wheels import Motors }", Wheels=LIBRARY)
    assert not found.findings
    assert isinstance(found.base, rsc.Robot)
    assert found.base.definitions[0].type.definition.name == "Motors"
    assert list(found.files) == ["/nowhere/model.rscd", "/nowhere/Wheels.rscd"]


def test_a_text_in_memory_stands_in_place_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "Wheels.rscd").write_text(LIBRARY)
    (tmp_path / "model.rscd").write_text("robot Cart { component Drive from Wheels import Motors }")
    assert not read(tmp_path / "model.rscd").findings
    renamed = Documents({str(tmp_path / "Wheels.rscd"): LIBRARY.replace("Motors", "Engines")})
    (finding,) = read(tmp_path / "model.rscd", documents=renamed).findings
    assert finding.message == "library `Wheels` has no component `Motors`"
    elsewhere = Documents({str(tmp_path / "Wheels.rscd"): LIBRARY.replace("Wheels", "Rims")})
    (finding,) = read(tmp_path / "model.rscd", documents=elsewhere).findings
    assert finding.message == "there is no library `Wheels`"


def test_what_is_nowhere_can_not_be_read(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "model.rscd", documents=Documents({str(tmp_path / "other.rscd"): LIBRARY}))


def test_a_half_of_a_character_is_a_finding() -> None:
    (finding,) = in_memory("robot Cart { component \ud83d { } }").findings[:1]
    assert (finding.rule, finding.span.line, finding.span.column) == ("syntax", 1, 24)


def test_load_takes_a_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    robot = robosc.load(text="robot Cart { }")
    assert robot.name == "Cart"
    assert robosc.load("not/there.rscd", text="robot Cart { }").file == "there.rscd"
    Path("Wheels.rscd").write_text(LIBRARY)
    text = "robot Cart { component Drive from Wheels import Motors }"
    assert robosc.load(text=text).definitions[0].type.library.name == "Wheels"
    assert robosc.load("r.rscd", text=text, documents={"Wheels.rscd": LIBRARY}).name == "Cart"
    with pytest.raises(robosc.ModelError) as caught:
        robosc.load(text="robot Cart {")
    assert caught.value.diagnostics[0].file == "<text>"
    with pytest.raises(TypeError, match="a path or a text"):
        robosc.load()


# Names


TEXT = """robot Cart {
  datatype object Pose { x: double }
  component Sensor {
    incoming message pose with type: Pose
    behaviour {
      variable seen: boolean
      initial marked state Idle { on response from pose do seen := true goto Busy }
      state Busy { }
    }
  }
  component Wheel { service turn with request: none, response: none }
  requirement Wheel.turn needs Sensor.pose.x > 0.0 and Sensor.Busy and Sensor.lost and Idle.x > 1.0
}
"""


def names(found: Reading, name: str) -> list[tuple[int, str | None, bool]]:
    file = found.files["/nowhere/model.rscd"]
    return [
        (
            file.text.span(document.start, document.end).line,
            document.target and document.target.eClass.name,
            document.is_declaration,
        )
        for document in file.names
        if document.name == name
    ]


def test_names_and_what_they_stand_for() -> None:
    found = in_memory(TEXT.replace("Sensor.pose.x", "Sensor.seen"))
    assert names(found, "Pose") == [(2, "ObjectDataType", True), (4, "ObjectDataType", False)]
    assert names(found, "pose") == [(4, "Message", True), (7, "Message", False)]
    assert names(found, "seen") == [(6, "Variable", True), (7, "Variable", False), (12, "Variable", False)]
    assert names(found, "Busy") == [(7, "State", False), (8, "State", True), (12, "State", False)]
    assert names(found, "lost") == [(12, None, False)]
    assert [line for line, _, _ in names(found, "Sensor")] == [3, 12, 12, 12]
    file = found.files["/nowhere/model.rscd"]
    assert file.names == sorted(file.names, key=lambda name: name.start)
    assert all(file.text.content[name.start : name.end] == name.name for name in file.names)


def test_the_name_at_a_place() -> None:
    file = in_memory(TEXT).files["/nowhere/model.rscd"]
    start = file.text.content.index("Wheel.turn")
    wheel, turn = file.name_at(start), file.name_at(start + 6)
    assert wheel is not None
    assert turn is not None
    assert (wheel.name, turn.name, turn.target.name) == ("Wheel", "turn", "turn")
    assert file.name_at(start + 5) == wheel  # directly after the name
    assert file.name_at(start - 1) is None
    assert in_memory("").files["/nowhere/model.rscd"].name_at(0) is None


def test_a_property_of_what_looked_like_a_component() -> None:
    text = """robot Cart {
      datatype object Pose { x: double }
      component A {
        incoming message pose with type: Pose
        behaviour { variable p: Pose initial marked state S { transition if p.x > 0.0 } }
      }
    }"""
    found = in_memory(text)
    assert not found.findings
    assert names(found, "p") == [(5, "Variable", True), (5, "Variable", False)]
    assert names(found, "x") == [(2, "ObjectProperty", True), (5, "ObjectProperty", False)]


def test_of_a_broken_text_what_can_be_read_is_a_model() -> None:
    found = in_memory("robot Cart {\n  component A { }\n  component { }\n  requirement A.b c\n  component D { }\n}")
    assert isinstance(found.base, rsc.Robot)
    assert [definition.name for definition in found.base.definitions] == ["A", "D"]
    file = found.files["/nowhere/model.rscd"]
    skipped = [file.text.content[start:end] for start, end in file.skipped]
    assert skipped == ["component { }", "requirement A.b c"]
    assert names(found, "A") == [(2, "Component", True)]


# Positions


ASTRAL = "a🤖b\n\n💡💡x\r\nend"


@pytest.mark.parametrize(
    ("offset", "position"),
    [
        *((0, (0, 0)), (1, (0, 1)), (2, (0, 3)), (3, (0, 4)), (4, (1, 0)), (5, (2, 0)), (6, (2, 2)), (7, (2, 4))),
        *((8, (2, 5)), (9, (2, 6)), (10, (3, 0)), (13, (3, 3))),
    ],
)
def test_positions_in_units_of_utf_16(offset: int, position: tuple[int, int]) -> None:
    text = Text("a.rscd", ASTRAL)
    assert text.to_utf16(offset) == position
    assert text.from_utf16(*position) == offset


def test_positions_that_are_none() -> None:
    text = Text("a.rscd", ASTRAL)
    assert text.from_utf16(0, 2) == 1  # between the surrogates of a character
    assert text.from_utf16(0, 99) == 3
    assert text.from_utf16(1, 1) == 4
    assert text.from_utf16(0, -1) == 0
    assert text.from_utf16(9, 0) == len(ASTRAL)
    assert text.to_utf16(99) == (3, 3)
    assert Text("a.rscd", "").from_utf16(0, 0) == 0


def test_lines_and_columns() -> None:
    text = Text("a.rscd", ASTRAL)
    for offset in range(len(ASTRAL) + 1):
        span = text.span(offset, offset)
        assert text.offset(span.line, span.column) == offset
    assert [text.offset(1, 99), text.offset(99, 1), text.offset(0, 1), text.offset(1, 0)] == [3, len(ASTRAL), 0, 0]


# Edits


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("A.mve needs true", "A.move needs true"),
        ("A.move neds true", "A.move needs true"),
        ("A.move needs B.lit == true", "A.move needs B.lit = true"),
        ("A.move needs B.lit && true", "A.move needs B.lit and true"),
        ("A.move needs B.lit;", "A.move needs B.lit"),
    ],
)
def test_an_edit_mends_the_text(wrong: str, right: str) -> None:
    template = """robot Cart {{
      component A {{ outgoing message move with type: none }}
      component B {{ behaviour {{ variable lit: boolean = true initial marked state S {{ }} }} }}
      requirement {}
    }}"""
    found = in_memory(template.format(wrong))
    (finding,) = found.findings
    mended = found.texts[finding.file]
    text = Text(finding.file, mended)
    for edit in finding.edits or finding.alternatives[0].edits:
        start = text.offset(edit.span.line, edit.span.column)
        end = text.offset(edit.span.end_line, edit.span.end_column)
        mended = mended[:start] + edit.text + mended[end:]
    assert mended == template.format(right)
    assert not in_memory(mended).findings


def test_a_text_in_memory_is_found_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    text = "robot Cart { }"
    assert read(tmp_path / "link/r.rscd", documents=Documents({str(tmp_path / "real/r.rscd"): text})).base is not None
