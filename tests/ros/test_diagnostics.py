"""Diagnostics of nodes agree with an engine that follows their reports on `~/state`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import robosc
from robosc.engine import Engine
from robosc.model import sct
from robosc.model.semantics.component_parts import components
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.roles import event_name
from robosc.run.runtime.core.json_text import json_text
from robosc.run.simulation.tracker import Tracker
from tests.ros.test_layer import trial
from tests.ros.workspaces import EXAMPLES, USHER

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.conftest import Drive
    from tests.ros.test_layer import Trial

__all__ = ["trial"]

#: Times in a log and in a message may have different rounding errors.
CLOCKS = 0.001


class Witness:
    """Engine that follows the reports of a node and predicts each status."""

    def __init__(self, path: Path) -> None:
        robot = robosc.load(path)
        self.model, self.graph = robosc.to_sct(robot), robosc.to_rosgraph(robot)
        robosc.synthesize(self.model)
        self.engine = Engine(self.model)
        self.tracker = Tracker(self.engine)
        self.commands = [
            event for plant in self.model.plants for event in plant.events if event.kind == sct.EventKind.trigger
        ]

    def statuses(self, state: dict[str, Any]) -> dict[str, dict[str, str | None]]:
        """Return the values of each component's status for a report on `~/state`; None if a number is not finite."""
        list(self.tracker.report(state))
        told: dict[str, dict[str, str | None]] = {
            name: {"state": component["state"], **{key: text(value) for key, value in component["variables"].items()}}
            for name, component in state["components"].items()
        }
        for event in self.commands:
            component, _, name = event.eContainer().origin.rpartition(".")
            told.setdefault(component, {})[f"request to {name}"] = self.verdict(event)
        return told

    def verdict(self, event: sct.Event) -> str:
        """Return the status of a command, as far as the engine determines it."""
        if self.engine.enabled(event_name(event)):
            return "allowed"
        failing = [str(requirement.text) for requirement in self.engine.failing_requirements(event_name(event))]
        if failing:
            return f"forbidden: {'; '.join(failing)}"
        places = [plant.locations[self.engine.location(plant)] for plant in self.model.plants if edges_of(plant, event)]
        stuck = [place for place in places if not edges_from(place, event)]
        where = ", ".join(f"{place.eContainer().origin}.{place.name}" for place in stuck)
        return f"not possible in {where}" if stuck else "forbidden by synthesis"


def text(value: object) -> str | None:
    """Return the text of a status for a value of `~/state`."""
    return value if isinstance(value, str | None) else json_text(value)  # type: ignore[arg-type]


def compare(reports: list[dict[str, Any]], path: Path, node: str) -> list[dict[str, Any]]:
    """Compare each report on `/diagnostics` with the last one on `~/state` before it; return all statuses."""
    witness, statuses, expected = Witness(path), [], None
    told = [report for report in reports if report["topic"] != "definition"]
    names = [f"{node}: {parts.name}" for parts in components(witness.graph)]
    for report in sorted(told, key=lambda report: (report["data"]["time"], report["topic"] == "diagnostics")):
        if report["topic"] == "state":
            expected = witness.statuses(report["data"])
        elif expected is not None:
            assert [status["name"] for status in report["data"]["status"]] == names
            seen = {status["name"]: dict(status["values"]) for status in report["data"]["status"]}
            for name, values in expected.items():
                found = seen.pop(f"{node}: {name}", {})
                unread = {
                    key for key, value in values.items() if value is None and found.get(key) in ("nan", "inf", "-inf")
                }
                assert {key: None if key in unread else value for key, value in found.items()} == values
            assert all(not values for values in seen.values()), "others have nothing to tell of"
            statuses += report["data"]["status"]
    for status in statuses:
        assert status["hardware_id"] == witness.model.name
        state, *faults = status["message"].split("; ")
        assert state == dict(status["values"]).get("state", "has no states")
        assert status["level"] == bool(faults)
    return statuses


def test_a_controller_says_what_its_engine_knows(drive: Drive) -> None:
    path = EXAMPLES / "line_follower" / "line_follower.rscd"
    statuses = compare(drive.reports, path, "line_follower_controller")
    said = {dict(status["values"]).get("request to move") for status in statuses} - {None}
    assert {
        "allowed",
        "forbidden: requirement move needs LineDetector.following and Lidar.free and EmergencyStop.in_service",
    } == said


def test_a_layer_says_what_its_engine_knows_and_what_it_blocked(trial: Trial) -> None:
    compare(trial.reports, USHER / "usher.rscd", "usher_layer")
    blocked = [(entry["time"], entry["event"]) for entry in trial.log if entry["direction"] == "blocked"]
    told, before = set(), 0.0
    for report in sorted(
        (report["data"] for report in trial.reports if report["topic"] == "diagnostics"),
        key=lambda report: report["time"],
    ):
        # Commands blocked since the previous report, and no others.
        since = {
            f"{name.partition('.')[0].partition('_')[2]} was blocked"
            for time, name in blocked
            if before - CLOCKS <= time <= report["time"] + CLOCKS
        }
        faults = {fault for status in report["status"] for fault in status["message"].split("; ")[1:]}
        # A report also lists a goal that should have ended, as long as it has not.
        troubles = {fault for fault in faults if fault.startswith("/go_to: ")}
        assert all(trouble in trial.output for trouble in troubles), "the layer has warned of it"
        assert faults - troubles <= since
        told |= faults - troubles
        before = report["time"]
    # The layer blocked each of these in several steps, with reports in between.
    assert told == {"speed was blocked", "light was blocked", "go_to was blocked"}
