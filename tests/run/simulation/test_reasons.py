"""Reasons and results of errors in scripts, and steps in the words of scenarios."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.run.simulation import LoopSimulation, Simulation, read_script
from robosc.run.simulation.replay import Replay
from robosc.run.simulation.script import REFUSE
from robosc.run.simulation.session import Session, trace_line
from robosc.run.simulation.stored_variables import StoredVariables
from robosc.tools.cli import main

MODEL = Path(__file__).parent / "crane.rscd"
SERVICE = ("failed", "timeout", "unavailable", "unreadable")
ACTION = ("aborted", "canceled", "lost", "rejected", "timeout", "unavailable", "unreadable")


def simulate(*lines: str, options: tuple[str, ...] = ()) -> Any:
    command = ["simulate", str(MODEL), "--script", "-", *options]
    return CliRunner().invoke(main, command, input="\n".join(lines), catch_exceptions=False)


def play(*lines: str, options: tuple[str, ...] = ()) -> list[dict[str, Any]]:
    done = simulate(*lines, options=options)
    assert done.exit_code == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def faults(*lines: str, options: tuple[str, ...] = ()) -> list[str]:
    done = simulate(*lines, options=options)
    assert done.exit_code == 1, done.stdout
    return [line for line in done.stderr.splitlines() if "[script]" in line]


@pytest.fixture(scope="module")
def crane() -> Any:
    robot = robosc.load(MODEL)
    robosc.synthesize(robosc.to_sct(robot))
    return robosc.to_rosgraph(robot)


STARTED = "action_go.c_trigger"
PRESSED = 'message_stop.u_response {"value": true}'
CALLED = (PRESSED, "service_lift.c_trigger")


@pytest.mark.parametrize(
    ("line", "state", "why"),
    [
        ("action_go.u_error", "low", "aborted"),
        ('action_go.u_error {"reason": "rejected"}', "low", "rejected"),
        ('action_go.u_error {"value": {"code": 0, "rest": 0.0}, "reason": "lost"}', "unknown", "lost"),
        ('action_go.u_error {"value": {"path": []}, "reason": "lost"}', "unknown", "lost"),
        ('action_go.u_error {"where": {"value.path[1] > 0.5": false}, "reason": "lost"}', "unknown", "lost"),
        ('action_go.u_error {"where": {"error": "timeout"}}', "low", "timeout"),
        ('action_go.u_error {"where": {"error": "timeout"}, "reason": "rejected"}', "low", "rejected"),
        ("error from go", "low", "aborted"),
        ("error from Base.go because canceled", "low", "canceled"),
        ('error from go because aborted with {"code": 8}', "low", "aborted"),
        ("error from go because lost", "unknown", "lost"),
    ],
)
def test_the_reason_of_a_goal(line: str, state: str, why: str) -> None:
    """Without `because`, an error is `aborted` for actions."""
    answer = play(STARTED, line)[-1]
    assert (answer["accepted"], answer["event"]) == (True, "action_go.u_error")
    assert (answer["state"]["component_Base"], answer["state"]["Base.why"]) == (state, why)
    assert answer["state"]["Base.code"] == (8 if "8" in line else 0)


@pytest.mark.parametrize(
    ("line", "state", "why"),
    [
        ("service_lift.u_error", "low", "failed"),
        ("error from lift", "low", "failed"),
        ("error from lift because timeout", "unknown", "lost"),
        ('service_lift.u_error {"reason": "unavailable"}', "low", "unavailable"),
        # An old log has the readable part of an answer.
        ('service_lift.u_error {"value": {"heights": []}}', "unread", "lost"),
        ('error from lift with {"heights": []}', "unread", "lost"),
    ],
)
def test_the_reason_of_a_call(line: str, state: str, why: str) -> None:
    """Without `because`, an error is `failed` for services."""
    answer = play(*CALLED, line)[-1]
    assert (answer["state"]["component_Base"], answer["state"]["Base.why"]) == (state, why)


@pytest.mark.parametrize(
    ("line", "possible"),
    [
        ('action_go.u_error {"reason": "failed"}', ACTION),
        ("error from go because failed", ACTION),
        ("error from lift because lost", SERVICE),
        ('service_lift.u_error {"reason": 3}', SERVICE),
        ('service_lift.u_error {"where": {"error": "aborted"}}', SERVICE),
    ],
)
def test_a_reason_that_an_event_cannot_have(line: str, possible: tuple[str, ...]) -> None:
    (found,) = faults(STARTED, line)
    assert all(reason in found for reason in possible)
    assert found.startswith("<stdin>:2:1: error: ")


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("response from go because lost", "only the error of a service or an action has a reason"),
        ('action_go.u_canceled {"reason": "canceled"}', "only the error of a service or an action has a reason"),
        ("error from og", "there is no event `og.error`"),
        ("error from go because", "this is not a step of a scenario"),
        ("error of go", "this is not a step of a scenario"),
        ("refuse cancel of lift", "there is no event `lift.canceled`"),
        ("error from go with message 3", "a message must be an object with fields"),
        ("go", "there is no event `go`"),
        ('error from go because lost with {"rest": 2.0}', "an error with the reason `lost` has no data"),
        ('error from lift because timeout with {"heights": []}', "an error with the reason `timeout` has no data"),
        ('{"event": "action_go.u_error", "reason": "lost"}', "`reason` is part of the data"),
        ('{"event": "action_go.u_error", "data": {"reason": "lost"}, "value": {"rest": 2.0}}', "`value` is part of"),
    ],
)
def test_steps_that_cannot_be_read(line: str, fault: str) -> None:
    (found,) = faults(line)
    assert fault in found


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        ('{"value": {"rest": 2.0}, "reason": "lost"}', "but value.rest is 2.0"),
        ('{"value": {"path": [0.0, 3.0]}, "reason": "lost"}', "but value.path has elements"),
        ('{"where": {"value.path[1] > 0.5": true}, "reason": "lost"}', "but `value.path[1] > 0.5` is true"),
        ('{"where": {"value.path[1] > 0.5": true, "error": "lost"}}', "but `value.path[1] > 0.5` is true"),
        ('{"value": {"code": 8}, "reason": "rejected"}', "but value.code is 8"),
        ('{"value": 3, "reason": "lost"}', "value is 3, expected an object"),
    ],
)
def test_data_of_an_error_that_brings_none(data: str, fault: str) -> None:
    """`lost`, `rejected` and `unavailable` have at most the data of a new result, as in logs."""
    (found,) = faults(STARTED, f"action_go.u_error {data}")
    assert fault in found


def test_a_literal_of_an_error_that_brings_no_data(tmp_path: Path) -> None:
    """The node takes the literal from a new result, as its log shows."""
    model = tmp_path / "go.rscd"
    model.write_text(GO)
    line = '{"event": "action_go.u_error", "data": {"value": {"mode": "%s"}, "reason": "lost"}}'
    for data, state in [("", "off"), (line % "zero", "off"), (line % "positive", None)]:
        lines = f"{STARTED}\n{data or 'error from go because lost'}"
        done = CliRunner().invoke(main, ["simulate", str(model), "--script", "-"], input=lines, catch_exceptions=False)
        assert done.exit_code == (state is None), done.stderr
        if state is None:
            assert 'has no data, but value.mode is "positive"' in done.stderr
        else:
            assert json.loads(done.stdout.splitlines()[-1])["state"]["component_Base"] == state


GO = """robot Go {
  interface going use Go from go_msgs
  datatype enum Mode from integer to { value = 0 -> zero default -> positive }
  datatype object Done { mode: Mode }
  component Base {
    action go with identifier: "/go", request: none, response: Done, feedback: none links going
    behaviour {
      initial marked state idle { on request to go goto going }
      state going {
        on cancel from go goto going
        on response from go goto idle
        on canceled from go goto idle
        on error from go if value.mode = zero goto off
        on error from go goto other
      }
      marked state off {}
      marked state other {}
    }
  }
}"""


@pytest.mark.parametrize("loop", [(), ("--loop",)])
@pytest.mark.parametrize(
    ("data", "by"),
    [
        ('{"path": [1.0]}', "data"),
        ('{"path": {"0": 1.0}}', "data"),
        ('{"path": []}', None),
        ('{"code": 5}', None),
    ],
)
def test_an_error_that_can_be_read(data: str, by: str | None, loop: tuple[str, ...]) -> None:
    """The response from `go` reads `value.path[0]`."""
    start = "tick" if loop else STARTED
    answer = play(start, f"error from go because unreadable with {data}", options=loop)[-1]
    assert (answer["accepted"], answer["by"]) == (by is None, by)
    assert answer["state"]["component_Base"] == ("going" if by else "low")


def test_an_answer_that_can_be_read_by_hand(crane: Any) -> None:
    session = Session(Simulation(crane.model, crane), seed=0)
    session.do("request to go")
    told = session.do('error from go because unreadable with {"path": [1.0]}')
    assert told == "action_go.u_error: the node can read this data, so it counts as action_go.u_response"
    told = session.do('action_go.u_error {"value": {"code": "x"}}')
    assert told == 'action_go.u_error: value.code is "x", expected an integer'
    assert session.do("error from go with null") == (
        '`null` is not data (leave it out; `{"data": null}` is a number that is not finite)'
    )


def test_the_place_of_data_that_is_no_json() -> None:
    (found,) = faults('  error from go with {"code": }')
    assert found.startswith("<stdin>:1:31: error: not JSON")


def test_of_what_an_array_lacks_a_condition_is_false() -> None:
    """An `error` or `canceled` always happens."""
    for path, state in [([], "low"), ([9.0], "low"), ([0.0, 9.0], "blocked"), ([0.0, 0.25], "low")]:
        answer = play(STARTED, f"error from go with {json.dumps({'path': path})}")[-1]
        assert (answer["by"], answer["state"]["component_Base"]) == (None, state)


def test_a_canceled_goal_has_a_result() -> None:
    for data, state in [('{"value": {"code": 3}}', "idle"), ("", "low")]:
        answer = play(STARTED, PRESSED, "action_go.c_cancel", f"action_go.u_canceled {data}")[-1]
        assert answer["state"]["component_Base"] == state
    answer = play(STARTED, "response from stop with true", "cancel to go", 'canceled from go with {"code": 3}')[-1]
    assert answer["state"]["component_Base"] == "idle"


def test_the_loop_reads_an_answer_that_cannot_be_read_as_an_error() -> None:
    answers = play("tick", 'action_go.u_response {"value": {"code": 4, "path": []}}', options=("--loop",))
    assert (answers[-1]["by"], answers[-1]["happened"][0]) == ("data", "action_go.u_error")
    state = answers[-1]["state"]
    assert (state["component_Base"], state["Base.why"], state["Base.code"]) == ("low", "unreadable", 4)


def test_the_loop_takes_steps_in_words() -> None:
    lines = ("tick", "stop", "response from stop with true", "refuse cancel of go", "canceled from go")
    (found,) = faults(*lines, options=("--loop",))
    assert "there is no event `stop`" in found
    lines = ("tick", "response from stop with true", "refuse cancel of go", "canceled from go", "refuse cancel of go")
    answers = play(*lines, options=("--loop",))
    assert [answer["accepted"] for answer in answers] == [True, True, True, True, False]
    assert answers[2] | {"state": {}} == {
        "event": "refuse cancel",
        "of": "action_go",
        "accepted": True,
        "by": None,
        "happened": [],
        "state": {},
    }
    assert answers[4]["by"] == "plant"
    (found,) = faults("request to go", options=("--loop",))
    assert "`action_go.c_trigger` is not a line of a script with the control loop" in found


def test_a_refused_cancel_changes_nothing() -> None:
    refusal = "refuse cancel of go"
    early, *_, canceled, refused = play(refusal, STARTED, PRESSED, "action_go.c_cancel", refusal)
    assert [early["by"], canceled["by"], refused["by"]] == ["plant", None, None]
    assert refused["state"] == canceled["state"]


def test_a_refused_cancel_in_a_replay(crane: Any) -> None:
    simulation = Simulation(crane.model, crane)
    lines = f"{STARTED}\n{PRESSED}\nrefuse cancel of go\naction_go.c_cancel\nrefuse cancel of go\n"
    steps, findings = read_script("", lines, simulation.engine.events, model=crane.model)
    assert findings == []
    replay = Replay(simulation, steps)
    moments = [replay.forward() for _ in steps]
    assert [moment and moment.happened for moment in moments] == [True, True, False, True, False]
    assert [moment and str(moment.by) for moment in moments] == ["None", "None", "plant", "None", "None"]
    end = simulation.engine.state
    while replay.back():
        pass
    assert simulation.trace == []
    while replay.forward():
        pass
    assert simulation.engine.state == end


def test_by_hand(crane: Any) -> None:
    session = Session(Simulation(crane.model, crane), seed=0)
    assert session.do("refuse cancel of go") == f"{REFUSE}: its goal is not being canceled"
    session.do("request to go")
    assert "component_Base = unknown" in session.do("error from go because lost")
    assert session.do("error from go because failed").startswith("action_go.u_error: the reason is")
    assert "this is not a step of a scenario" in session.do("error from")


def test_what_the_node_keeps(crane: Any) -> None:
    """The node stores `Base.rest`."""
    simulation = Simulation(crane.model, crane)
    kept = StoredVariables(simulation.engine, crane)
    assert kept.initial == {"Base.rest": 0}
    for data, rest in [
        ({"value": {"rest": 2.5}, "reason": "lost"}, 2.5),
        ({"value": {"path": [0.0, 0.25, 7.5]}}, 7.5),
        ({"value": {"path": [0.0, 0.25]}, "reason": "rejected"}, 0),
        ({"value": {"path": [0.0, 0.75, 7.5]}, "reason": "lost"}, 0),
        ({"reason": "lost"}, None),
    ]:
        simulation.perform(STARTED)
        before = simulation.engine.state
        assert simulation.perform("action_go.u_error", data).accepted
        assert kept.after(kept.initial, "action_go.u_error", data, before) == {"Base.rest": rest}
        simulation.undo()
        simulation.undo()


def test_random_events_have_reasons_and_can_be_played(crane: Any) -> None:
    """Every reason of each kind occurs. As a script, the events lead to the same state."""
    reasons: dict[str, set[str]] = {"action_go.u_error": set(), "service_lift.u_error": set()}
    random = Random(3)
    simulation = Simulation(crane.model, crane)
    for _ in range(150):
        for _ in range(6):
            simulation.random_step(random)
        end, lines = simulation.engine.state, "\n".join(map(trace_line, simulation.trace))
        while happened := simulation.undo():
            if happened.event in reasons:
                reasons[happened.event].add(happened.data["reason"])
        steps, findings = read_script("", lines, simulation.engine.events, model=crane.model)
        assert findings == []
        assert all(simulation.perform(step.event, step.data).accepted for step in steps)
        assert simulation.engine.state == end
        while simulation.undo():
            pass
    assert reasons == {"action_go.u_error": set(ACTION), "service_lift.u_error": set(SERVICE)}


@pytest.mark.slow
def test_random_events_are_a_script(tmp_path: Path) -> None:
    """Each of them can happen, also an error whose input is one of several fields that the model reads."""
    model = tmp_path / "crane.rscd"
    # The response can always be read, so that no error is `unreadable`.
    model.write_text(MODEL.read_text().replace("        on response from go if value.path[0] > 0.0 goto idle\n", ""))
    for seed in range(6):
        command = ["simulate", str(model), "--random", "60", "--seed", str(seed)]
        lines = CliRunner().invoke(main, command, catch_exceptions=False).stdout
        done = CliRunner().invoke(main, ["simulate", str(model), "--script", "-"], input=lines, catch_exceptions=False)
        assert done.exit_code == 0, done.stderr
        assert all(json.loads(line)["accepted"] for line in done.stdout.splitlines())


def test_without_a_graph_there_are_reasons(crane: Any) -> None:
    data = LoopSimulation(crane.model).data
    assert data.inputs("service_lift.u_error", {}) == {"i_error_reason": "failed"}
    assert data.inputs("service_lift.u_error", {"reason": "timeout"}) == {"i_error_reason": "timeout"}


def test_a_saved_model_has_the_reasons(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["transform", str(MODEL), "--to", "xmi", "-o", str(tmp_path)])
    assert done.exit_code == 0, done.output
    lines = f"{STARTED}\nerror from go because rejected\n"
    command = ["simulate", str(tmp_path / "Crane.sct.xmi"), "--script", "-"]
    answer = json.loads(CliRunner().invoke(main, command, input=lines).stdout.splitlines()[-1])
    assert answer["state"]["Base.why"] == "rejected"
