"""Findings as text, JSON and SARIF."""

import json
from typing import Any

import pytest

from robosc.base.diagnostics import (
    Alternative,
    Diagnostic,
    Edit,
    Severity,
    Span,
    as_json,
    as_sarif,
    as_text,
    has_errors,
    in_order,
)


def finding(
    line: int = 1,
    column: int = 1,
    end_line: int | None = None,
    end_column: int | None = None,
    *,
    file: str = "a.rscd",
    rule: str = "type",
    hint: str | None = None,
    severity: Severity = Severity.ERROR,
    message: str = "wrong",
    edits: tuple[Edit, ...] = (),
    alternatives: tuple[Alternative, ...] = (),
) -> Diagnostic:
    span = Span(line, column, end_line or line, end_column or column + 1)
    return Diagnostic(file, span, severity, rule, message, hint, edits, alternatives=alternatives)


def test_span_contains() -> None:
    outer = Span(2, 5, 4, 3)
    assert outer.contains(outer)
    assert outer.contains(Span(3, 1, 3, 80))
    assert outer.contains(Span(2, 5, 2, 6))
    assert not outer.contains(Span(2, 4, 2, 6))
    assert not outer.contains(Span(4, 1, 4, 4))


def test_order_and_duplicates() -> None:
    expected = [
        finding(2, 9, file="a.rscd", rule="z"),
        finding(10, 1, file="a.rscd", rule="a"),
        finding(10, 3, file="a.rscd", rule="a"),
        finding(10, 3, file="a.rscd", rule="b"),
        finding(1, 1, file="b.rscd"),
    ]
    assert in_order([*reversed(expected), *expected]) == expected


def test_has_errors() -> None:
    warning = finding(severity=Severity.WARNING)
    assert not has_errors([])
    assert not has_errors([warning])
    assert has_errors([warning, finding()])


# Text


def underline(line: str, start: int, end: int) -> tuple[str, str]:
    """Return the printed line and its underline for the code points in [`start`, `end`), counted from 0."""
    return as_text.underline(finding(1, start + 1, 1, end + 1), line)


def test_text() -> None:
    shown = as_text.render([finding(2, 3, 2, 6, hint="write `two`")], {"a.rscd": "one\n  zwo;\n"})
    assert shown == "a.rscd:2:3: error: wrong [type]\n      zwo;\n      ^^^\n    hint: write `two`\n"


def test_text_without_hint_source_or_findings() -> None:
    warning = finding(severity=Severity.WARNING)
    assert as_text.render([warning], {}) == "a.rscd:1:1: warning: wrong [type]\n"
    assert as_text.render([finding(9, 1)], {"a.rscd": "one\n"}) == "a.rscd:9:1: error: wrong [type]\n"
    assert as_text.render([], {}) == ""


@pytest.mark.parametrize(
    ("line", "start", "end", "shown", "carets"),
    [
        ("a := b", 5, 6, "a := b", "     ^"),
        ("a := bcd", 5, 8, "a := bcd", "     ^^^"),
        ("\ta\tb", 1, 2, "    a   b", "    ^"),
        ("\ta\tb", 3, 4, "    a   b", "        ^"),
        ("ab\tc", 2, 3, "ab  c", "  ^^"),
        ("漢字 = x", 5, 6, "漢字 = x", "       ^"),
        ("漢字 = x", 1, 2, "漢字 = x", "  ^^"),
        ("漢\tx", 2, 3, "漢  x", "    ^"),
        ("e\u0301a = x", 1 + 1, 3, "e\u0301a = x", " ^"),
        ("e\u0301a", 1, 2, "e\u0301a", "^"),
        ("e\u0301a", 0, 2, "e\u0301a", "^"),
        ("x 🤖 y", 4, 5, "x 🤖 y", "     ^"),
        ("end", 3, 3, "end", "   ^"),
        ("end", 3, 4, "end", "   ^"),
        ("a b\r", 2, 3, "a b", "  ^"),
        ("trailing  ", 0, 8, "trailing", "^^^^^^^^"),
        ("", 0, 1, "", "^"),
    ],
)
def test_caret_stands_under_the_fault(line: str, start: int, end: int, shown: str, carets: str) -> None:
    assert underline(line, start, end) == (shown, carets)


