"""Live view of a running robot, from the reports of its node."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from robosc.base.files.json_reading import JsonError, json_value
from robosc.model.semantics.definition import definition
from robosc.run.simulation.tracker import ReportError, Tracker
from robosc.tools.view.moments import Moments

if TYPE_CHECKING:
    from robosc.model import rosgraph
    from robosc.run.simulation import Simulation

#: Maximum number of moments that a live view stores.
CAPACITY = 20_000


class Live(Moments):
    """Moments of a running node; `nodes` are the names of the nodes that may report them."""

    def __init__(self, simulation: Simulation, graph: rosgraph.RosGraph, nodes: str, capacity: int = CAPACITY) -> None:
        super().__init__(simulation, graph, capacity)
        self._nodes = nodes
        self._tracker = Tracker(self.engine)
        self._definition = json.dumps(definition(graph), sort_keys=True)
        self._began: float | None = None
        self._publishers = 0
        #: Faults of the received texts, by the topic.
        self._faults: dict[str, str] = {}
        self._say()

    def heard(self, publishers: int) -> None:
        """Receive the number of nodes that publish their state; called periodically."""
        self._publishers = publishers
        self._say()

    def receive_definition(self, text: str) -> None:
        """Receive the JSON text of a definition, when a node or this listener has started."""
        self._faults.clear()
        try:
            if json.dumps(json_value(text), sort_keys=True) != self._definition:
                self._faults["definition"] = "The node runs another version of the model: the page may be wrong."
        except JsonError as error:
            self._faults["definition"] = f"The node's report about its model cannot be read: {error}."
        self._tracker.begin()
        self._say()

    def receive_report(self, text: str) -> None:
        """Receive the JSON text of one report on `~/state`."""
        try:
            report = json_value(text)
            followed = self._tracker.report(report)
        except (JsonError, ReportError) as error:
            self._faults["state"] = f"The node's report cannot be shown: {error}."
            self._say()
            return
        self._faults.pop("state", None)
        if self._began is None:
            self._began = report["time"]
        time = round(report["time"] - self._began, 3)
        for reported in followed:
            self._add_told(time, self._tracker.timers.running, reported)
        self._say()

    def _say(self) -> None:
        if self._faults:
            self.status = next(iter(self._faults.values()))
        elif self._publishers > 1:
            self.status = f"{self._publishers} nodes report their states, shown here as one: choose one with --node."
        elif self._publishers == 0:
            self.status = f"Waiting for {self._nodes}{'' if self._began is None else ' to come back'}."
        else:
            self.status = ""
