"""Clients in scenarios: they call the services of the controller, send goals to it, and cancel them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.tools.cli import main

HERE = Path(__file__).parent
GOAL = '  request from visit with {"pose": {"pose": {"position": {"x": 1.0}}}}\n'
NEAR = '  request from visit with {"pose": {"pose": {"position": {"x": 0.5}}}}\n'


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("visitor.rscd", "visitor.scenarios"):
        shutil.copy(HERE / name, tmp_path)
    return tmp_path


def played(text: str, *options: str) -> Result:
    Path("own.scenarios").write_text(text, encoding="utf-8")
    return CliRunner().invoke(main, ["test", "visitor.rscd", "own.scenarios", *options], catch_exceptions=False)


def findings(*lines: str) -> list[tuple[int, str, str]]:
    """Return the findings of a scenario with these lines, from line 2 on."""
    answer = played('scenario "clients"\n' + "".join(lines), "--format", "json")
    said = [finding for finding in json.loads(answer.stdout) if finding["rule"] == "scenario"]
    assert answer.exit_code == bool(said), answer.output
    return [(finding["line"], finding["message"], finding["hint"] or "") for finding in said]


def test_clients_call_send_goals_and_cancel() -> None:
    done = CliRunner().invoke(main, ["test", "visitor.rscd", "visitor.scenarios"], catch_exceptions=False)
    assert (done.exit_code, "3 passed in" in done.output) == (0, True), done.output


@pytest.mark.build
@pytest.mark.slow
def test_the_generated_loop_serves_them_alike() -> None:
    done = CliRunner().invoke(main, ["test", "visitor.rscd", "visitor.scenarios", "--engine", "c"])
    assert (done.exit_code, "3 passed in" in done.output) == (0, True), done.output


def test_a_goal_is_rejected_while_another_is_open() -> None:
    rejected = f"{GOAL}  expect visit rejected\n  expect go not sent\n"
    repeated = f"  repeat 3 {{\n{GOAL}  expect request from visit accepted\n{rejected}  there\n  }}\n"
    assert findings(NEAR, "  expect visit rejected\n", repeated, "  expect response to visit sent 3 times\n") == []


def test_eleven_calls_are_answered_and_an_earlier_one_is_dropped() -> None:
    calls = "".join(f'  request from light with {{"data": {str(number > 1).lower()}}}\n' for number in range(12))
    # The first is open. The second, the only other one that turns the lamp off, makes way for the last.
    expected = """\
  there
  expect response to light sent 11 times
  expect response to light sent 1 times with {"message": "off"}
"""
    assert findings(GOAL, calls, expected) == []


def test_a_repeated_call_comes_again() -> None:
    lines = (
        '  every 100 ms request from light with {"data": true}\n  wait 1 s\n  expect response to light sent 10 times\n'
    )
    assert findings(lines) == []


PLAYED = [
    ("  cancel from visit\n", "`visit` has no goal to cancel"),
    (GOAL + "  cancel from visit\n  cancel from visit\n", "`visit` has no goal to cancel"),
    (GOAL + "  expect visit rejected\n", "the controller accepted the goal of `visit`"),
    (NEAR + "  expect visit accepted\n", "the controller rejected the goal of `visit`"),
    (GOAL + "  stuck\n  expect visit accepted\n", "the last step sends no goal of `visit`"),
]
READ = [
    ("  request from light\n  expect light rejected\n", "`Lamp.light` takes no goals"),
    ("  expect response to visit accepted\n", "only a goal is accepted or rejected"),
    (
        "  expect request from light sent\n",
        "the request from `Lamp.light` comes from the robot, not from the controller",
    ),
    ("  response to light\n", "the response to `Lamp.light` does not come from the robot"),
    ("  every 1 s cancel from visit\n", "the cancel from `Base.visit` cannot be repeated"),
    ("  cancel from visit with 3\n", "a request to cancel a goal has no data"),
]
UNFIT = [('  request from light with {"date": true}\n', "std_srvs/SetBool has no field `date`")]


@pytest.mark.parametrize("faults", [PLAYED, READ, UNFIT])
def test_lines_that_cannot_be_played_or_met(faults: list[tuple[str, str]]) -> None:
    rest = '  expect Base.home or !Base.home\nscenario "another"\n'
    found = findings(*(lines + rest for lines, _ in faults), "  expect Lamp.ready\n")
    assert [message for _, message, _ in found] == [message for _, message in faults]


def test_a_rejected_goal_is_a_hint() -> None:
    [(_, message, hint)] = findings(NEAR, "  expect go sent\n")
    assert message == "the request to `Base.go` was not sent since the last step"
    assert hint.endswith("; the controller rejected the goal of `visit`")


def test_an_answer_that_was_not_sent() -> None:
    lines = ("  expect canceled to visit sent\n", "  expect error to visit sent\n")
    assert [message for _, message, _ in findings(GOAL, lines[0])] == [
        "the answer `canceled` to `Base.visit` was not sent since the last step"
    ]
    assert [message for _, message, _ in findings(GOAL, lines[1])] == [
        "the error to `Base.visit` was not sent since the last step"
    ]


def test_a_cancel_that_no_transition_names(folder: Path) -> None:
    text = (folder / "visitor.rscd").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines(keepends=True) if "cancel" not in line]
    (folder / "visitor.rscd").write_text("".join(lines), encoding="utf-8")
    [(line, message, hint)] = findings(GOAL, "  cancel from visit\n", "  expect Base.driving\n")
    assert (line, message) == (3, "the controller rejects each request to cancel a goal of `visit`")
    assert hint == "write a transition `on cancel from visit` in the model"


def test_the_log_holds_the_clients(folder: Path) -> None:
    played('scenario "a"\n' + GOAL + "  cancel from visit\n  expect Base.home\n", "--traces", "logs")
    [log] = (folder / "logs").iterdir()
    entries = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    assert [(entry["direction"], entry["event"]) for entry in entries if entry["direction"] != "internal"] == [
        ("in", "action_visit.u_request"),
        ("out", "message_go.c_trigger"),
        ("in", "action_visit.u_cancel"),
        ("out", "action_visit.c_canceled"),
    ]