@pytest.mark.parametrize("at", [0, 10, 59, 60, 61, 200, 495, 499, 500])
def test_of_a_long_line_the_part_around_the_fault_is_shown(at: int) -> None:
    line = "".join(chr(0x4E00 + number) for number in range(500))
    shown, carets = underline(line, at, at + 400)
    assert len(shown) < 170
    columns = sum(1 if character == "…" else 2 for character in shown.partition(line[at : at + 1] or "end")[0])
    assert carets.index("^") == columns


def test_of_several_lines_the_first_is_underlined() -> None:
    text = "one {  \n two\n}"
    assert as_text.render([finding(1, 5, 3, 2)], {"a.rscd": text}).splitlines()[1:] == ["    one {", "        ^"]
    assert as_text.render([finding(1, 1, 3, 2)], {"a.rscd": text}).splitlines()[1:] == ["    one {", "    ^^^^^"]


def test_lines_break_at_line_feeds_only() -> None:
    text = "a\x0cb\u2028c\nsecond"
    assert as_text.render([finding(2, 1, 2, 7)], {"a.rscd": text}).splitlines()[1:] == ["    second", "    ^^^^^^"]


def test_nothing_in_a_model_steers_the_terminal() -> None:
    wicked = "\x1b[31m \u202e \x9b"
    shown = as_text.render(
        [finding(1, 1, 1, 4, message=wicked, hint=wicked, file=f"{wicked}.rscd")], {f"{wicked}.rscd": f"{wicked}\n"}
    )
    assert not {"\x1b", "\u202e", "\x9b"} & set(shown)


def test_paint() -> None:
    def paint(part: str, text: str) -> str:
        return f"<{part}:{text}>"

    shown = as_text.render([finding(1, 3, 1, 5, hint="so")], {"a.rscd": "a bc"}, paint)
    assert shown == (
        "<place:a.rscd:1:3:> <error:error:> wrong <rule:[type]>\n    a bc\n      <caret:^^>\n    <hint:hint:> so\n"
    )


@pytest.mark.parametrize(
    ("errors", "warnings", "expected"),
    [(0, 0, ""), (1, 0, "1 error"), (2, 1, "2 errors, 1 warning"), (0, 3, "3 warnings")],
)
def test_summary(errors: int, warnings: int, expected: str) -> None:
    found = [finding(line) for line in range(1, errors + 1)]
    found += [finding(line, severity=Severity.WARNING) for line in range(1, warnings + 1)]
    assert as_text.summary([*found, *found]) == expected


# JSON


def test_json() -> None:
    ways = (Alternative("write `b`", (Edit(Span(3, 2, 3, 2), "b"),)),)
    found = [finding(3, 2, 4, 7, rule="unique-topic", severity=Severity.WARNING, alternatives=ways)]
    found.append(finding(1, 1, hint="write `0.0`", edits=(Edit(Span(1, 1, 1, 2), "0.0"),)))
    assert json.loads(as_json.render([*found, *found])) == [
        {
            "file": "a.rscd",
            "line": 1,
            "column": 1,
            "end_line": 1,
            "end_column": 2,
            "severity": "error",
            "rule": "type",
            "message": "wrong",
            "hint": "write `0.0`",
            "follows": 0,
            "related": [],
            "edits": [{"line": 1, "column": 1, "end_line": 1, "end_column": 2, "text": "0.0"}],
            "alternatives": [],
        },
        {
            "file": "a.rscd",
            "line": 3,
            "column": 2,
            "end_line": 4,
            "end_column": 7,
            "severity": "warning",
            "rule": "unique-topic",
            "message": "wrong",
            "hint": None,
            "follows": 0,
            "related": [],
            "edits": [],
            "alternatives": [
                {
                    "title": "write `b`",
                    "edits": [{"line": 3, "column": 2, "end_line": 3, "end_column": 2, "text": "b"}],
                }
            ],
        },
    ]
    assert json.loads(as_json.render([])) == []


