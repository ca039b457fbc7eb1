"""The properties by their definition, one state at a time. Slow on purpose, and of the same mind as nobody else."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import product

from robosc.edges import edges_from
from robosc.metamodel import sct
from robosc.roles import event_name, plant_of
from robosc.synthesis import TraceStep
from robosc.synthesis.decoding import Value
from tests.synthesis.oracle import Oracle, State, values_of

_SILENT = (sct.EventKind.tau, sct.EventKind.reset)
_INPUTS = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.feedback, sct.EventKind.cancel)
Move = tuple[sct.Event, State]


@dataclass(frozen=True)
class Explicit:
    """A model under its supervisor. `faults` of a property are the states that refute it."""

    model: sct.SupervisoryControlModel

    @cached_property
    def oracle(self) -> Oracle:
        return Oracle(self.model)

    @cached_property
    def guards(self) -> dict[sct.Event, sct.EventGuard]:
        return {each.event: each for each in self.model.supervisor.guards}

    def guarded(self, event: sct.Event, state: State) -> bool:
        guard = self.guards.get(event)
        parts = (guard.requirement, guard.synthesis) if guard else ()
        return all(self.oracle.value(part, state, {}) for part in parts)

    def allowed(self, event: sct.Event, state: State) -> bool:
        return self.oracle.edges(event, state) is not None and self.guarded(event, state)

    @cached_property
    def _moves(self) -> dict[State, list[Move]]:
        return {}

    def moves(self, state: State) -> list[Move]:
        if state not in self._moves:
            self._moves[state] = [
                (event, after)
                for event in self.oracle.events
                if self.allowed(event, state)
                for after in self.oracle.successors(event, state)
            ]
        return self._moves[state]

    def silent(self, state: State) -> list[Move]:
        return [each for each in self.moves(state) if each[0].kind in _SILENT]

    def under_control(self, state: State) -> list[Move]:
        """What the control loop does next: first of all it settles."""
        free = (*_SILENT, sct.EventKind.data)
        return [each for each in self.moves(state) if each[0].kind in free or not self.silent(state)]

    def distances(self, moves: Callable[[State], list[Move]], start: State) -> dict[State, int]:
        """All states that the moves lead to, with the least number of them."""
        known, front = {start: 0}, [start]
        for state in front:
            for _, after in moves(state):
                if after not in known:
                    known[after] = known[state] + 1
                    front.append(after)
        return known

    @cached_property
    def states(self) -> dict[State, int]:
        return self.distances(self.moves, self.oracle.initial)

    def blocked(self, moves: Callable[[State], list[Move]], states: Iterable[State]) -> set[State]:
        alive = {state for state in states if self.oracle.is_marked(state)}
        left = [state for state in states if state not in alive]
        while more := {state for state in left if any(after in alive for _, after in moves(state))}:
            alive |= more
            left = [state for state in left if state not in alive]
        return set(left)

    def uncontrolled(self) -> set[State]:
        return {
            state
            for state in self.states
            for event in self.oracle.events
            if not event.controllable and self.oracle.edges(event, state) is not None
            if not (self.guarded(event, state) and self.oracle.required(event, state))
        }

    def deaf(self) -> set[State]:
        """Where a plant has no edge for what the one that declares it lets happen."""
        return {
            state
            for state in self.states
            for event in self.oracle.events
            if event.kind in _INPUTS and self._ready(event, plant_of(event), state)
            if self.oracle.edges(event, state) is None
        }

    def _ready(self, event: sct.Event, plant: sct.Plant, state: State) -> bool:
        location = state[self.oracle.places[plant]]
        return any(each.event is event and self.oracle.value(each.guard, state, {}) for each in edges_from(location))

    def broken(self, requirement: sct.Requirement) -> set[State]:
        wanted = requirement.kind == sct.RequirementKind.needs
        return {
            state
            for state in self.states
            if self.allowed(requirement.event, state) and self.oracle.value(requirement.condition, state, {}) != wanted
        }

    def dead(self) -> set[sct.Event]:
        live = (sct.EventKind.trigger, *_SILENT)
        happen = {event for state in self.states for event, _ in self.moves(state)}
        return {event for event in self.oracle.events if event.kind in live and event not in happen}

    def needless(self) -> set[State]:
        return {
            state
            for state in self.states
            if state in self.oracle.controlled
            for event in self.oracle.events
            if event.controllable and self.oracle.allows(event, state) and not self.guarded(event, state)
        }

    def restless(self) -> set[State]:
        """From where silent events can happen for ever: as often as there are states, and once more."""
        left = set(self.states)
        while True:
            kept = {state for state in left if any(after in left for _, after in self.silent(state))}
            if kept == left:
                return left
            left = kept

    def longest_run(self) -> int:
        """How many silent events can happen in a row, if they come to rest."""
        left, length = set(self.states), -1
        while left:
            left = {state for state in left if any(after in left for _, after in self.silent(state))}
            length += 1
        return length

    def ends(self, state: State) -> set[State]:
        return {each for each in self.distances(self.silent, state) if not self.silent(each)}

    def torn(self) -> set[State]:
        return {state for state in self.states if len(self.ends(state)) > 1}

    def after(self, trace: Iterable[TraceStep], state: State | None = None) -> State:
        """The state to which a trace leads: what it leaves open makes no difference."""
        state = self.oracle.initial if state is None else state
        events = {event_name(each): each for each in self.oracle.events}
        for step in trace:
            event = events[step.event]
            assert self.allowed(event, state), step
            found = {
                after
                for after, inputs in self._all_successors(event, state)
                if all(_shown(inputs[each]) == step.inputs[each.name] for each in inputs if each.name in step.inputs)
            }
            assert len(found) == 1, step
            state = found.pop()
        return state

    def _all_successors(self, event: sct.Event, state: State) -> Iterable[tuple[State, dict]]:
        for values in product(*(values_of(each.type) for each in event.inputs)):
            inputs = dict(zip(event.inputs, values, strict=True))
            yield self.oracle.successor(event, state, inputs), inputs


def _shown(value: object) -> Value:
    return getattr(value, "name", value)
