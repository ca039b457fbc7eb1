"""Names, keywords, numbers, strings, comments and their positions."""

from pathlib import Path
from typing import Any

import pytest

from robosc.base.diagnostics import Span
from robosc.language.reading import read
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import ROBOSC_KEYWORDS
from tests.language.texts import reading, underlined

PROVIDE = "robot R { component C { incoming message m with type: none } provide m with "


def value_of(folder: Path, literal: str) -> Any:
    """Return the element of a literal, parsed as the data of a provide statement."""
    found = reading(folder, f"{PROVIDE}{literal} }}")
    assert found.findings == []
    assert found.base is not None
    return found.base.definitions[1].data


@pytest.mark.parametrize("word", [*sorted(ROBOSC_KEYWORDS), "continue", "_x1"])
def test_a_keyword_is_a_name_where_only_a_name_can_stand(tmp_path: Path, word: str) -> None:
    found = reading(
        tmp_path,
        f"""
        robot {word} {{
          interface {word} use Type from package
          datatype object {word} {{ {word}: boolean other: integer }}
          datatype enum E from ^{word} to {{ value.^{word} -> {word} default -> other_value }}
          component {word} {{
            incoming message {word} with type: ^{word} links ^{word}
            behaviour {{
              variable {word}: E
              initial state {word} {{ on request to ^{word} goto {word} }}
            }}
          }}
          provide ^{word} with {{ {word}: ^{word}.^{word} = ^{word}, other: 1 }}
        }}
        """,
    )
    assert found.findings == []
    assert found.base is not None
    assert found.base.name == word
    assert {
        element.name for element in found.base.eAllContents() if isinstance(element, rsc.EnumValue | rsc.State)
    } == {
        word,
        "other_value",
    }


@pytest.mark.parametrize("word", sorted(ROBOSC_KEYWORDS - {"true", "false", "value", "error", "if"}))
def test_a_keyword_is_no_name_in_an_expression(tmp_path: Path, word: str) -> None:
    text = f"robot R {{ component {word} {{ incoming message m with type: none }} requirement m needs {word}.m }}"
    (rule, at), *_ = underlined(reading(tmp_path, text))
    assert (rule, at) == ("syntax", word)


@pytest.mark.parametrize("word", ["service", "action", "component"])
def test_services_and_components_are_named_by_keywords_too(tmp_path: Path, word: str) -> None:
    found = reading(tmp_path, f"robot R {{ component {word} {{ service {word} with request: none, response: none }} }}")
    assert found.findings == []


