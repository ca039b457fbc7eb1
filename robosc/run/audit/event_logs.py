"""Audit of a node's event log: its lines are the events and commands of the model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.base.files.json_reading import JsonError, json_value
from robosc.base.files.reading import MOST_BYTES, open_file
from robosc.engine import Blocked
from robosc.model import sct
from robosc.model.semantics.roles import assumption_text, event_name, plant_of
from robosc.run.audit.findings import SECOND, Audit, Finding, Kind
from robosc.run.runtime.core.blocking import Blocking
from robosc.run.simulation import DataError, Simulation

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from robosc.base.ros_types import RosTypes
    from robosc.engine.state import Value
    from robosc.engine.timers import Timers
    from robosc.model import rosgraph
    from robosc.run.audit.judge import Watch
    from robosc.run.runtime.core.json_text import Json

#: Directions of events of the robot, of commands, and of the model itself.
_IN, _OUT, _INTERNAL, _BLOCKED = ("in", "violated"), ("out", "outside"), "internal", "blocked"
#: Maximum length of a line in bytes.
_LONGEST = 1 << 20


class LogError(Exception):
    """An event log that cannot be judged. `line` is the number of the line at fault."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(message)
        self.line = line


class LogJudge:
    """Audit of an event log. The data of events is that of the log: other fields have the defaults of ROS.

    The log has the silent events and the timeouts of its node: they happen as it says.
    """

    def __init__(  # noqa: PLR0913, PLR0917  # the parts of a robot, and the options
        self,
        model: sct.SupervisoryControlModel,
        graph: rosgraph.RosGraph | None,
        types: RosTypes | None,
        path: str,
        state: Mapping[sct.Plant | sct.DiscreteVariable, Value] | None = None,
        watch: Watch | None = None,
        safe: Collection[str] = (),
    ) -> None:
        """`safe`: the commands that the node sends in spite of requirements."""
        self._safe = safe
        self._simulation = Simulation(model, graph, types)
        self.engine = self._simulation.engine
        self.engine.state = self.engine.state_with(state or {})
        #: The log has the timeouts: no timer runs.
        self.timers: Timers | None = None
        self.audit = Audit(model.name)
        self.path = path
        self._watch = watch
        self._blocking = Blocking(self.engine)
        self._events = {event_name(event): event for plant in model.plants for event in plant.events}
        self._components = [plant for plant in model.plants if plant.kind == sct.PlantKind.behaviour]

    def run(self) -> Audit:
        """Judge the whole log. Raises LogError, and OSError."""
        for number, entry in self._entries():
            self._judge(number, entry)
        return self.audit

    def _entries(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the objects of the lines, with their numbers. An incomplete last line is left out."""
        size = 0
        with open_file(self.path) as file:
            for number, line in enumerate(iter(lambda: file.readline(_LONGEST + 1), b""), 1):
                size += len(line)
                if len(line) > _LONGEST or size > 8 * MOST_BYTES:
                    raise LogError(number, "the line is too long" if len(line) > _LONGEST else "the log is too long")
                if not line.endswith(b"\n"):
                    self.audit.notes.append(f"line {number} is incomplete")
                    return
                try:
                    entry = json_value(line.decode(errors="replace"))
                except JsonError as error:
                    raise LogError(number, str(error)) from None
                yield number, entry

    def _judge(self, number: int, entry: Any) -> None:
        match entry:
            case {"time": int() | float() as seconds, "direction": str(direction), "event": str(event)}:
                data = entry.get("data", {})
            case _:
                raise LogError(number, "it is no event with `time`, `direction` and `event`")
        if not isinstance(data, dict) or not abs(seconds) < 2**53:
            raise LogError(number, "its `data` is no object, or its `time` no time in seconds")
        audit, time = self.audit, round(seconds * SECOND)
        audit.start = time if audit.start is None else audit.start
        audit.end = time
        if event not in self._events:
            finding = Finding(Kind.UNEXPECTED, event, event, "", "unknown", ["the model has no such event"], {})
            self._note(finding, time)
            return
        try:
            if direction == "outside" and event in self._safe:
                audit.safe += 1
            elif direction in _OUT:
                self._command(event, data, time)
            elif direction in _IN:
                self._event(event, data, time)
            elif direction == _INTERNAL:
                self._happen(event, data)
            elif direction != _BLOCKED:
                raise LogError(number, f"`{direction}` is no direction of an event")
        except (DataError, ValueError) as error:
            self._find(Kind.UNEXPECTED, event, "data", [str(error)], time)

    def _command(self, event: str, data: Mapping[str, Any], time: int) -> None:
        self.audit.commands += 1
        is_known = "value" in data or not self._events[event].inputs
        if is_known:
            self.engine.set_inputs(event, self._simulation.data.inputs(event, data))
        if self.engine.enabled(event) and (not is_known or self.engine.permits_inputs(event)):
            self.audit.clear(event)
        else:
            reason = self._blocking.reason(self._events[event])
            self._find(Kind.FORBIDDEN, event, reason.kind, reason.because, time)
        self._happen(event, data, with_data=is_known)

    def _event(self, event: str, data: Mapping[str, Any], time: int) -> None:
        self.audit.events += 1
        by = self.engine.blocked_by(event)
        if by is Blocked.PLANT:
            plant = plant_of(self._events[event])
            state = plant.locations[self.engine.location(plant)].name
            self._find(Kind.UNEXPECTED, event, "state", [f"{plant.origin or plant.name}.{state}"], time)
            return
        if by is Blocked.ASSUMPTION:
            violated = list(map(assumption_text, self.engine.violated_assumptions(event)))
            self._find(Kind.ASSUMPTION, event, "assumption", violated, time)
        else:
            self.audit.clear(event)
        self._happen(event, data)

    def _happen(self, event: str, data: Mapping[str, Any], *, with_data: bool = True) -> None:
        """Perform an event if the plants have a transition for it."""
        engine, known = self.engine, self._simulation.data
        inputs = known.inputs(event, data) if with_data else {}
        engine.set_inputs(event, inputs)
        if engine.blocked_by(event) is Blocked.PLANT:
            return
        if with_data and engine.inputs_blocked_by(event) is Blocked.PLANT:
            return
        known.before(event, data, inputs)
        engine.force(event)
        if self._watch is not None:
            self._watch(event, None)

    def _find(self, kind: Kind, event: str, reason: str, because: Sequence[str], time: int) -> None:
        plant = plant_of(self._events[event])
        self._note(
            Finding(kind, event, plant.origin or plant.name, "", reason, because, self._state()),
            time,
        )

    def _note(self, finding: Finding, time: int) -> None:
        finding = self.audit.add(finding, time)
        if self._watch is not None:
            self._watch(finding.event, finding)

    def _state(self) -> dict[str, Json]:
        return {
            plant.origin or plant.name: {
                "state": plant.locations[self.engine.location(plant)].name,
                "variables": {variable.name: self.engine.value(variable) for variable in plant.variables},
            }
            for plant in self._components
        }
