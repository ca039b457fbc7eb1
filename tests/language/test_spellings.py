"""Other spellings: `not` for `!`, and `package/msg/Type` for `package/Type`."""

from __future__ import annotations

from pathlib import Path

import pytest

from robosc.language.formatting import format_edits, format_text
from robosc.language.reading import read
from robosc.language.text import Documents, Text
from robosc.model.semantics.printing import RoboscPrinter
from tests.language.second_edition import running

GATE = """robot Gate {{
  {definitions}
  component Gate {{
    incoming message go with type: none
    outgoing message scan with type: {type}
    outgoing message open with type: boolean
    service call with request: none, response: none {link}
    behaviour {{
      variable moved: boolean
      variable near: boolean
      initial marked state shut {{ on response from open do near := value }}
    }}
  }}
  requirement go needs {condition}
}}
"""


def gate(condition: str = "Gate.near", definitions: str = "", type_: str = "boolean", link: str = "") -> str:
    return GATE.format(condition=condition, definitions=definitions, type=type_, link=link)


def formatted(content: str) -> str:
    text, findings = format_text(Text("gate.rscd", content))
    assert findings == []
    assert text is not None
    return text


def messages(content: str, libraries: dict[str, str] | None = None) -> list[str]:
    texts = {f"{name}.rscd": text for name, text in (libraries or {}).items()}
    reading = read(Path("gate.rscd"), documents=Documents({"gate.rscd": content} | texts))
    return [finding.message for finding in reading.findings]


@pytest.mark.parametrize(
    ("written", "usual"),
    [
        ("not Gate.near", "!Gate.near"),
        ("not not Gate.near", "!!Gate.near"),
        ("not Gate.near and Gate.moved", "!Gate.near and Gate.moved"),
        ("not Gate.near = Gate.moved", "!Gate.near = Gate.moved"),
        ("not (Gate.near or Gate.moved)", "!(Gate.near or Gate.moved)"),
        ("Gate.near => not true", "Gate.near => !true"),
        ("Gate.moved or not /* it is */ Gate.near", "Gate.moved or ! /* it is */ Gate.near"),
    ],
)
def test_not_is_an_exclamation_mark(written: str, usual: str) -> None:
    assert messages(gate(written)) == []
    assert formatted(gate(written)) == formatted(gate(usual))
    assert "not" not in formatted(gate(written)).replace("/* it is */", "")
    printed = [
        RoboscPrinter()(
            read(Path("g.rscd"), documents=Documents({"g.rscd": gate(text)})).base.definitions[-1].condition
        )
        for text in (written, usual)
    ]
    assert printed[0] == printed[1]


@pytest.mark.parametrize(
    "definitions",
    [
        "constant not: boolean = true",
        "condition not = true",
        "datatype enum Kind from boolean to { value -> not default -> other }",
    ],
)
def test_a_declared_not_stays_a_name(definitions: str) -> None:
    """There, `not` before a name is a syntax error as before."""
    assert messages(gate(definitions=definitions)) == []
    content = gate("not Gate.near", definitions)
    assert any("expected an operator" in message for message in messages(content))


def test_a_declared_function_not_is_called() -> None:
    twice = "function not(x: boolean): boolean = x"
    engine = running(gate("not(Gate.near)", twice))
    assert not engine.enabled("message_go.c_trigger")
    assert "not(Gate.near)" in formatted(gate("not(Gate.near)", twice))


def test_a_function_not_of_a_library_is_called() -> None:
    library = "library lib { function not(x: boolean): boolean = x component D { } }"
    imported = "component D from lib import D"
    assert messages(gate("not (Gate.near)", imported), {"lib": library}) == []
    base = read(
        Path("gate.rscd"), documents=Documents({"gate.rscd": gate("not (Gate.near)", imported), "lib.rscd": library})
    ).base
    assert RoboscPrinter()(base.definitions[-1].condition) == "not(Gate.near)"
    other = library.replace("function not(x: boolean): boolean = x", "")
    base = read(
        Path("gate.rscd"), documents=Documents({"gate.rscd": gate("not (Gate.near)", imported), "lib.rscd": other})
    ).base
    assert RoboscPrinter()(base.definitions[-1].condition) == "!Gate.near"


