"""The supervisory layer between an unmodified controller and a robot, in a running ROS graph.

The model is `tests/m2t/layer/usher.rscd`. The controller is `usher_driver.py`, started with the remappings of the
generated launch file. The robot and the steps are those of `usher_trial.py`.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate
from tests.ros.launching import launched
from tests.ros.running import Runner
from tests.ros.workspaces import DRIVER, HERE, USHER, Workspace, middleware

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

REFUSED = "the server refuses to cancel the goal"
UNANSWERED = "the server does not answer the request to cancel the goal within 2000 ms"


@dataclass(frozen=True)
class Trial:
    """Messages to robot and controller, blocked commands and states of each step; log, reports and output."""

    steps: dict[str, Any]
    log: list[dict[str, Any]]
    reports: list[dict[str, Any]]
    output: str

    def robot(self, step: str) -> list[Any]:
        """Return the messages that the robot received in a step."""
        received: list[Any] = self.steps[step]["robot"]
        return received

    def controller(self, step: str) -> list[Any]:
        """Return the messages that the controller received in a step."""
        told: list[Any] = self.steps[step]["controller"]
        return told

    def blocked(self, step: str) -> list[tuple[str, str, list[str]]]:
        """Return the commands that the layer blocked in a step, and the reasons."""
        return [(entry["name"], entry["reason"], entry["because"]) for entry in self.steps[step]["blocked"]]


@pytest.fixture(scope="module")
def trial(layers: Workspace | Runner, tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """Run the trial once with the compiled layer, and once with the layer run from its model."""
    folder = tmp_path_factory.mktemp("layer") / "run"
    results, log, reports = folder / "results.json", folder / "events.jsonl", folder / "reports.jsonl"
    python = layers.ros.python
    with middleware(layers, folder) as processes:
        listener = [python, HERE / "reports.py", "2", "usher_layer", reports]
        listening = processes.start("reports", listener)
        processes.wait_until(reports.exists, "somebody listens to the layer's reports")
        layer = processes.start("layer", command(layers, f"event_log:={log}"))
        processes.start("driver", [python, DRIVER, *remapped()])
        script = processes.start("trial", [python, HERE / "usher_trial.py", results])
        processes.wait_until(lambda: script.poll() is not None, "all steps are done", seconds=900)
        assert script.returncode == 0, processes.logs()
        assert processes.stop(layer) == 0
        processes.stop(listening)
    lines, told = (
        [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] for file in (log, reports)
    )
    return Trial(json.loads(results.read_text()), lines, told, (folder / "layer.log").read_text())


def command(layers: Workspace | Runner, *parameters: str) -> Sequence[str | Path]:
    """Return the command that starts the layer."""
    if isinstance(layers, Runner):
        settings = USHER / "controller-config.json"
        return layers.command(USHER / "usher.rscd", *parameters, layer=True, configuration=settings)
    return layers.node("usher_layer", *parameters)


def remapped() -> list[str]:
    """Return the arguments with which the launch file starts the controller."""
    text = (USHER / "ros2-layer" / "launch" / "usher_layer.launch.py").read_text()
    remaps = launched(text).of("Node")[1].named["remappings"]
    return ["--ros-args", *(word for name, other in remaps for word in ("-r", f"{name}:={other}"))]


def test_messages_pass_in_both_directions(trial: Trial) -> None:
    assert trial.robot("allowed") == [["speed", 0.5]]
    assert trial.controller("allowed") == [["battery", 80]]
    assert trial.blocked("allowed") == []


def test_what_can_not_be_read_is_handed_on_but_counts_as_not_received(trial: Trial) -> None:
    assert (trial.controller("short"), trial.controller("long")) == ([["scan", 1]], [["scan", 2]])
    assert "/scan: there is no element 1 in an array of 1" in trial.output
    scans = [entry["data"] for entry in trial.log if entry["event"] == "message_scan.u_response"]
    assert scans == [{"value": {"ranges": {"1": 0.75}}}]
    scanner = trial.steps["low"]["blocked"][0]["components"]["Scanner"]
    assert scanner == {"state": "seen", "variables": {"second": 0.75}}


def test_what_a_requirement_forbids_is_blocked_and_told(trial: Trial) -> None:
    # The layer sends the provided data of the model, once, in place of the blocked command.
    assert trial.robot("low") == [["speed", 0.25]]
    assert trial.blocked("low") == [("Drive.speed", "requirement", ["requirement speed needs Guard.charge > 20"])]
    assert trial.steps["low"]["blocked"][0]["components"]["Guard"] == {"state": "clear", "variables": {"charge": 10}}
    assert "Drive.speed is blocked: requirement" in trial.output


def test_the_supervisor_hears_before_the_controller(trial: Trial) -> None:
    # The controller sends a speed as soon as it receives the stop: twenty times.
    assert trial.robot("stops") == []
    assert trial.blocked("stops") == 20 * [("Drive.speed", "requirement", ["requirement speed needs Guard.clear"])]
    told = [(entry["direction"], entry["event"]) for entry in trial.log]
    first = told.index(("in", "message_stop.u_response"))
    assert told[first + 1] == ("blocked", "message_speed.c_trigger")


def test_a_service_is_called_and_answers(trial: Trial) -> None:
    assert (trial.robot("light"), trial.controller("light")) == ([["light", True]], [["light", True]])
    assert trial.controller("no light") == [["light", False]]
    assert trial.steps["light"]["states"][-1]["components"]["Lamp"]["variables"] == {"lit": True}
    assert trial.steps["no light"]["states"][-1]["components"]["Lamp"]["variables"] == {"lit": False}


def test_a_second_call_is_busy(trial: Trial) -> None:
    assert trial.robot("two calls") == [["light", True]]
    assert trial.blocked("two calls") == [("Lamp.light", "busy", [])]
    # Both calls wait for their answers, in any order.
    assert sorted(trial.controller("two calls")) == [["light", False], ["light", True]]


def test_a_blocked_call_fails_and_a_blocked_goal_is_rejected(trial: Trial) -> None:
    assert trial.robot("forbidden") == []
    assert trial.blocked("forbidden")[1:] == [
        ("Lamp.light", "requirement", ["requirement light needs Guard.clear"]),
        ("Navigation.go_to", "requirement", ["requirement go_to needs Guard.clear"]),
    ]
    answers = [answer for answer in trial.controller("forbidden") if answer[0] in ("light", "go_to")]
    assert sorted(answers) == [["go_to", "REJECTED"], ["light", False]]


def test_a_goal_runs_to_its_end(trial: Trial) -> None:
    assert trial.robot("succeeded") == [["go_to", 1.0]]
    assert trial.controller("succeeded") == [["feedback", 0.5], ["go_to", "REJECTED"], ["go_to", "SUCCEEDED"]]
    assert trial.blocked("succeeded") == [("Navigation.go_to", "busy", [])]
    assert (trial.robot("aborted"), trial.controller("aborted")) == ([["go_to", 3.0]], [["go_to", "ABORTED"]])
    assert (trial.robot("rejected"), trial.controller("rejected")) == ([["go_to", 4.0]], [["go_to", "REJECTED"]])


def test_the_controller_may_always_cancel(trial: Trial) -> None:
    assert trial.robot("cancelled by the controller") == [["go_to", 5.0], ["cancel", True]]
    assert trial.controller("cancelled by the controller") == [["go_to", "CANCELED"]]
    assert events(trial, "cancelled by the controller")[:3] == [
        "action_go_to.c_trigger",
        "action_go_to.u_error",
        "action_go_to.c_reset",
    ]


def test_the_layer_cancels_a_goal_whose_requirement_has_fallen(trial: Trial) -> None:
    assert trial.robot("cancelled by the layer") == [["go_to", 6.0], ["cancel", True]]
    # ROS does not preserve order across topics.
    assert sorted(trial.controller("cancelled by the layer")[:2]) == [["go_to", "CANCELED"], ["stop", True]]
    happened = events(trial, "cancelled by the layer")
    assert happened[:3] == ["action_go_to.c_trigger", "message_stop.u_response", "action_go_to.c_cancel"]
    # The robot may send resume before the goal has ended.
    assert sorted(happened[3:]) == ["action_go_to.u_canceled", "message_resume.u_response"]
    assert trial.controller("the next goal") == [["go_to", "SUCCEEDED"]]


def test_a_goal_that_is_cancelled_before_there_is_a_server_is_never_sent(trial: Trial) -> None:
    step = "cancelled before there is a server"
    assert trial.robot(step) == []
    assert ["go_to", "REJECTED"] in trial.controller(step)
    happened = events(trial, step)[-4:]
    assert happened[:2] == ["message_stop.u_response", "action_go_to.c_cancel"]
    assert sorted(happened[2:]) == ["action_go_to.u_canceled", "message_resume.u_response"]


def test_a_goal_that_is_accepted_too_late_is_cancelled(trial: Trial) -> None:
    assert trial.robot("accepted too late") == [["go_to", 10.0], ["cancel", True]]
    assert trial.controller("accepted too late") == [["go_to", "CANCELED"]]
    assert "action_go_to.u_error" in events(trial, "accepted too late")
    assert "/go_to: not accepted within 2000 ms" in trial.output


def test_a_cancel_that_the_robot_refuses_is_told(trial: Trial) -> None:
    step = "a cancel that the robot refuses"
    # The layer repeats the request.
    assert trial.robot(step)[:2] == [["go_to", 11.0], ["cancel", True]]
    assert ["go_to", "SUCCEEDED"] in trial.controller(step)
    assert "action_go_to.u_response" in events(trial, step)
    assert f"/go_to: {REFUSED}" in trial.output


def test_nobody_waits_for_a_robot_that_does_not_answer_a_cancel(trial: Trial) -> None:
    step = "cancels that the robot does not answer"
    assert trial.robot(step)[:3] == [["go_to", 12.0], ["cancel", True], ["cancel", True]]
    assert sorted(trial.controller(step)) == [
        ["cancel", "REJECTED"],
        ["go_to", "SUCCEEDED"],
        ["resume", True],
        ["stop", True],
    ]
    assert f"/go_to: {UNANSWERED}" in trial.output


def test_a_late_answer_is_none(trial: Trial) -> None:
    assert trial.controller("late") == [["light", False]]
    assert "/lamp/light: no answer within 2000 ms" in trial.output
    assert (trial.robot("the next call"), trial.controller("the next call")) == ([["light", False]], [["light", True]])


def test_what_lasts_still_lasts(trial: Trial) -> None:
    assert trial.steps["labels"] == ["here I am"]


def test_what_goes_on_is_reliable_however_it_was_heard(trial: Trial) -> None:
    assert trial.steps["qualities"] == {"hears": 3 * ["BEST_EFFORT"], "sends": 3 * ["RELIABLE"]}


def test_everything_fits_its_schema(trial: Trial) -> None:
    steps = [step for step in trial.steps.values() if "states" in step]
    told = {
        "blocked": [entry for step in steps for entry in step["blocked"]],
        "state": [state for step in steps for state in step["states"]],
        "event-log": trial.log,
    }
    for name, lines in told.items():
        validator = Draft202012Validator(json.loads(locate(f"schemas/{name}.schema.json").read_text()))
        assert lines
        assert not [error for line in lines for error in validator.iter_errors(line)]
    # Provided data has no events in a layer.
    assert not [entry for entry in trial.log if entry["event"].startswith("data_")]


def events(trial: Trial, step: str) -> list[str]:
    """Return the events of a step by `~/state`, except those of the battery message that ends each step."""
    happened = [event for state in trial.steps[step]["states"] for event in state["transitions"]]
    return [event for event in happened if event != "message_battery.u_response"]