# SARIF


def run(*findings: Diagnostic) -> dict[str, Any]:
    log = json.loads(as_sarif.render(findings, "1.2.3"))
    assert log["version"] == "2.1.0"
    assert "sarif-schema-2.1.0" in log["$schema"]
    (only,) = log["runs"]
    assert isinstance(only, dict)
    return only


def test_sarif() -> None:
    only = run(
        finding(3, 2, 4, 7, rule="unique-topic", severity=Severity.WARNING, file="models/my robot.rscd"),
        finding(1, 1, hint="write `0.0`"),
    )
    driver = only["tool"]["driver"]
    assert (driver["name"], driver["version"]) == ("robosc", "1.2.3")
    assert only["columnKind"] == "unicodeCodePoints"
    first, second = only["results"]
    assert (first["ruleId"], first["level"], first["message"]["text"]) == (
        "type",
        "error",
        "wrong\n\nHint: write `0.0`",
    )
    assert (second["ruleId"], second["level"], second["message"]["text"]) == ("unique-topic", "warning", "wrong")
    (location,) = second["locations"]
    assert location["physicalLocation"] == {
        "artifactLocation": {"uri": "models/my%20robot.rscd"},
        "region": {"startLine": 3, "startColumn": 2, "endLine": 4, "endColumn": 7},
    }


def test_sarif_edits_are_fixes() -> None:
    edit = Edit(Span(1, 1, 1, 2), "0.0")
    mended, plain = run(finding(2), finding(1, 1, hint="write `0.0`", edits=(edit,)))["results"]
    assert "fixes" not in plain
    (fix,) = mended["fixes"]
    assert fix["description"]["text"] == "write `0.0`"
    (change,) = fix["artifactChanges"]
    assert change["artifactLocation"] == {"uri": "a.rscd"}
    region = {"startLine": 1, "startColumn": 1, "endLine": 1, "endColumn": 2}
    assert change["replacements"] == [{"deletedRegion": region, "insertedContent": {"text": "0.0"}}]


def test_sarif_has_a_fix_for_each_alternative() -> None:
    ways = tuple(Alternative(f"write `{text}`", (Edit(Span(1, 1, 1, 2), text),)) for text in "ab")
    (result,) = run(finding(hint="write `a` or `b`", alternatives=ways))["results"]
    assert [fix["description"]["text"] for fix in result["fixes"]] == ["write `a`", "write `b`"]
    assert result["fixes"][1]["artifactChanges"][0]["replacements"][0]["insertedContent"] == {"text": "b"}


def test_sarif_describes_the_rules_that_were_broken() -> None:
    only = run(finding(rule="unique-topic"), finding(rule="type"), finding(2, rule="type"), finding(rule="brand-new"))
    rules = only["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == ["brand-new", "type", "unique-topic"]
    assert [rules[result["ruleIndex"]]["id"] for result in only["results"]] == [
        result["ruleId"] for result in only["results"]
    ]
    assert rules[1]["shortDescription"]["text"].startswith("An expression has a type")
    assert rules[1]["help"]["text"].startswith("# type\n")
    assert "help" not in rules[0]


def test_sarif_of_no_findings() -> None:
    assert run()["results"] == []


@pytest.mark.parametrize(
    ("file", "uri"),
    [
        ("a.rscd", "a.rscd"),
        ("../b c/ü#?.rscd", "../b%20c/%C3%BC%23%3F.rscd"),
        ("/models/a b.rscd", "file:///models/a%20b.rscd"),
        ("bad\udcff.rscd", "bad%FF.rscd"),
        ("/bad\udcff.rscd", "file:///bad%FF.rscd"),
    ],
)
def test_sarif_names_files_by_uri(file: str, uri: str) -> None:
    (result,) = run(finding(file=file))["results"]
    assert result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == uri
