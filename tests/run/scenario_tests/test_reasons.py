"""Scenarios in which services and actions fail for a reason, goals end canceled, and servers reject cancels."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.tools.cli import main

pytestmark = pytest.mark.slow

CRANE = Path(__file__).parents[2] / "run" / "simulation" / "crane.rscd"
CALLED = '  stop with true\n  canceled from go with {"code": 3}\n'


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    shutil.copy(CRANE, tmp_path)
    return tmp_path


def played(text: str, *options: str) -> Result:
    Path("crane.scenarios").write_text(text, encoding="utf-8")
    return CliRunner().invoke(main, ["test", "crane.rscd", "crane.scenarios", *options], catch_exceptions=False)


def findings(text: str, *options: str) -> list[tuple[int, str, str]]:
    answer = played(text, "--format", "json", *options)
    said = [finding for finding in json.loads(answer.stdout) if finding["rule"] == "scenario"]
    assert answer.exit_code == bool(said), answer.output
    return [(finding["line"], finding["message"], finding["hint"] or "") for finding in said]


GOALS = [
    ("error from go", "Base.low and Base.why = aborted"),
    ("error from go because aborted", "Base.low and Base.why = aborted"),
    ('error from go because aborted with {"code": 8}', "Base.low and Base.why = aborted and Base.code = 8"),
    ('error from go with {"code": 8, "path": [0.0, 0.75]}', "Base.blocked and Base.code = 0"),
    ('error from go because aborted with message {"code": 7, "path": [0.0, 0.25]}', "Base.low and Base.code = 7"),
    ("error from go because canceled", "Base.low and Base.why = canceled"),
    ('error from go because canceled with {"code": 2}', "Base.low and Base.why = canceled and Base.code = 2"),
    ("error from go because lost", "Base.unknown and Base.why = lost"),
    ("error from go because rejected", "Base.low and Base.why = rejected"),
    ("error from go because unavailable", "Base.low and Base.why = unavailable"),
    ("error from go because timeout", "Base.low and Base.why = timeout"),
    ('error from go because timeout with {"code": 6}', "Base.low and Base.why = timeout and Base.code = 6"),
    ("error from go because unreadable", "Base.low and Base.why = unreadable and Base.code = 0"),
    ('error from go because unreadable with {"code": 5}', "Base.low and Base.why = unreadable and Base.code = 5"),
]
CALLS = [
    ("error from lift", "Base.low and Base.why = failed"),
    ("error from lift because failed", "Base.low and Base.why = failed"),
    ("error from lift because unavailable", "Base.low and Base.why = unavailable"),
    ("error from lift because timeout", "Base.unknown and Base.why = lost"),
    ("error from lift because unreadable", "Base.unread"),
    ('error from lift because unreadable with {"heights": [1.0]}', "Base.unread"),
    ('error from lift with {"heights": [1.0]}', "Base.unread"),
]


def every_reason() -> str:
    texts = [f'scenario "goal {number}"\n  {step}\n  expect {end}\n' for number, (step, end) in enumerate(GOALS)]
    texts += [
        f'scenario "call {number}"\n{CALLED}  expect lift sent\n  {step}\n  expect {end}\n'
        for number, (step, end) in enumerate(CALLS)
    ]
    return "".join(texts)


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
def test_every_reason(engine: str) -> None:
    answer = played(every_reason(), "--engine", engine)
    assert answer.exit_code == 0, answer.output
    assert f"{len(GOALS) + len(CALLS)} passed in " in answer.stderr


@pytest.mark.slow
def test_logs_play_as_scripts() -> None:
    """An event log of a node replays to the same inputs, so that the robot ends in the same state."""
    assert played(every_reason(), "--traces", "traces").exit_code == 0
    for number, (_, end) in enumerate([*GOALS, *CALLS], 1):
        log = f"traces/scenario_{number}.jsonl"
        done = CliRunner().invoke(main, ["simulate", "crane.rscd", "--script", log], catch_exceptions=False)
        assert done.exit_code == 0, done.stderr
        state = json.loads(done.stdout.splitlines()[-1])["state"]
        for part in end.split(" and "):
            name, _, value = part.partition(" = ")
            assert str(state[name]) == value if value else state["component_Base"] == name.removeprefix("Base.")


def test_the_log_has_what_the_error_reads_of_an_answer_that_cannot_be_read(folder: Path) -> None:
    text = 'scenario "one"\n  error from go because unreadable with {"code": 5}\n  expect Base.low\n'
    assert played(text, "--traces", "traces").exit_code == 0
    lines = map(json.loads, (folder / "traces" / "scenario_1.jsonl").read_text().splitlines())
    (line,) = [line for line in lines if line["event"] == "action_go.u_error"]
    assert line["data"] == {"value": {"code": 5, "rest": 0}, "reason": "unreadable"}


def test_a_call_without_an_answer_takes_its_time() -> None:
    """A call fails with `timeout` after its time has expired, not before."""
    for reason in ("timeout", "unavailable"):
        step = f"error from lift because {reason}"
        text = f'scenario "one"\n{CALLED}  wait 1 s\n  {step}\n  expect !Base.lifting\n'
        assert played(text, "--traces", "traces").exit_code == 0
        lines = list(map(json.loads, Path("traces/scenario_1.jsonl").read_text().splitlines()))
        times = {line["event"]: line["time"] for line in lines}
        waited = times["service_lift.u_error"] - times["service_lift.c_trigger"]
        assert 4.8 < waited < 5.2  # in simulated time


def test_a_goal_that_is_not_accepted_takes_its_time() -> None:
    """A goal fails with `timeout` or `unavailable` after the time for its acceptance, not before."""
    for reason in ("timeout", "unavailable"):
        text = f'scenario "one"\n  wait 1 s\n  error from go because {reason}\n  expect !Base.going\n'
        assert played(text, "--traces", "traces").exit_code == 0
        lines = list(map(json.loads, Path("traces/scenario_1.jsonl").read_text().splitlines()))
        times = {line["event"]: line["time"] for line in lines}
        waited = times["action_go.u_error"] - times["action_go.c_trigger"]
        assert 4.8 < waited < 5.2  # in simulated time


@pytest.mark.parametrize("reason", ["rejected", "unavailable"])
def test_a_goal_is_not_rejected_after_its_time(reason: str) -> None:
    ((line, message, hint),) = findings(
        f'scenario "one"\n  wait 6 s\n  error from go because {reason}\n  expect Base.low\n'
    )
    assert (line, message) == (3, f"the goal was sent too long ago to fail with `{reason}`")
    assert "fails with `timeout`" in hint


def test_a_pause_follows_a_failure() -> None:
    model = Path("crane.rscd")
    model.write_text(
        model.read_text().replace(
            "do why := error goto low\n      }\n\n      state going", "goto idle\n      }\n\n      state going"
        )
    )
    text = f"""scenario "a retry"
{CALLED}  error from lift because unavailable
  expect Base.idle
  expect lift not sent
  wait 500 ms
  expect lift not sent
  wait 1 s
  expect lift sent
