"""Text of a model in C++ code, XML and JSON stays inside its literal or comment."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.m2t.ros.rendering import fold, line_comment, raw_literal, xml_attribute, xml_text

LITERAL = re.compile(r'"(?:\\.|[^"\\])*"')


@pytest.mark.slow
@given(st.text())
def test_a_comment_stays_a_comment(text: str) -> None:
    lines = line_comment(text, 4).split("\n")
    assert all(line.startswith("    // ") for line in lines if line)
    assert not any(line.endswith("\\") for line in lines)
    assert not re.search(r"[\r\v\f\x1c-\x1e\x85\u2028\u2029]", "".join(lines))


def test_a_long_comment_is_wrapped() -> None:
    lines = line_comment("requirement move needs " + "Component.state and " * 20, 6).split("\n")
    assert len(lines) > 3
    assert all(len(line) <= 120 for line in lines)


@given(st.text(alphabet=st.characters(codec="ascii")).map(lambda text: text + ')json"' + text))
def test_a_raw_literal_ends_where_it_should(text: str) -> None:
    literal = raw_literal(text)
    assert literal.index(')json"') == len(literal) - len(')json"')
    assert literal[len('R"json(') : -len(')json"')].replace("\\u0029", ")") == text.replace("\\u0029", ")")


@given(st.text())
def test_xml_holds_any_text(text: str) -> None:
    kept = "".join(character for character in text if character.isprintable() or character in "\n\t")
    element = ET.fromstring(f"<e a={xml_attribute(text)}>{xml_text(text)}</e>")  # noqa: S314  # our own text
    assert (element.text or "") == kept
    assert element.get("a") == kept


TOKENS = st.sampled_from(
    [
        "if (",
        "a",
        "&&",
        "||",
        "b.c(",
        ")",
        "f(x, y)",
        '"a b (c"',
        '"quoted \\" ( blank"',
        "{",
        "}",
        ";",
        "'('",
        ".add(z)",
    ]
)


@given(st.lists(TOKENS, min_size=1, max_size=60), st.integers(0, 12))
def test_folding_changes_blanks_only_and_no_literal(tokens: list[str], indent: int) -> None:
    line = " " * indent + " ".join(tokens) + "\n"
    folded = fold(line)
    assert re.sub(r"\s", "", folded) == re.sub(r"\s", "", line)
    assert LITERAL.findall(folded) == LITERAL.findall(line)


def test_folding_keeps_to_the_width_where_it_can() -> None:
    line = "    if (" + " && ".join(f"condition_{number} > {number}" for number in range(30)) + ") return;\n"
    assert max(map(len, fold(line).splitlines())) <= 120
    comment = "// " + "word " * 60
    assert fold(comment) == comment


def test_folding_keeps_a_comment_behind_code_whole() -> None:
    code = "  std::optional<geometry_msgs::msg::PoseWithCovarianceStamped> initial_pose_estimate_handed_;"
    comment = "// The data handed over last, while the message stays enabled."
    assert fold(f"{code}  {comment}\n") == f"{code}\n      {comment}\n"


@pytest.mark.parametrize("text", ["short();\n", "", "\n", "    x = 1;"])
def test_folding_leaves_short_lines(text: str) -> None:
    assert fold(text) == text
