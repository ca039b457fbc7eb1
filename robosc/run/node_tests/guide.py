"""States of the supervised system in which goals are visible, and shortest paths to them, by decision diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.analysis.system import GuardedSystem
from robosc.engine.state import Domain
from robosc.model import sct
from robosc.model.semantics.roles import SILENT, event_name, plant_of
from robosc.run.node_tests.coverage import causes

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.engine.state import Value
    from robosc.run.node_tests.coverage import Goal
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Encoding


class Way(NamedTuple):
    """Events of a path with their inputs, and the goals visible at its end; no events: there is no path."""

    events: list[tuple[str, dict[str, Value]]]
    goals: set[Goal]


class Guide:
    """Supervised system of a model. Any enabled event may happen, even if a control loop would wait.

    `data` are the possible inputs of each incoming event.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        goals: Iterable[Goal],
        data: Mapping[str, list[dict[str, Value]]],
    ) -> None:
        self._model = model
        self._encoding = encoding
        self._data = data
        self._system = GuardedSystem(model, encoding)
        states_by_goal = {goal: self._states(goal) & self._system.controlled for goal in goals}
        self._where = {goal: states for goal, states in states_by_goal.items() if states.satisfiable()}
        #: Sets of states that no event leaves, from searches without a path.
        self._closed: list[Diagram] = []

    @property
    def possible(self) -> set[Goal]:
        """The goals that some reachable state shows."""
        return set(self._where)

    def way(self, codes: Mapping[sct.Plant | sct.DiscreteVariable, int], goals: Iterable[Goal]) -> Way:
        """Return a shortest path from a state to another in which a wanted goal is visible.

        Goals that are visible in the present state, and were not seen, are not searched for.
        """
        here = dict.fromkeys((domain.element for domain in self._encoding.layout.state), 0) | dict(codes)
        known = {goal: self._where[goal] for goal in goals if goal in self._where}
        elsewhere = [states for states in known.values() if not self._system.is_in(here, states)]
        for closed in self._closed:
            if self._system.is_in(here, closed):
                elsewhere = [states for states in elsewhere if (states & closed).satisfiable()]
        if not elsewhere:
            return Way([], set())
        layers = self._system.layers_from(here)
        path = layers.path_to(self._encoding.diagrams.any_of(elsewhere))
        if path is None:
            self._closed.append(layers.seen)
            return Way([], set())
        events = [(step.event, dict(step.inputs)) for step in self._system.trace(path)]
        return Way(events, {goal for goal, states in known.items() if self._system.is_in(path.states[-1], states)})

    def _states(self, goal: Goal) -> Diagram:
        """Return the states that show a goal. Incoming and outgoing events wait until no silent event is enabled."""
        all_of, allowed = self._encoding.diagrams.all_of, self._system.allowed
        event = goal.of if isinstance(goal.of, sct.Event) else goal.of.event
        silent = event.kind in (*SILENT, sct.EventKind.data)
        at_rest = [] if silent else [~allowed[other] for other in allowed if other.kind == sct.EventKind.tau]
        if isinstance(goal.of, sct.Event) and goal.cause is not None:
            others = [self._encoding.holds(cause) for cause in causes(self._model, goal.of) if cause is not goal.cause]
            ready = self._system.relations[goal.of].enabled
            return all_of([*at_rest, ready, ~self._encoding.holds(goal.cause), *others])
        if isinstance(goal.of, sct.Event):
            waiting_states = all_of([*at_rest, *(~allowed[other] for other in earlier(event))])
            return waiting_states & (allowed[event] if goal.value else ~allowed[event])
        holds = self._encoding.holds(goal.of.guard)
        tried = [~self._encoding.holds(edge.guard) for edge in tried_before(goal.of)]
        some = self._with_some_data(event, all_of([holds if goal.value else ~holds, *tried]))
        return some & self._encoding.source(goal.of) & all_of([allowed[event], *at_rest])

    def _with_some_data(self, event: sct.Event, condition: Diagram) -> Diagram:
        """Return the states in which a condition holds with some possible data of the event."""
        if not event.inputs:
            return condition
        levels = [level for event_input in event.inputs for level in self._encoding.layout.domains[event_input].levels]
        if event.controllable:  # The data depend on the state of the node, which the plan does not have.
            return (condition & self._encoding.whole(event.inputs)).exists(self._encoding.diagrams.cube(levels))
        choices = self._encoding.diagrams.any_of(
            self._encoding.diagrams.all_of(
                self._encoding.has_code(event_input, _code(event_input, inputs[event_input.name]))
                for event_input in event.inputs
            )
            for inputs in self._data.get(event_name(event), ())
        )
        return (condition & choices).exists(self._encoding.diagrams.cube(levels))


def _code(event_input: sct.Input, value: Value) -> int:
    domain = Domain(event_input.type)
    return domain.internal(value) - domain.low


def tried_before(edge: sct.Edge) -> list[sct.Edge]:
    """Return the transitions that are tried before this one, with the same event from the same location."""
    alternatives = [other for other in edge.eContainer().edges if other.event is edge.event]
    return alternatives[: alternatives.index(edge)]


def earlier(event: sct.Event) -> list[sct.Event]:
    """Return the alternatives that are evaluated before an event that chooses data; empty for other events."""
    if event.kind != sct.EventKind.data:
        return []
    alternatives = [other for other in plant_of(event).events if other.kind == sct.EventKind.data]
    return alternatives[: alternatives.index(event)]