def test_names_are_case_sensitive(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R { component C { incoming message m with type: none } requirement M needs true }")
    assert underlined(found) == [("unresolved-reference", "M")]


@pytest.mark.parametrize(
    ("literal", "value"),
    [
        ("0", 0),
        ("9223372036854775807", 2**63 - 1),
        ("007", 7),
        ("0.5", 0.5),
        ("10.250", 10.25),
        ("true", True),
        ("false", False),
        ('"a\'b"', "a'b"),
        ("'a\"b'", 'a"b'),
        (r'"\"\'\\\n\t\r\b\f"', "\"'\\\n\t\r\b\f"),
        (r'"\u00e9\x41\uD83E\uDD16"', "éA\U0001f916"),
        ('"// no comment /* none */"', "// no comment /* none */"),
        ('"\U0001f916"', "\U0001f916"),
        ('""', ""),
    ],
)
def test_literals(tmp_path: Path, literal: str, value: object) -> None:
    element = value_of(tmp_path, literal)
    assert element.value == value
    assert type(element.value) is type(value)


@pytest.mark.parametrize(
    ("literal", "at"),
    [
        ("9223372036854775808", "9223372036854775808"),
        ("9" * 5000, "9" * 5000),
        (f"{'9' * 400}.0", f"{'9' * 400}.0"),
        (r'"a\qb"', r"\q"),
        (r'"\ud800"', r'"\ud800"'),
        ('"open', '"open }'),
        ("1e5", "1e5"),
        ("1.0e5", "1.0e5"),
        (".5", "."),
        ("5.", "."),
        ("1 . 5", "."),
        ("\N{LEFT DOUBLE QUOTATION MARK}a\N{RIGHT DOUBLE QUOTATION MARK}", "\N{LEFT DOUBLE QUOTATION MARK}"),
    ],
)
def test_what_is_no_literal_is_one_finding_at_its_place(tmp_path: Path, literal: str, at: str) -> None:
    # An unclosed string extends to the end of its line.
    text = f"{PROVIDE}{literal} }}" + ("\n}" if literal == '"open' else "")
    assert underlined(reading(tmp_path, text)) == [("syntax", at)]


@pytest.mark.parametrize("bounds", ["0..1", "-5..-1", "- 5 .. 5", "-9223372036854775808..9223372036854775807"])
def test_ranges(tmp_path: Path, bounds: str) -> None:
    found = reading(tmp_path, f"robot R {{ datatype object O {{ p: integer({bounds}) q: integer }} }}")
    assert found.findings == []
    assert found.base is not None
    with_range, without = (declared.type for declared in found.base.definitions[0].properties)
    lower, upper = (int(part.replace(" ", "")) for part in bounds.split(".."))
    assert (with_range.minimum, with_range.maximum) == (lower, upper)
    assert (without.minimum, without.maximum) == (None, None)


def test_flags_of_a_state_stand_in_either_order(tmp_path: Path) -> None:
    states = "initial marked state a { } marked initial state b { } marked state c { } initial state d { } state e { }"
    found = reading(tmp_path, f"robot R {{ component C {{ behaviour {{ {states} }} }} }}")
    assert found.findings == []
    assert found.base is not None
    flags = {
        element.name: (element.initial, element.marked)
        for element in found.base.eAllContents()
        if isinstance(element, rsc.State)
    }
    assert flags == {"a": (True, True), "b": (True, True), "c": (False, True), "d": (True, False), "e": (False, False)}


def test_blanks_and_comments_may_stand_anywhere_between_words(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        // first
        robot /* named */ R{component C{incoming message m with identifier
        : "/t" , type
          :double}/**/requirement//
        m needs!C /* a . b */ .
        c provide m with-0.5*(2+
        1) }""",
    )
    assert underlined(found) == [("unresolved-reference", "c")]
    assert found.base is not None
    assert [type(definition).__name__ for definition in found.base.definitions] == [
        "Component",
        "NeedsRequirement",
        "ProvideStatement",
    ]
    assert isinstance(found.base.definitions[2].data, ex.Multiplication)


def test_places_are_counted_in_code_points_from_one(tmp_path: Path) -> None:
    text = (
        "robot R {\n"
        "\tdatatype object O { \U0001f916é }\r\n"
        '  /* \U0001f916 */ requirement nothing needs "\U0001f916" = x\r'
        "}"
    )
    path = tmp_path / "model.rscd"
    path.write_bytes(text.encode())
    spans = {finding.message: finding.span for finding in read(path).findings}
    assert sorted(spans.values()) == [Span(2, 22, 2, 23), Span(3, 23, 3, 30), Span(3, 43, 3, 44)]


def test_every_element_knows_its_place(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R {\n  component C {\n\toutgoing message m with type: array(\n double)\n  }\n}\n")
    assert found.base is not None
    sources = {
        element.eClass.name: str(element.source).removeprefix("model.rscd:")
        for element in [found.base, *found.base.eAllContents()]
    }
    assert sources == {
        "Robot": "1:1-6:2",
        "Component": "2:3-5:4",
        "LocalComponent": "2:15-5:4",
        "Message": "3:2-4:9",
        "Array": "3:32-4:9",
        "DoubleDataType": "4:2-4:8",
    }


@pytest.mark.parametrize(
    ("content", "byte", "place"),
    [
        (b"robot R {\n  // caf\xe9\n}\n", 0xE9, Span(2, 9, 2, 9)),
        ('robot R { // é "'.encode() + b'\xff"\n}', 0xFF, Span(1, 17, 1, 17)),
        (b"\xef\xbb\xbfrobot R { }\n\xff", 0xFF, Span(2, 1, 2, 1)),
    ],
)
def test_what_is_no_utf_8_is_one_finding(tmp_path: Path, content: bytes, byte: int, place: Span) -> None:
    path = tmp_path / "model.rscd"
    path.write_bytes(content)
    (finding,) = read(path).findings
    assert (finding.rule, finding.span) == ("syntax", place)
    assert finding.message == f"the byte 0x{byte:02x} is not UTF-8"


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "model.rscd"
    path.write_bytes(b"\xef\xbb\xbfrobot R { }")
    found = read(path)
    assert found.findings == []
    assert found.base is not None
    assert str(found.base.source) == "model.rscd:1:1-1:12"
