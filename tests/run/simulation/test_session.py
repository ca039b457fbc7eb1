"""Simulation by hand, in the terms of its user."""

from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.supervise import supervise
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import Session
from robosc.tools.cli import main

MODEL = Path(__file__).parent / "gauge.rscd"


@pytest.fixture
def session() -> Session:
    robot = robosc.load(str(MODEL))
    graph = robosc.to_rosgraph(robot)
    supervise(graph.model)
    return Session(Simulation(graph.model, graph), seed=3)


def test_an_event_by_its_number_or_name_shows_what_changes(session) -> None:
    assert session.do("") == session.do("e")
    listed = dict(reversed(line.split()) for line in session.do("e").splitlines())
    assert session.do(listed["message_level.u_response"] + ' {"value": 3}') == (
        "message_level.u_response\n  Gauge.level = 3"
    )
    assert session.do('message_level.u_response {"value": 3}') == "message_level.u_response"


def test_undo_takes_back_one_event_at_a_time(session) -> None:
    before = session.do("s")
    session.do('message_level.u_response {"value": 3}')
    session.do("message_drain.c_trigger")
    assert session.do("u") == "undone: message_drain.c_trigger\n  component_Gauge = metering"
    session.do("u")
    assert session.do("s") == before
    assert session.do("u") == "nothing to undo"


def test_it_says_why_an_event_is_disabled(session) -> None:
    text = "requirement refill needs Gauge.level < 3 and Gauge.slots > 1"
    assert f"message_refill.c_trigger: forbidden by {text}" in session.do("d")
    session.do("message_drain.c_trigger")
    assert "message_refill.c_trigger: the robot is not ready for it" in session.do("d").splitlines()


def test_traces_are_saved_and_loaded(session, tmp_path) -> None:
    file = tmp_path / "trace.jsonl"
    session.do("r 20")
    state, trace = session.do("s"), session.do("t")
    assert session.do(f"save {file}") == f"20 events in {file}"
    for _ in range(20):
        session.do("u")
    assert session.do("s") != state
    session.do(f"load {file}")
    assert (session.do("s"), session.do("t")) == (state, trace)


@pytest.mark.parametrize("line", ["99", "nonsense", "save", "load", "r x", 'message_level.u_response {"value": "x"}'])
def test_a_command_that_can_not_be_understood_changes_nothing(session, line) -> None:
    before = session.do("s")
    assert session.do(line)
    assert session.do("s") == before


def test_it_ends(session) -> None:
    assert not session.ended
    session.do("q")
    assert session.ended


@pytest.mark.parametrize(
    "line",
    [
        "9" * 5000,
        f"r {'9' * 5000}",
        "r 99999999999999999999",
        "r -1",
        "r ²",
        "²",
        "#",
        "# 1",
        "\u2028",
        "e\u2028",
    ],
)
def test_no_line_is_too_much(session, line) -> None:
    session.do(line)
    assert session.do("t") == "nothing yet"


@pytest.mark.parametrize(
    "line", ["save \0", "load \0", "load .", "save .", "9" * 5000, "r 99999999999999999999", "\udcff", "#"]
)
def test_the_conversation_goes_on(line, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, ["simulate", str(MODEL)], input=f"{line}\ns\nq\n".encode(errors="surrogateescape"))
    assert (done.exit_code, done.exception) == (0, None)
    assert "Gauge.level = 0" in done.output


@pytest.mark.parametrize("word", ["h", "help", "?"])
def test_help_has_more_than_one_name(session, word) -> None:
    assert "perform" in session.do(word)


def test_what_is_no_command_is_said_with_what_is(session) -> None:
    assert session.do("hlep") == "unknown command or event `hlep` (h for help)"
    assert session.do("message_drain.trigger") == (
        "unknown command or event `message_drain.trigger`, did you mean `message_drain.c_trigger`? (h for help)"
    )
