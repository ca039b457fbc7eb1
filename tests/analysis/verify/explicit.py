"""The properties by their definition, one state at a time. Deliberately slow and independent of the tool."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product

from robosc.analysis.paths import TraceStep
from robosc.model import sct
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.roles import Roles, event_name, plant_of
from robosc.synthesis.decoding import Value
from tests.synthesis.oracle import Oracle, State, values_of

_SILENT = (sct.EventKind.tau, sct.EventKind.reset)
_INPUTS = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.feedback, sct.EventKind.cancel)
Move = tuple[sct.Event, State]
#: A state; within a batch also the batch's number and the number of its handled events.
Configuration = tuple[State, tuple[int, int] | None]


@dataclass(frozen=True)
class Explicit:
    """A model under its supervisor. `faults` of a property are the states that refute it."""

    model: sct.SupervisoryControlModel

    @cached_property
    def oracle(self) -> Oracle:
        return Oracle(self.model)

    @cached_property
    def guards(self) -> dict[sct.Event, sct.EventGuard]:
        return {guard.event: guard for guard in self.model.supervisor.guards}

    def guarded(self, event: sct.Event, state: State) -> bool:
        guard = self.guards.get(event)
        parts = (guard.requirement, guard.synthesis) if guard else ()
        return all(self.oracle.value(part, state, {}) for part in parts)

    def allowed(self, event: sct.Event, state: State) -> bool:
        return self.oracle.enabled(event, state) and self.guarded(event, state)

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
        return [move for move in self.moves(state) if move[0].kind in _SILENT]

    # The control loop, in configurations: a state, and a position in a batch

    @cached_property
    def batches(self) -> list[list[sct.Event]]:
        """The groups of events that happen without interruption: the events of a topic, the cancels."""
        sources: dict[object, list[sct.Event]] = {}
        for event in self.oracle.events:
            plant = plant_of(event)
            if not event.controllable and plant.kind == sct.PlantKind.message:
                sources.setdefault(plant.topic.removeprefix("/") if plant.topic else plant, []).append(event)
        return [*sources.values(), [event for event in self.oracle.events if event.kind == sct.EventKind.cancel]]

    def failed(self, event: sct.Event, state: State) -> bool:
        """Return whether the event is a reset after an error."""
        edges = [edge for location in plant_of(event).locations for edge in location.edges]
        failed = {edge.target for edge in edges if edge.event.kind == sct.EventKind.error}
        return event.kind == sct.EventKind.reset and state[self.oracle.places[plant_of(event)]] in failed

    def rests(self, state: State) -> bool:
        return all(self.failed(event, state) for event, _ in self.silent(state))

    @cached_property
    def overruns(self) -> bool:
        """Whether silent events can happen more often than the loop permits."""
        return bool(self.divergent()) or self.longest_run() > Roles(self.model).settling_bound

    def loop_moves(self, here: Configuration) -> list[tuple[sct.Event | None, Configuration]]:
        """Return the next moves; a batch can end, without an event, at any position."""
        state, place = here
        if place is not None:
            batch, done = place
            onwards = self.batches[batch][done:]
            later: list[tuple[sct.Event | None, Configuration]] = [
                (event, (after, (batch, done + number + 1)))
                for number, wanted in enumerate(onwards)
                for event, after in self.moves(state)
                if event is wanted
            ]
            return [*later, (None, (state, None))]
        found: list[tuple[sct.Event | None, Configuration]] = []
        for event, after in self.moves(state):
            if event.kind in (*_SILENT, sct.EventKind.data):
                found.append((event, (after, None)))
            elif self.rests(state) or self.overruns:
                batch = next(
                    ((number, batch.index(event) + 1) for number, batch in enumerate(self.batches) if event in batch),
                    None,
                )
                found.append((event, (after, batch)))
        return found

    @cached_property
    def loop_states(self) -> set[State]:
        start: Configuration = (self.oracle.initial, None)
        known, front = {start}, [start]
        for configuration in front:
            for _, after in self.loop_moves(configuration):
                if after not in known:
                    known.add(after)
                    front.append(after)
        return {state for state, place in known if place is None}

    def loop_blocked(self) -> set[State]:
        """Return the loop's states that reach no marked state at rest; the loop waits only at rest."""
        alive: set[Configuration] = {
            (state, None) for state in self.loop_states if self.oracle.is_marked(state) and self.rests(state)
        }
        places = [
            None,
            *((batch, done) for batch, events in enumerate(self.batches) for done in range(1, len(events) + 1)),
        ]
        left = {(state, place) for state in self.states for place in places} - alive

        def leads(here: Configuration) -> bool:
            waits = here[1] is not None or self.rests(here[0])
            return any(
                after in alive and (waits or event is None or event.kind in (*_SILENT, sct.EventKind.data))
                for event, after in self.loop_moves(here)
            )

        while more := {configuration for configuration in left if leads(configuration)}:
            alive |= more
            left -= more
        return {state for state in self.loop_states if (state, None) not in alive}

    def is_run_of_the_loop(self, trace: Iterable[TraceStep]) -> bool:
        """Return whether the control loop permits these events."""
        events = {event_name(event): event for event in self.oracle.events}
        here: set[Configuration] = {(self.oracle.initial, None)}
        for number, step in enumerate(trace := list(trace)):
            after = self.after(trace[: number + 1])
            here |= {(state, None) for state, _ in here}
            here = {
                following
                for state in here
                for event, following in self.loop_moves(state)
                if event is events[step.event] and following[0] == after
            }
        return bool(here)

    def torn(self) -> set[State]:
        """Return the loop's states that have several ends, for any set of withheld resets after errors."""
        resets = [event for event in self.oracle.events if event.kind == sct.EventKind.reset]
        found = set()
        for size in range(len(resets) + 1):
            for held in combinations(resets, size):
                found |= {state for state in self.loop_states if len(self.ends(state, held)) > 1}
        return found

    def ends(self, state: State, held: Iterable[sct.Event] = ()) -> set[State]:
        def silent(here: State) -> list[Move]:
            return [silent for silent in self.silent(here) if not (silent[0] in held and self.failed(silent[0], here))]

        return {distance for distance in self.distances(silent, state) if not silent(distance)}

    def distances(self, moves: Callable[[State], list[Move]], start: State) -> dict[State, int]:
        """Return all states that the moves reach, with the minimum number of moves."""
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
            if not event.controllable and self.oracle.enabled(event, state)
            if not (self.guarded(event, state) and self.oracle.required(event, state))
        }

    def deaf(self) -> set[State]:
        """Return the states in which a plant has no edge for an event that its declaring plant permits."""
        return {
            state
            for state in self.states
            for event in self.oracle.events
            if event.kind in _INPUTS and self._ready(event, plant_of(event), state)
            if not self.oracle.enabled(event, state)
        }

    def _ready(self, event: sct.Event, plant: sct.Plant, state: State) -> bool:
        location = state[self.oracle.places[plant]]
        return any(
            self.oracle.value(edge.guard, state, inputs)
            for edge in edges_from(location, event)
            for inputs in self.oracle.inputs(event)
        )

    def broken(self, requirement: sct.Requirement) -> set[State]:
        wanted = requirement.kind == sct.RequirementKind.needs
        return {
            state
            for state in self.states
            if self.allowed(requirement.event, state) and self.oracle.value(requirement.condition, state, {}) != wanted
        }

    def uncanceled(self) -> set[State] | None:
        """Return the states in which a running action is not canceled although a requirement of its start is violated.

        Return None if this concerns no action.
        """
        needed: dict[sct.Event, list[sct.Requirement]] = {}
        for cancel in self.oracle.events:
            starts = [event for event in plant_of(cancel).events if event.kind == sct.EventKind.trigger]
            stated = [
                requirement
                for requirement in self.model.requirements
                if requirement.event in starts and requirement.automaton is None
            ]
            if cancel.kind == sct.EventKind.cancel and stated:
                needed[cancel] = stated

        def runs(cancel: sct.Event, state: State) -> bool:
            place = state[self.oracle.places[plant_of(cancel)]]
            return any(edge.event is cancel and self.oracle.value(edge.guard, state, {}) for edge in edges_from(place))

        def holds(requirement: sct.Requirement, state: State) -> bool:
            wanted = requirement.kind == sct.RequirementKind.needs
            return self.oracle.value(requirement.condition, state, {}) == wanted

        return (
            {
                state
                for state in self.states
                for cancel, stated in needed.items()
                if runs(cancel, state)
                and not all(holds(requirement, state) for requirement in stated)
                and not self.allowed(cancel, state)
            }
            if needed
            else None
        )

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

    def divergent(self) -> set[State]:
        """Return the states from which silent events can happen forever: more often than there are states."""
        left = set(self.states)
        while True:
            kept = {state for state in left if any(after in left for _, after in self.silent(state))}
            if kept == left:
                return left
            left = kept

    def longest_run(self) -> int:
        """Return the maximum number of silent events in a row, if they come to rest."""
        left, length = set(self.states), -1
        while left:
            left = {state for state in left if any(after in left for _, after in self.silent(state))}
            length += 1
        return length

    def after(self, trace: Iterable[TraceStep], state: State | None = None) -> State:
        """Return the state after a trace, which must be the same for all values of unnamed inputs."""
        state = self.oracle.initial if state is None else state
        events = {event_name(event): event for event in self.oracle.events}
        for step in trace:
            event = events[step.event]
            assert self.allowed(event, state), step
            found = {
                after
                for after, inputs in self._all_successors(event, state)
                if all(
                    _shown(inputs[parameter]) == step.inputs[parameter.name]
                    for parameter in inputs
                    if parameter.name in step.inputs
                )
            }
            assert len(found) == 1, step
            state = found.pop()
        return state

    def _all_successors(self, event: sct.Event, state: State) -> Iterable[tuple[State, dict]]:
        for values in product(*(values_of(parameter.type) for parameter in event.inputs)):
            inputs = dict(zip(event.inputs, values, strict=True))
            yield self.oracle.successor(event, state, inputs), inputs


def _shown(value: object) -> Value:
    return getattr(value, "name", value)