def test_a_negation_beside_an_error_is_no_error() -> None:
    content = gate("not Gate.near").replace("marked state shut", "marked stat shut")
    assert len(messages(content)) == 1


def test_the_folder_of_a_ros_type() -> None:
    content = gate(type_="sensor_msgs/msg/LaserScan")
    assert messages(content) == []
    assert formatted(content) == formatted(content.replace("/msg", ""))


def test_the_wrong_folder_of_a_ros_type_is_reported() -> None:
    content = gate().replace(
        "request: none, response: none", "request: std_srvs/msg/SetBool, response: std_srvs/SetBool"
    )
    assert messages(content) == ["`msg` holds no types of the kind service, expected `srv`"]
    right = content.replace("/msg/", "/srv/")
    assert messages(right) == []
    assert formatted(right) == formatted(right.replace("/srv/", "/"))


@pytest.mark.parametrize(
    ("written", "usual"),
    [
        ("use Trigger from std_srvs", "use Trigger from std_srvs"),
        ("use srv/Trigger from std_srvs", "use Trigger from std_srvs"),
        ("use std_srvs/Trigger", "use std_srvs/Trigger"),
        ("use std_srvs/srv/Trigger", "use std_srvs/Trigger"),
    ],
)
def test_the_type_of_an_interface(written: str, usual: str) -> None:
    content = gate(definitions=f"interface ask {written}", link="links ask")
    assert messages(content) == []
    assert usual in formatted(content)
    interface = read(Path("g.rscd"), documents=Documents({"g.rscd": content})).base.definitions[0]
    assert (interface.package, interface.type) == ("std_srvs", "Trigger")


@pytest.mark.parametrize("kind", ["service call", "outgoing service call"])
def test_the_wrong_folder_of_an_interface_is_reported_where_it_is_linked(kind: str) -> None:
    content = gate(definitions="interface ask use msg/Trigger from std_srvs", link="links ask")
    content = content.replace("service call", kind)
    assert messages(content) == ["`msg` holds no types of the kind service, expected `srv`"]
    _, findings = format_text(Text("gate.rscd", content))
    assert [finding.message for finding in findings] == messages(content)


def test_a_division_by_a_name_like_a_folder_stays() -> None:
    content = gate("8.0 / msg / Gate.speed > 1.0", "constant msg: double = 2.0").replace(
        "variable near", "variable speed: double\n      variable near"
    )
    assert "8.0 / msg / Gate.speed" in formatted(content)
    negated = content.replace("requirement go", "requirement go needs not Gate.near\n  requirement go")
    assert "8.0 / msg / Gate.speed" in formatted(negated)


def test_the_editor_formats_other_spellings() -> None:
    content = gate("not  Gate.near", type_="std_msgs/msg/Bool")
    text = Text("gate.rscd", content)
    pieces, behind = [], 0
    for start, end, new in format_edits(text):
        pieces += [content[behind:start], new]
        behind = end
    assert "".join([*pieces, content[behind:]]) == formatted(content)


@pytest.mark.parametrize("place", ["object O { NAME: string }", "object O { a: string NAME: string }"])
@pytest.mark.parametrize("word", ["not", "msg"])
def test_a_property_is_no_name_in_an_expression(place: str, word: str) -> None:
    content = gate("not Gate.near", f"datatype {place.replace('NAME', word)}", "std_msgs/msg/Bool")
    assert messages(content) == []
    assert "!Gate.near" in formatted(content)
    assert "std_msgs/Bool" in formatted(content)


@pytest.mark.parametrize(
    ("definitions", "type_", "link"),
    [
        ("", "std_msgs/srv/Bool", ""),
        ("interface ask use std_srvs/msg/Trigger", "boolean", "links ask"),
    ],
)
def test_format_keeps_the_wrong_folder_of_a_ros_type(definitions: str, type_: str, link: str) -> None:
    """Without the folder the text would be correct, and mean another type."""
    text, findings = format_text(Text("gate.rscd", gate(definitions=definitions, type_=type_, link=link)))
    assert text is None
    assert [finding.hint for finding in findings] == ["leave the folder out, or name another type"]