"""
    answer = played(text)
    assert answer.exit_code == 0, answer.output


def test_a_late_answer_after_a_lost_goal_changes_nothing() -> None:
    text = 'scenario "one"\n  error from go because lost\n  response from go\n  expect Base.unknown\n'
    ((line, message, _),) = findings(text)
    assert (line, "cannot come now" in message) == (3, True)


@pytest.mark.parametrize(
    ("step", "message", "hint"),
    [
        (
            "error from go because failed",
            "the error from `Base.go` cannot have the reason `failed`",
            "`aborted`, `canceled`, `lost`",
        ),
        (
            "error from lift because lost",
            "the error from `Base.lift` cannot have the reason `lost`",
            "`failed`, `timeout`, `unavailable` and `unreadable`",
        ),
        (
            "response from go because lost",
            "only the error of a service or an action has a reason",
            "leave out `because lost`",
        ),
        ("stop because lost", "only the error of a service or an action has a reason", "leave out `because lost`"),
        ('error from go because lost with {"code": 3}', "an error with the reason `lost` has no data", "leave out"),
        ("error from lift because timeout with 3", "an error with the reason `timeout` has no data", "leave out"),
        ("refuse cancel of lift", "there is no event `lift.canceled`", ""),
        ("error from go because", "this is neither a step nor an expectation", ""),
        ('error from go with {"code": "x"}', 'value.code is "x", expected an integer', ""),
        ('error from go because aborted with {"code": "8"}', 'value.code is "8", expected an integer', ""),
        ('error from go with {"code": 8.5}', "value.code is 8.5, expected an integer", ""),
        ("error from go because aborted with 5", "value is 5, expected an object", ""),
        (
            'error from go with {"path": 7}',
            "value.path is 7, expected a list, or an object from index to element",
            "",
        ),
        ('error from go with {"path": ["x"]}', 'value.path[0] is "x", expected a number', ""),
        ('error from go with message {"rest": "x"}', 'value.rest is "x", expected a number', ""),
        ('canceled from go with "boo"', 'value is "boo", expected an integer', ""),
        ('error from lift with {"heights": [true]}', "value.heights[0] is true, expected a number", ""),
        ('stop with "false"', 'value is "false", expected a boolean', ""),
        ("stop with 0.5", "value is 0.5, expected a boolean", ""),
        ("stop with null", "`null` is not data", "leave it out; `"),
    ],
)
def test_steps_that_cannot_be(step: str, message: str, hint: str) -> None:
    """They are reported before any scenario runs."""
    text = f'scenario "one"\n  {step}\n  expect Base.idle\nscenario "two"\n  expect Base.idle\n'
    ((line, found, help_),) = findings(text)
    assert (line, found) == (2, message)
    assert hint in help_


def test_an_expectation_names_the_requirement_that_forbids() -> None:
    ((_, found, _),) = findings('scenario "one"\n  expect Base.idle\n  expect lift forbidden by ""\n')
    assert found == "`forbidden by` names no requirement"


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        ("feedback from go\n  error from go because rejected", "the goal has been accepted: it cannot fail with `rej"),
        ("feedback from go\n  wait 10 s\n  error from go because unavailable", "the goal has been accepted"),
        ("feedback from go\n  wait 10 s\n  error from go because timeout", "the goal has been accepted"),
        # The goal was accepted after its time had expired.
        ("wait 10 s\n  feedback from go\n  error from go because timeout", None),
        ("wait 10 s\n  feedback from go\n  error from go because rejected", "the goal has been accepted"),
        ("stop with true\n  refuse cancel of go\n  error from go because rejected", "the goal has been accepted"),
        ("stop with true\n  refuse cancel of go\n  error from go because timeout", "the goal has been accepted"),
        ("stop with true\n  error from go because rejected", None),
        ("stop with true\n  error from go because timeout", None),
        ("stop with true\n  error from go because unavailable", "a goal that is canceled without a server"),
        ("feedback from go\n  error from go because aborted", None),
        ("feedback from go\n  error from go because lost", None),
    ],
)
def test_an_accepted_goal(steps: str, message: str | None) -> None:
    """A goal is accepted at once, unless the scenario's first step about it is a failure to be accepted."""
    found = findings(f'scenario "one"\n  {steps}\n  expect !Base.going and !Base.stopping\n')
    assert [line for line, _, _ in found] == ([2 + steps.count("\n")] if message else [])
    assert not message or message in found[0][1]


