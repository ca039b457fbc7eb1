"""Execution of single events of an engine model."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import TYPE_CHECKING

from robosc.engine.expressions import Compiler, Function, all_inside
from robosc.engine.state import Domain, State, StateLayout, Value
from robosc.m2m.sct_to_engine import transform
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.roles import Roles, event_name

if TYPE_CHECKING:
    from collections.abc import Mapping


class Blocked(StrEnum):
    """Cause that blocks an event. If there are several, the first of these."""

    PLANT = "plant"
    ASSUMPTION = "assumption"
    REQUIREMENT = "requirement"
    SYNTHESIS = "synthesis"


#: Writes values after an event to the last list, given the cells and inputs before it.
_Step = Callable[[Sequence[int], Sequence[int], list[int]], None]


class Engine:
    """A model with its current state. An engine starts in the initial state.

    Event names include their plant (`message_move.c_trigger`). An event happens only if its guard is true: each of its
    plants has an enabled edge for it in its location, and the supervisor allows it. All changes are simultaneous and
    use the values before the event. Raises ValueError if the model has no supervisor, or one without a guard for a
    controllable event. Raises KeyError for an unknown event or input.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.model = model
        self.executed = transform(model)
        self.roles = Roles(model)
        self.events: tuple[str, ...] = tuple(event_name(event) for event in self.roles.events)
        self._layout = StateLayout(self.executed)
        self._input_domains = [Domain(declared.type) for declared in self.executed.inputs]
        self._inputs = [declared.initial for declared in self.executed.inputs]
        self._compile = Compiler(self.executed)
        positions = {declared: position for position, declared in enumerate(self.executed.inputs)}
        self._positions = {declared.input: position for declared, position in positions.items()}
        self._carried = {
            event.name: {declared.input.name: positions[declared] for declared in event.inputs}
            for event in self.executed.events
        }
        self._guards = {
            event.name: self._compile(*(term.condition for term in event.guard.terms)) for event in self.executed.events
        }
        self._data_guards = {
            event.name: self._compile(event.guard.data)
            for event in self.executed.events
            if event.guard.data is not None
        }
        self._effects = {event.name: self._steps(event.effect.steps) for event in self.executed.events}
        self._reasons: dict[str, list[tuple[Blocked, Function]]] = {}
        self._failing: dict[str, list[tuple[sct.Requirement, Callable[[], bool]]]] = {}
        self._by_name = {event.name: event for event in self.executed.events}
        self._cells = tuple(variable.initial for variable in self.executed.variables)

    @property
    def state(self) -> State:
        """Current state: an immutable, hashable mapping from names to values. Assign a state to change it."""
        return State(self._layout, self._cells)

    @state.setter
    def state(self, state: State) -> None:
        if state.layout is not self._layout:
            raise ValueError("the state is another engine's")
        self._cells = state.cells

    @property
    def saved(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Cells of the state and values of the inputs. `restore` accepts them, also in another engine of the model."""
        return self._cells, tuple(self._inputs)

    def restore(self, saved: tuple[tuple[int, ...], tuple[int, ...]]) -> None:
        """Restore the state from `saved` of an engine of this model."""
        self._cells, self._inputs[:] = saved

    @property
    def codes(self) -> dict[sct.Plant | sct.DiscreteVariable, int]:
        """State in the codes of decision diagrams: positions of locations and literals, differences from minima."""
        cells = zip(self._layout.elements, self._layout.domains, self._cells, strict=True)
        return {element: value - domain.low for (_, element), domain, value in cells}

    def state_with(self, values: Mapping[sct.Plant | sct.DiscreteVariable, Value]) -> State:
        """Return the current state with other locations of some plants and other values of some variables.

        Raises ValueError for a location or value that does not exist.
        """
        cells = list(self._cells)
        for element, value in values.items():
            if element in self._layout.cells:
                cell = self._layout.cells[element]
                cells[cell] = self._layout.domains[cell].internal(value)
            elif isinstance(element, sct.Plant) and value != element.locations[0].name:
                raise ValueError(f"{value!r} is not {element.locations[0].name}")
        return State(self._layout, tuple(cells))

    def reads(self, event: str) -> frozenset[sct.Plant | sct.DiscreteVariable]:
        """Return the parts of the state that determine whether the event is enabled, and the reasons that block it."""
        executed = self._by_name[event]
        conditions = [term.condition for term in executed.guard.terms]
        guard = executed.guard
        parts = [guard.plants, guard.assumption, guard.requirement, guard.synthesis]
        parts += [reason.condition for reason in executed.reasons]
        conditions += [part for part in parts if part is not None]
        variables = {part.variable for part in all_inside(conditions) if isinstance(part, engine.VariableReference)}
        return frozenset(variable.variable or variable.plant for variable in variables)

    def blocked_by(self, event: str) -> Blocked | None:
        """Return the cause that blocks the event in this state, whatever its inputs. None if it is enabled."""
        if self.enabled(event):
            return None
        if event not in self._reasons:
            guard = self._by_name[event].guard
            parts = (guard.plants, guard.assumption, guard.requirement, guard.synthesis)
            conditions = zip(Blocked, parts, strict=True)
            self._reasons[event] = [(reason, self._compile(part)) for reason, part in conditions if part is not None]
        return next(reason for reason, holds in self._reasons[event] if not holds(self._cells, ()))

    def inputs_blocked_by(self, event: str) -> Blocked | None:
        """Return the cause that blocks an enabled event because of its present inputs. None if they are allowed.

        The event is a command, or a goal of a client, which the plants reject.
        """
        if self.permits_inputs(event):
            return None
        if self._by_name[event].role is engine.Role.incoming:
            return Blocked.PLANT
        reasons = self._by_name[event].reasons
        plants = (reason.condition for reason in reasons if reason.kind == engine.Origin.plants)
        if any(condition is not None and self.condition(condition)() for condition in plants):
            return Blocked.PLANT
        return Blocked.REQUIREMENT if self.failing_requirements(event) else Blocked.SYNTHESIS

    def failing_requirements(self, event: str) -> list[sct.Requirement]:
        """Return the requirements on the event that forbid it in this state, independent of other causes."""
        if event not in self._failing:
            self._failing[event] = [
                (reason.requirement, self.condition(reason.condition))
                for reason in self._by_name[event].reasons
                if reason.requirement is not None and reason.condition is not None
            ]
        return [requirement for requirement, forbids in self._failing[event] if forbids()]

    def violated_assumptions(self, event: str) -> list[sct.Plant]:
        """Return the assumptions that an event of the robot would violate in this state; none if it is not possible."""
        if self.blocked_by(event) is not Blocked.ASSUMPTION:
            return []
        return [
            reason.assumption
            for reason in self._by_name[event].reasons
            if reason.assumption is not None and reason.condition is not None and self.condition(reason.condition)()
        ]

    def enabled(self, event: str, state: State | None = None) -> bool:
        """Return whether the event is enabled in this state, or in another state of this engine.

        A command with inputs is enabled if some inputs are allowed.
        """
        cells = self._cells if state is None else state.cells
        return bool(self._guards[event](cells, ()))

    def permits_inputs(self, event: str, state: State | None = None) -> bool:
        """Return whether an event that is enabled in this or another state is allowed there with its present inputs."""
        guard = self._data_guards.get(event)
        return guard is None or bool(guard(self._cells if state is None else state.cells, self._inputs))

    def set_inputs(self, event: str, data: Mapping[str, Value]) -> None:
        """Set inputs of the event (`i_response`) for this and later events. Integers saturate at their range.

        Raises ValueError for a value of another type.
        """
        for name, value in data.items():
            position = self._carried[event][name]
            self._inputs[position] = self._input_domains[position].internal(value)

    def perform(self, event: str, data: Mapping[str, Value] | None = None) -> bool:
        """Perform the event with this data if it is enabled and allowed. Return whether it happened."""
        if data:
            self.set_inputs(event, data)
        if not (self.enabled(event) and self.permits_inputs(event)):
            return False
        self.force(event)
        return True

    def force(self, event: str) -> None:
        """Perform an event regardless of requirements, synthesis and assumptions.

        Precondition: the plants have an edge for it, so that `blocked_by` and `inputs_blocked_by` are not `PLANT`.
        """
        after = list(self._cells)
        for step in self._effects[event]:
            step(self._cells, self._inputs, after)
        self._cells = tuple(after)

    def location(self, plant: sct.Plant) -> int:
        """Return the position of the plant's location."""
        cell = self._layout.cells.get(plant)
        return 0 if cell is None else self._cells[cell]

    def value(self, variable: sct.DiscreteVariable) -> Value:
        """Return the value of a variable in its external form."""
        cell = self._layout.cells[variable]
        return self._layout.domains[cell].external(self._cells[cell])

    def cell(self, variable: engine.StateVariable) -> int:
        """Return the value of a state variable. The value of a location is its position."""
        return self._cells[self._layout.position[variable.name]]

    def condition(self, condition: ex.Expression) -> Callable[[], bool]:
        """Return a function that evaluates a condition of the engine model in the current state, with the inputs."""
        function = self._compile(condition)
        return lambda: bool(function(self._cells, self._inputs))

    def _steps(self, steps: Sequence[engine.Step]) -> list[_Step]:
        return [self._assignment(step) if isinstance(step, engine.Assignment) else self._switch(step) for step in steps]

    def _assignment(self, assignment: engine.Step) -> _Step:
        assert isinstance(assignment, engine.Assignment)
        cell, value = self._layout.position[assignment.variable.name], self._compile(assignment.value)

        def assign(cells: Sequence[int], inputs: Sequence[int], after: list[int]) -> None:
            after[cell] = value(cells, inputs)

        return assign

    def _switch(self, switch: engine.Step) -> _Step:
        assert isinstance(switch, engine.Switch)
        cases = [
            (None if case.condition is None else self._compile(case.condition), self._steps(case.assignments))
            for case in switch.cases
        ]

        def choose(cells: Sequence[int], inputs: Sequence[int], after: list[int]) -> None:
            for condition, assignments in cases:
                if condition is None or condition(cells, inputs):
                    for assign in assignments:
                        assign(cells, inputs, after)
                    return

        return choose

    def read(self, reference: ex.Expression) -> object:
        """Return the value of a reference of the sct model in this state, with the latest inputs."""
        match reference:
            case sct.LocationReference(location=location):
                plant: sct.Plant = location.eContainer()
                return plant.locations[self.location(plant)] is location
            case sct.VariableReference(variable=variable):
                return _object(variable.type, self._cells[self._layout.cells[variable]])
            case sct.InputReference(input=input_element):
                return _object(input_element.type, self._inputs[self._positions[input_element]])
        assert isinstance(reference, ex.EnumerationLiteralReference)
        return reference.literal


def _object(kind: ex.Type, value: int) -> object:
    """Return the value of a cell in the form of the sct model's expressions."""
    if isinstance(kind, ex.EnumerationType):
        return kind.enumeration.literals[value]
    return bool(value) if isinstance(kind, ex.BooleanType) else value
