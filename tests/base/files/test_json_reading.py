"""Read lines of JSON: the node's own logs round-trip, and anything else is an error with a position."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import pytest

from robosc.analysis.explain.names import NamingError, parse_state
from robosc.base.diagnostics import ModelError, Span
from robosc.base.diagnostics.visible import HIDDEN
from robosc.base.files.json_reading import JsonError, json_value
from robosc.language import configuration as config
from robosc.model import sct
from robosc.run.node_tests.trace_player import TraceError, read_trace
from robosc.run.runtime.core.event_log import EventLog
from robosc.run.simulation.script import read_script

if TYPE_CHECKING:
    from pathlib import Path

#: All characters that some reader takes for a line break, and all invisible characters.
WICKED = "".join(chr(bound) for bounds in HIDDEN for bound in bounds) + "\n\r\x0b\x0c\x1c\x1d\x1e\x85\u2028\u2029"
UNREADABLE = {
    "[" * 200_000: "nested too deeply",
    '{"value": ' * 101 + "1" + "}" * 101: "nested too deeply",
    f'{{"value": {"9" * 5000}}}': "a number of 5000 digits is too long",
    '{"value": 1e999}': "1e999 is too large a number",
    '{"value": NaN}': "NaN is not a JSON number",
    '{"value": ': "Expecting value",
}
each_unreadable = pytest.mark.parametrize(("text", "why"), UNREADABLE.items(), ids=lambda text: text[:20])


@pytest.mark.parametrize("raw", [False, True])
def test_a_node_s_log_is_read_as_it_was_written(tmp_path: Path, raw: bool) -> None:
    path = tmp_path / "events.jsonl"
    log = EventLog(str(path))
    for number in range(3):
        log.write(float(number), "in", "message_name.u_response", {"value": WICKED})
    log.close()
    if raw:  # the form that nodes of earlier versions wrote
        lines = [json.loads(line) for line in path.read_text(encoding="utf-8").split("\n")[:-1]]
        path.write_text("".join(f"{json.dumps(line, ensure_ascii=False)}\n" for line in lines), encoding="utf-8")
    assert [entry.data for entry in read_trace(str(path))] == [{"value": WICKED}] * 3
    steps, findings = read_script("log", path.read_text(encoding="utf-8"), ["message_name.u_response"])
    assert findings == []
    assert [step.data for step in steps] == [{"value": WICKED}] * 3
    assert [step.line for step in steps] == [1, 2, 3]


@each_unreadable
def test_what_can_not_be_read_is_said(text: str, why: str) -> None:
    with pytest.raises(JsonError, match=why):
        json_value(text)


#: Brackets inside strings do not count as nesting, whatever precedes them.
BRACKETS = ["[" * 200, "{" * 200, '"' + "[" * 200, "\\" + "[" * 200, '\\"' + "[" * 200, "]" * 200 + "[" * 101]


@pytest.mark.parametrize("text", BRACKETS, ids=lambda text: text[:5])
def test_brackets_in_strings_are_text(tmp_path: Path, text: str) -> None:
    value = {"value": text, text: [text]}
    assert json_value(json.dumps(value)) == value
    (tmp_path / "log").write_text(json.dumps(LINE | {"data": value}) + "\n")
    assert [line.data for line in read_trace(str(tmp_path / "log"))] == [value]


@pytest.mark.parametrize("before", ["", '"\\\\",', '"",', '"\\"",'])
def test_brackets_behind_strings_nest(before: str) -> None:
    with pytest.raises(JsonError, match="nested too deeply"):
        json_value("[" + before + "[" * 101)


@each_unreadable
def test_scripts_say_where(text: str, why: str) -> None:
    _, findings = read_script("script", f"e {{}}\ne {text}\n", ["e"])
    assert [(finding.span.line, why in finding.message) for finding in findings] == [(2, True)]


@each_unreadable
def test_configurations_say_where(tmp_path: Path, text: str, why: str) -> None:
    file = tmp_path / "controller-config.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=why):
        config.read(file)


def test_the_place_in_a_configuration(tmp_path: Path) -> None:
    file = tmp_path / "controller-config.json"
    file.write_text('{\n  "package": {},\n  oops\n}', encoding="utf-8")
    with pytest.raises(ModelError) as error:
        config.read(file)
    assert error.value.diagnostics[0].span == Span(3, 3, 3, 4)


@each_unreadable
def test_states_say_it(text: str, why: str) -> None:
    given = text if text.startswith("{") else f'{{"state": {text}'
    with pytest.raises(NamingError, match=why):
        parse_state(sct.SupervisoryControlModel(name="M"), given)


LINE = {"time": 1.0, "direction": "in", "event": "e"}


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (b"[" * 200_000, "line 2 is not a line of an event log"),
        (b'"\xff"', "line 2 is not UTF-8: invalid start byte at byte 1"),
        (b"[1]", "line 2 is not a line of an event log"),
        (b"", "line 2 is not a line of an event log"),
        (b"9" * 5000, "line 2 is not a line of an event log"),
        (LINE | {"time": None}, "it has no time"),
        (LINE | {"time": "1"}, "it has no time"),
        (LINE | {"time": 10**400}, "it has no time"),
        (LINE | {"time": float("inf")}, "it has no time"),
        (LINE | {"event": ["e"]}, "it has no direction and event"),
        (LINE | {"direction": {}}, "it has no direction and event"),
        (LINE | {"data": 3}, '"data" must be an object with a value'),
        (LINE | {"data": {}}, '"data" must be an object with a value'),
        (LINE | {"message": [3]}, '"message" must be an object'),
    ],
    ids=lambda given: str(given)[:80],
)
def test_the_player_says_which_line_is_wrong(tmp_path: Path, line: Any, why: str) -> None:
    path = tmp_path / "trace.jsonl"
    text = line if isinstance(line, bytes) else json.dumps(line).encode()
    path.write_bytes(json.dumps(LINE).encode() + b"\n" + text + b"\n")
    with pytest.raises(TraceError, match=why):
        read_trace(str(path))


def test_a_pipe_is_no_trace(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(TraceError, match="pipe is not a regular file"):
        read_trace(str(tmp_path / "pipe"))


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ('{"a": 1,}', "leave out the comma before `}`"),
        ("[1, 2, ]", "leave out the comma before `]`"),
        ("{'a': 1}", "double quotes"),
        ("{\"a\": 'b'}", "double quotes"),
        ('{"a": 1, // one\n"b": 2}', "leave out the comment: JSON has no comments"),
        ('{"a": 1 # one\n}', "leave out the comment: JSON has no comments"),
        ('{"a": True}', "write `true`"),
        ('{"a": None}', "write `null`"),
        ("{a: 1}", 'write the key in double quotes: "a"'),
        ('{"a": 1 "b": 2}', "write a comma after the value before it"),
        ('{"a": ', None),
        ('{"a": Truely}', None),
    ],
)
def test_a_common_mistake_has_a_hint(text: str, hint: str | None) -> None:
    with pytest.raises(JsonError) as error:
        json_value(text)
    assert (hint is None) == (error.value.hint is None)
    assert hint is None or hint in str(error.value.hint)


def test_a_configuration_has_the_hint(tmp_path: Path) -> None:
    file = tmp_path / config.FILE_NAME
    file.write_text('{"onShutdown": ["halt",]}')
    with pytest.raises(ModelError) as error:
        config.read(file)
    [finding] = error.value.diagnostics
    assert finding.hint == "leave out the comma before `]`"
