"""Tracker of a robot by the reports of its node on `~/state`: its events, and the states after them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.engine.timers import Timers
from robosc.model import sct
from robosc.model.semantics.edges import edges_by_event, origin
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.engine import Engine
    from robosc.engine.state import State, Value


class ReportError(ValueError):
    """Report that does not fit the model. The message gives the reason."""


@dataclass(frozen=True)
class ReportedMoment:
    """Event that has happened, None if only a state was reported; the state after it, and the transitions taken.

    `variables` are the reported values of that state, by `Component.variable`, also of those that the
    node keeps itself.
    """

    event: str | None
    state: State
    edges: tuple[sct.Edge, ...]
    variables: Mapping[str, Any]


#: Edge with the positions of its source and target locations; None: any source, or the target is the source.
_Move = tuple[sct.Edge, int | None, int | None]


class Tracker:
    """State of a robot, as far as the reports of its node determine it.

    A report has the events since the previous one, and the state of the components after all of them. The transitions
    in between are chosen to fit both. The data of the events, which reports lack, is not needed. Other automata
    (communications, requirements) follow the events; `timers` run from event to event. A tracker that starts late
    assumes their initial locations, until an event contradicts them.
    """

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self.timers = Timers(engine, 0)
        model = engine.model
        self._initial = engine.state
        self._began: float | None = None
        self._components = {
            plant.origin or plant.name: plant for plant in model.plants if plant.kind == sct.PlantKind.behaviour
        }
        self._moves = {
            event_name(event): {plant: [_move(edge) for edge in edges] for plant, edges in taking_part.items()}
            for event, taking_part in edges_by_event(model.plants).items()
        }

    def begin(self) -> None:
        """Reset to the initial state: the node has started."""
        self.engine.state = self._initial
        self.timers = Timers(self.engine, 0)
        self._began = None

    def report(self, report: Any) -> Iterator[ReportedMoment]:
        """Yield the events of a report; the engine is in the state after each. Raises ReportError."""
        if not isinstance(report, dict):
            raise ReportError("it is not an object")
        ends = self._ends(report)
        events = report.get("transitions")
        if not (isinstance(events, list) and all(isinstance(event, str) for event in events)):
            raise ReportError("`transitions` is not a list of events")
        unknown = next((event for event in events if event not in self.engine.events), None)
        if unknown is not None:
            raise ReportError(f"the model has no event `{unknown}`")
        time = report.get("time")
        if isinstance(time, bool) or not isinstance(time, (int, float)) or not abs(time) < 2**52:
            raise ReportError("`time` is not a number of seconds")
        variables = {
            f"{name}.{variable}": value
            for name in self._components
            for variable, value in report["components"][name]["variables"].items()
        }
        return self._followed(events, ends, variables, self._milliseconds(time))

    def _milliseconds(self, time: float) -> int:
        if self._began is None:
            self._began = time
        return round((time - self._began) * 1000)

    def _ends(self, report: Mapping[str, Any]) -> dict[sct.Plant | sct.DiscreteVariable, Value]:
        """Return the states and variables of the components in a report."""
        robot, components = report.get("robot"), report.get("components")
        if robot != self.engine.model.name:
            raise ReportError(f"the report is of the robot `{robot}`, the model is `{self.engine.model.name}`")
        ends: dict[sct.Plant | sct.DiscreteVariable, Value] = {}
        for name, plant in self._components.items():
            try:
                ends[plant] = components[name]["state"]  # type: ignore[index]
                ends |= {variable: components[name]["variables"][variable.name] for variable in plant.variables}  # type: ignore[index]
            except (KeyError, TypeError):
                raise ReportError(f"the report has no state of `{name}`") from None
        try:
            self.engine.state_with(ends)
        except ValueError as error:
            raise ReportError(f"the report has a state that the model does not have: {error}") from None
        return ends

    def _followed(
        self,
        events: Sequence[str],
        ends: Mapping[sct.Plant | sct.DiscreteVariable, Value],
        variables: Mapping[str, Any],
        now: int,
    ) -> Iterator[ReportedMoment]:
        self.timers.at(now)
        paths = self._paths(events, ends)
        for number, event in enumerate(events):
            self.timers.before(event)
            taken = paths[number]
            after: dict[sct.Plant | sct.DiscreteVariable, Value] = {
                plant: plant.locations[location].name for plant, (_, location) in taken.items()
            }
            is_last = number == len(events) - 1
            if is_last:
                after |= ends
            self.engine.state = self.engine.state_with(after)
            edges = tuple(edge for edge, _ in taken.values() if edge.source is not None)
            yield ReportedMoment(event, self.engine.state, edges, variables if is_last else {})
        if not events:
            self.engine.state = self.engine.state_with(ends)
            yield ReportedMoment(None, self.engine.state, (), variables)

    def _paths(
        self, events: Sequence[str], ends: Mapping[sct.Plant | sct.DiscreteVariable, Value]
    ) -> list[dict[sct.Plant, tuple[sct.Edge, int]]]:
        """Return the plants that take part in each event, each with its edge and the position of its next location."""
        taking_part: dict[sct.Plant, list[int]] = {}
        for number, event in enumerate(events):
            for plant in self._moves.get(event, ()):
                taking_part.setdefault(plant, []).append(number)
        paths: list[dict[sct.Plant, tuple[sct.Edge, int]]] = [{} for _ in events]
        for plant, numbers in taking_part.items():
            moves = [self._moves[events[number]][plant] for number in numbers]
            end = next(
                (place for place, location in enumerate(plant.locations) if location.name == ends.get(plant)), None
            )
            for number, step in zip(numbers, _path(moves, self.engine.location(plant), end), strict=True):
                paths[number][plant] = step
        return paths


def _move(edge: sct.Edge) -> _Move:
    left = origin(edge)
    locations = list((left or edge).eContainer().locations)
    return (
        edge,
        None if left is None else locations.index(left),
        None if edge.target is None else locations.index(edge.target),
    )


def _path(moves: Sequence[Sequence[_Move]], start: int, end: int | None) -> list[tuple[sct.Edge, int]]:
    """Return a path from a location to another with an edge of each of `moves`, each with the location after it.

    If no path leads on, it continues from a location in which the next event can happen: a report is missing.
    """
    reached: dict[int, tuple[int, sct.Edge] | None] = {start: None}
    steps: list[dict[int, tuple[int, sct.Edge]]] = []
    for possible in moves:
        after: dict[int, tuple[int, sct.Edge]] = {}
        for edge, left, target in possible:
            for before in reached if left is None else [left] if left in reached else ():
                after.setdefault(before if target is None else target, (before, edge))
        if not after:
            for edge, left, target in possible:
                before = start if left is None else left
                after.setdefault(before if target is None else target, (before, edge))
        steps.append(after)
        reached = dict.fromkeys(after)
    path = []
    location = end
    for step in reversed(steps):
        if location not in step:
            location = next(iter(step))
        before, edge = step[location]
        path.append((edge, location))
        location = before
    return path[::-1]
