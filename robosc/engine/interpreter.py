"""Executes single events of an sct model under its supervisor."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from robosc.engine.expressions import Compiler, Function
from robosc.engine.state import Domain, Layout, State, Value
from robosc.metamodel import sct
from robosc.semantics.roles import Roles, event_name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.metamodel import expression as ex


class Blocked(StrEnum):
    """What keeps an event from happening; of several reasons the first of these."""

    PLANT = "plant"
    REQUIREMENT = "requirement"
    SYNTHESIS = "synthesis"


@dataclass(frozen=True)
class _Update:
    cell: int
    value: Function
    domain: Domain


@dataclass(frozen=True)
class _Edge:
    guard: Function | None
    updates: tuple[_Update, ...]
    target: int


@dataclass(frozen=True)
class _Participation:
    """How one plant takes part in an event: an edge or nothing for each location; `cell` holds the location.

    One edge alone is that of every location.
    """

    cell: int | None
    edges: tuple[_Edge | None, ...]

    def edge(self, cells: tuple[int, ...]) -> _Edge | None:
        return self.edges[0 if self.cell is None or len(self.edges) == 1 else cells[self.cell]]


@dataclass(frozen=True)
class _Event:
    plants: tuple[_Participation, ...]
    requirement: Function | None
    synthesis: Function | None
    inputs: Mapping[str, tuple[int, Domain]]


class Engine:
    """A model in some state, at first its initial one.

    Events are named with their plant (`message_move.c_trigger`). An event happens where every plant that has it on an
    edge has one from its location with a true guard, and the supervisor's guard holds; all updates are made at once,
    from the values before, and saturate. Raises ValueError where the model has no supervisor or one without a guard
    for a controllable event; a KeyError means that there is no event or input of that name.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        if model.supervisor is None:
            raise ValueError(f"{model.name} has no supervisor: synthesize it first")
        self.model = model
        self.roles = Roles(model)
        self.events: tuple[str, ...] = tuple(event_name(each) for each in self.roles.events)
        self._layout = Layout(model)
        declared = [each for plant in model.plants for each in plant.inputs]
        self._input_domains = [Domain(each.type) for each in declared]
        self._inputs = [each.clamp(0) for each in self._input_domains]
        self._input_position = {each: position for position, each in enumerate(declared)}
        self._compile = Compiler(self._layout.cells, self._input_position)
        self._events = self._compiled()
        self._cells = self._initial()

    @property
    def state(self) -> State:
        """The current state: a mapping from names to values, unchangeable, hashable. Assign one to go there."""
        return State(self._layout, self._cells)

    @state.setter
    def state(self, state: State) -> None:
        if state.layout is not self._layout:
            raise ValueError("the state is another engine's")
        self._cells = state.cells

    def blocked_by(self, event: str) -> Blocked | None:
        """What keeps the event from happening in this state; None where it is enabled."""
        compiled, cells = self._events[event], self._cells
        for plant in compiled.plants:
            edge = plant.edge(cells)
            if edge is None or not (edge.guard is None or edge.guard(cells, ())):
                return Blocked.PLANT
        if not (compiled.requirement is None or compiled.requirement(cells, ())):
            return Blocked.REQUIREMENT
        if not (compiled.synthesis is None or compiled.synthesis(cells, ())):
            return Blocked.SYNTHESIS
        return None

    def failing(self, event: str) -> list[sct.Requirement]:
        """The requirements on the event that forbid it in this state, whatever else does."""
        return [
            each
            for each in self.model.requirements
            if event_name(each.event) == event
            and bool(self._compile(each.condition)(self._cells, ())) == (each.kind == sct.RequirementKind.disables)
        ]

    def enabled(self, event: str) -> bool:
        """Whether the event can happen in this state."""
        return self.blocked_by(event) is None

    def set_inputs(self, event: str, data: Mapping[str, Value]) -> None:
        """Sets inputs of the event (`i_response`) for this and later events; integers saturate at their range.

        Raises ValueError where a value is of another type.
        """
        for name, value in data.items():
            position, domain = self._events[event].inputs[name]
            self._inputs[position] = domain.internal(value)

    def perform(self, event: str, data: Mapping[str, Value] | None = None) -> bool:
        """Lets the event happen with this data if it is enabled, and nothing else; says whether it did."""
        if data:
            self.set_inputs(event, data)
        if not self.enabled(event):
            return False
        before, after = self._cells, list(self._cells)
        for plant in self._events[event].plants:
            edge = plant.edge(before)
            assert edge is not None
            for update in edge.updates:
                after[update.cell] = update.domain.clamp(update.value(before, self._inputs))
            if plant.cell is not None:
                after[plant.cell] = edge.target
        self._cells = tuple(after)
        return True

    def location(self, plant: sct.Plant) -> int:
        """The position of the location that the plant is in."""
        cell = self._layout.cells.get(plant)
        return 0 if cell is None else self._cells[cell]

    def value(self, variable: sct.DiscreteVariable) -> Value:
        """The value of a variable, as a reader of the state sees it."""
        cell = self._layout.cells[variable]
        return self._layout.domains[cell].shown(self._cells[cell])

    def _initial(self) -> tuple[int, ...]:
        cells = [0] * len(self._layout.domains)
        for cell, position in self._layout.cells.items():
            if isinstance(cell, sct.Plant):
                cells[position] = next(number for number, each in enumerate(cell.locations) if each.initial)
            else:
                cells[position] = int(self._compile(cell.initial)((), ()))
        return tuple(cells)

    def _compiled(self) -> dict[str, _Event]:
        assert self.model.supervisor is not None
        guards = {guard.event: guard for guard in self.model.supervisor.guards}
        participations: dict[sct.Event, list[_Participation]] = {event: [] for event in self.roles.events}
        for plant in self.model.plants:
            for event, participation in self._participations(plant).items():
                participations[event].append(participation)
        compiled = {}
        for event in self.roles.events:
            guard = guards.get(event)
            if event.controllable and guard is None:
                raise ValueError(f"the supervisor has no guard for {event_name(event)}")
            compiled[event_name(event)] = _Event(
                tuple(participations[event]),
                self._function(None if guard is None else guard.requirement),
                self._function(None if guard is None else guard.synthesis),
                {
                    each.name: (self._input_position[each], self._input_domains[self._input_position[each]])
                    for each in event.inputs
                },
            )
        return compiled

    def _participations(self, plant: sct.Plant) -> dict[sct.Event, _Participation]:
        numbers = {location: number for number, location in enumerate(plant.locations)}
        edges: dict[sct.Event, list[_Edge | None]] = {}
        for location, number in numbers.items():
            for edge in location.edges:
                edges.setdefault(edge.event, [None] * len(numbers))[number] = self._edge(edge, numbers)
        cell = self._layout.cells.get(plant)
        taken = {event: _Participation(cell, tuple(by_location)) for event, by_location in edges.items()}
        return taken | {edge.event: _Participation(cell, (self._edge(edge, numbers),)) for edge in plant.edges}

    def _edge(self, edge: sct.Edge, numbers: Mapping[sct.Location, int]) -> _Edge:
        return _Edge(self._function(edge.guard), tuple(map(self._update, edge.updates)), numbers[edge.target])

    def _update(self, update: sct.Update) -> _Update:
        cell = self._layout.cells[update.variable]
        return _Update(cell, self._compile(update.value), self._layout.domains[cell])

    def _function(self, expression: ex.Expression | None) -> Function | None:
        return None if expression is None else self._compile(expression)
