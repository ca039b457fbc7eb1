"""Reports on `/diagnostics`: a status for each component of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Literal

from robosc.model.semantics.component_parts import STATELESS, Parts, components, request
from robosc.model.semantics.roles import event_name
from robosc.run.runtime.core.event_log import format_value
from robosc.run.runtime.core.json_text import json_text
from robosc.run.runtime.core.port import ComponentStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.model import rosgraph, sct
    from robosc.run.runtime.core.blocking import Blocking
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import Port


@dataclass(frozen=True)
class Own:
    """Knowledge of a controller or layer beyond its engine."""

    #: Return the names of the assumptions that events of a component have violated.
    violated: Callable[[str], list[str]]
    #: Return why a command that the supervisor allows is held back; None if it can be sent.
    held_back: Callable[[sct.Event], str | None]
    #: Return the faults of a component.
    faults: Callable[[Parts], Sequence[str]]


class StatusReporter:
    """Publish the states of all components once in a number of ticks if there is a subscription; 0 disables it."""

    def __init__(self, graph: rosgraph.RosGraph, port: Port, data: NodeData, blocking: Blocking, own: Own) -> None:
        self._components = components(graph)
        self._port = port
        self._data = data
        self._blocking = blocking
        self._own = own
        self._every = 0
        self._passed = 0

    def report_every(self, milliseconds: int, period: int) -> None:
        """Set the interval in milliseconds, rounded down to whole periods, at least one; 0 disables reports."""
        self._every = max(1, milliseconds // period) if milliseconds else 0

    def publish(self) -> bool:
        """Count a tick; publish if a report is due and has subscribers. Return whether it was due."""
        if self._every == 0:
            return False
        due = self._passed == 0
        self._passed = (self._passed + 1) % self._every
        if due and self._port.status_listeners():
            self._port.publish_statuses([self._status(parts) for parts in self._components])
        return due

    def _status(self, parts: Parts) -> ComponentStatus:
        plant, faults = parts.plant, self._own.faults(parts)
        state, values = STATELESS, []
        if plant is not None:
            state = plant.locations[self._blocking.engine.location(plant)].name
            values = [("state", state)]
            values += [(variable.name, _text(self._blocking.engine.value(variable))) for variable in plant.variables]
        values += [(variable.name, _text(format_value(self._data.variables[variable]))) for variable in parts.stored]
        values += [(request(sending), self._verdict(sending.event)) for sending in parts.commands]
        violated = self._own.violated(parts.name)
        faults = [*(f"violated: {name}" for name in violated), *faults]
        level: Literal["OK", "WARN", "ERROR"] = "ERROR" if violated else "WARN" if faults else "OK"
        return ComponentStatus(parts.name, level, "; ".join([state, *faults]), values)

    def _verdict(self, event: sct.Event) -> str:
        if not self._blocking.engine.enabled(event_name(event)):
            return str(self._blocking.reason(event))
        obstacle = self._own.held_back(event)
        return "allowed" if obstacle is None else f"held back: {obstacle}"


def _text(value: Json) -> str:
    """Return the text of a value for people and plots."""
    if isinstance(value, str):
        return value.encode(errors="replace").decode()
    return str(value) if isinstance(value, float) and not isfinite(value) else json_text(value)
