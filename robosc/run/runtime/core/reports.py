"""Reports of a node about itself on `~/state` and `~/definition`, and limits on repeated warnings."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from robosc.model import rosgraph, sct
from robosc.model.semantics.definition import TRANSITIONS_KEPT, definition_text, reported_variables
from robosc.model.semantics.roles import assumption_name
from robosc.run.runtime.core.event_log import format_value
from robosc.run.runtime.core.json_text import Json, json_text

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    from robosc.engine import Engine
    from robosc.language.configuration import Configuration
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import Port
    from robosc.run.runtime.core.violations import Violations

#: Seconds between two warnings of one kind.
_PAUSE = 5.0


class StateReporter:
    """Publish the state on every change, and for every new subscription; do nothing without subscriptions."""

    def __init__(  # noqa: PLR0913, PLR0917 - the sources of a report
        self,
        graph: rosgraph.RosGraph,
        engine: Engine,
        data: NodeData,
        port: Port,
        configuration: Configuration,
        violations: Violations,
    ) -> None:
        self._graph = graph
        self._engine = engine
        self._data = data
        self._port = port
        self._publishes = configuration.publish_state_information
        self._listeners = 0
        self._violations = violations
        self._violated = 0
        self._transitions: deque[str] = deque(maxlen=TRANSITIONS_KEPT)
        shown = reported_variables(graph)
        self._components: list[tuple[str, sct.Plant, Sequence[rosgraph.NodeVariable]]] = [
            (plant.origin or plant.name, plant, shown.get(plant.origin, ()))
            for plant in graph.model.plants
            if plant.kind == sct.PlantKind.behaviour
        ]

    def publish_definition(self) -> None:
        """Publish the model's definition once; it is kept for late subscribers."""
        if self._publishes:
            self._port.publish_report("definition", definition_text(self._graph))

    def add_transition(self, event: str) -> None:
        """Add an event that has happened to the next report of the state."""
        if self._publishes:
            self._transitions.append(event)

    def publish_state(self, time: float) -> None:
        """Publish the state if it has changed or has a new subscription; `time` in seconds."""
        if not self._publishes:
            return
        listeners = self._port.report_listeners("state")
        violated = list(map(assumption_name, self._violations.assumptions))
        if listeners > self._listeners or (listeners and (self._transitions or len(violated) > self._violated)):
            report: dict[str, Json] = {
                "robot": self._graph.name,
                "time": time,
                "components": self.components(),
                "transitions": list(self._transitions),
                **({"violated": violated} if self._violations.exist else {}),
            }
            self._port.publish_report("state", json_text(report))
        self._listeners, self._violated = listeners, len(violated)
        self._transitions.clear()

    def components(self) -> dict[str, Json]:
        """Return the state and the variables of each component."""
        return {
            name: {
                "state": plant.locations[self._engine.location(plant)].name,
                "variables": {
                    **{variable.name: self._engine.value(variable) for variable in plant.variables},
                    **{variable.name: format_value(self._data.variables[variable]) for variable in variables},
                },
            }
            for name, plant, variables in self._components
        }


class Throttle:
    """Pass on at most one warning of each kind in five seconds."""

    def __init__(self, warn: Callable[[str], None], clock: Callable[[], float]) -> None:
        self._warn = warn
        self._clock = clock
        self._last: dict[Hashable, float] = {}

    def __call__(self, kind: Hashable, text: str) -> None:
        """Warn, unless the last warning of this kind was too recent."""
        now = self._clock()
        if now - self._last.get(kind, -_PAUSE * 2) >= _PAUSE:
            self._last[kind] = now
            self._warn(text)
