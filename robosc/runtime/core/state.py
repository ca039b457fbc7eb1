"""Tells on `~/state` and `~/definition` what a node is and does."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from robosc.metamodel import rosgraph, sct
from robosc.runtime.core.json_text import Json, json_text
from robosc.runtime.core.reports import shown
from robosc.semantics.definition import TRANSITIONS_KEPT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.configuration import Configuration
    from robosc.engine import Engine
    from robosc.runtime.core.node_data import NodeData
    from robosc.runtime.core.port import Reporting


class StateReporter:
    """Publishes the state on every change, and to everyone who begins to listen; does nothing while nobody listens."""

    def __init__(
        self, graph: rosgraph.RosGraph, engine: Engine, data: NodeData, port: Reporting, configuration: Configuration
    ) -> None:
        self._robot = graph.name
        self._engine = engine
        self._data = data
        self._port = port
        self._publishes = configuration.publish_state_information
        self._listeners = 0
        self._transitions: deque[str] = deque(maxlen=TRANSITIONS_KEPT)
        self._components: list[tuple[str, sct.Plant, Sequence[rosgraph.NodeVariable]]] = [
            (plant.origin or plant.name, plant, [each for each in graph.variables if each.component == plant.origin])
            for plant in graph.model.plants
            if plant.kind == sct.PlantKind.behaviour
        ]

    def define(self, text: str) -> None:
        """Tells the definition, once."""
        if self._publishes:
            self._port.tell("definition", text)

    def note(self, event: str) -> None:
        """An event has happened."""
        if self._publishes:
            self._transitions.append(event)

    def publish(self, time: float) -> None:
        """Tells the state, if there is something to tell and somebody to listen."""
        if not self._publishes:
            return
        listeners = self._port.listeners("state")
        if listeners > self._listeners or (listeners and self._transitions):
            report: dict[str, Json] = {
                "robot": self._robot,
                "time": time,
                "components": self.components(),
                "transitions": list(self._transitions),
            }
            self._port.tell("state", json_text(report))
        self._listeners = listeners
        self._transitions.clear()

    def components(self) -> dict[str, Json]:
        """The state and the variables of each component."""
        return {
            name: {
                "state": plant.locations[self._engine.location(plant)].name,
                "variables": {
                    **{each.name: self._engine.value(each) for each in plant.variables},
                    **{each.name: shown(self._data.variables[each]) for each in variables},
                },
            }
            for name, plant, variables in self._components
        }