def test_a_second_goal_is_accepted_anew() -> None:
    model = Path("crane.rscd")
    text = (
        model.read_text()
        .replace("error goto unknown\n", "error goto idle\n")
        .replace("on response from go goto low", "on response from go goto idle")
    )
    model.write_text(text)
    steps = 'feedback from go\n  response from go with {"path": [1.0]}\n  wait 100 ms\n  expect Base.going\n'
    assert findings(f'scenario "one"\n  {steps}  error from go because rejected\n  expect Base.low\n') == []


@pytest.mark.parametrize(
    ("steps", "message", "hint"),
    [
        (
            'stop with true\n  canceled from go with {"code": 3}\n  error from lift with {"heights": [0.0, 1.0]}',
            "the node can read this data: write it at the response from `Base.lift`",
            "",
        ),
        (
            'error from go because unreadable with {"path": [1.0]}',
            "the node can read this data: write it at the response from `Base.go`",
            "",
        ),
        ("canceled from go", "the controller has not canceled this goal", "write `error from go because canceled`"),
        ("error from lift", "the error from `Base.lift` cannot come now: it ends no running call or goal", ""),
        ("refuse cancel of go", "`go` is not being canceled", ""),
        (
            "stop with true\n  error from go because canceled",
            "the controller cancels this goal itself",
            "write `canceled from go`",
        ),
        (
            "stop with true\n  refuse cancel of go\n  refuse cancel of go",
            "no request to cancel `go` waits for an answer",
            "write `wait` before this line",
        ),
    ],
)
def test_steps_that_cannot_be_now(steps: str, message: str, hint: str) -> None:
    """Later steps are not tried."""
    ((line, found, help_),) = findings(f'scenario "one"\n  {steps}\n  expect Base.unread\n')
    assert line == 2 + steps.count("\n")
    assert found == message
    assert hint in help_


def test_a_canceled_goal_goes_on_until_a_line_ends_it() -> None:
    text = """scenario "one"
  stop with true
  wait 10 s
  expect Base.idle
  expect lift sent
  expect lift allowed
  canceled from go with {"code": 3}
  expect lift sent
  expect Base.idle
"""
    found = findings(text)
    canceling = "`go` is being canceled and has not ended: write `canceled from go`"
    assert [(line, canceling in hint) for line, _, hint in found] == [(4, True), (5, True), (6, True), (9, False)]
    assert found[0][2] == f"the robot is in Base.stopping, Button.pressed, Base.why = lost, Base.code = 0; {canceling}"


def test_a_refused_cancel_is_asked_again() -> None:
    """The model stays in `canceling` until the goal ends; the node repeats the request after `retryMs`."""
    text = """scenario "one"
  stop with true
  refuse cancel of go
  expect Base.stopping and Base.go.running
  wait 1100 ms
  refuse cancel of go
  wait 1100 ms
  refuse cancel of go
  expect Base.stopping
  canceled from go with {"code": 3}
  expect !Base.go.running
scenario "it ends otherwise"
  stop with true
  refuse cancel of go
  response from go
  expect !Base.go.running
"""
    assert findings(text) == []
