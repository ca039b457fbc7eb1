"""Translates orders, counts and automata to requirement automata, and to requirements on their locations.

A requirement automaton observes its events and blocks none: each location has an edge for each event. Requirements that
read its location forbid events.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model import expression as ex
from robosc.model import robosc, sct
from robosc.model.places import place
from robosc.model.semantics.communication import port_event_of
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import MOST
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2m.expressions import SctExpressions
    from robosc.m2m.trace import Trace
    from robosc.model.semantics.instances import Instance, Statement


@dataclass
class RequirementAutomaton:
    """A requirement automaton under construction, and the condition under which each restricted event may happen."""

    trace: Trace
    statement: Statement[robosc.Requirement]
    plant: sct.Plant
    allowed: dict[sct.Event, ex.Expression] = field(default_factory=dict)

    def fill(self, expressions: SctExpressions) -> None:
        """Add the edges of the automaton and set the conditions. Precondition: all automata have their locations."""
        match self.statement.element:
            case robosc.OrderRequirement() as order:
                self._order(order)
            case robosc.CountRequirement() as count:
                self._count(count)
            case robosc.AutomatonRequirement() as automaton:
                self._automaton(automaton, expressions)

    def declare(self) -> None:
        """Add the locations of the automaton."""
        element = self.statement.element
        if isinstance(element, robosc.AutomatonRequirement):
            unmarked = not any(state.marked for state in element.states)
            for state in element.states:
                location = self._location(state.name, initial=state.initial, marked=unmarked or state.marked)
                location.source = state.source
                self.trace.requirement_locations[self._within, state] = location
                # An automaton with `each` in the template's own text is read for other instances, too.
                self.trace.requirement_locations.setdefault((None, state), location)
        elif isinstance(element, robosc.OrderRequirement):
            self._location("waiting", initial=True)
            self._location("ready")
        else:
            self._location("counting", initial=True)

    @property
    def _within(self) -> Instance | None:
        return self.statement.within

    def _location(self, name: str, *, initial: bool = False, marked: bool = True) -> sct.Location:
        location = sct.Location(name=name, initial=initial, marked=marked, source=self.plant.source)
        self.plant.locations.append(location)
        return location

    def _event(self, reference: robosc.EventReference) -> sct.Event:
        port = self.trace.instances.port(reference.communicationType, self._within)
        named = port_event_of(reference)
        assert port is not None
        assert named is not None
        return self.trace.event(port, named.kind)

    def _events(self, named: robosc.EventSet) -> list[sct.Event]:
        return list(dict.fromkeys(map(self._event, named.events)))

    def _order(self, order: robosc.OrderRequirement) -> None:
        waiting, ready = self.plant.locations
        anchor, restricted = self._event(order.anchor), self._events(order.target)
        for event in restricted if order.each else ():
            if event is not anchor:
                waiting.edges.append(sct.Edge(event=event, target=waiting))
                ready.edges.append(sct.Edge(event=event, target=waiting))
        for location in (waiting, ready):
            location.edges.append(sct.Edge(event=anchor, target=ready))
        self.allowed = {event: sct.LocationReference(location=ready) for event in restricted}

    def _count(self, count: robosc.CountRequirement) -> None:
        (counting,) = self.plant.locations
        anchor, restricted = self._event(count.anchor), self._events(count.target)
        most = constant_value(count.bound, self._within)
        if type(most) is not int or not 1 <= most <= MOST:
            raise ModelError([_no_bound(count)])
        counter = sct.DiscreteVariable(
            name="count", type=ex.IntegerType(minimum=0, maximum=most), initial=ex.IntegerLiteral(value=0)
        )
        self.plant.variables.append(counter)
        so_far = sct.VariableReference(variable=counter)
        for event in dict.fromkeys([*restricted, anchor]):
            one_more = ex.Addition(left=sct.VariableReference(variable=counter), right=ex.IntegerLiteral(value=1))
            value = ex.IntegerLiteral(value=0) if event is anchor else one_more
            edge = sct.Edge(event=event, target=counting)
            edge.updates.append(sct.Update(variable=counter, value=value))
            counting.edges.append(edge)
        for event in restricted:
            so_far = sct.VariableReference(variable=counter)
            self.allowed[event] = ex.LessThan(left=so_far, right=ex.IntegerLiteral(value=most))

    def _automaton(self, automaton: robosc.AutomatonRequirement, expressions: SctExpressions) -> None:
        here = {state: self.trace.requirement_locations[self._within, state] for state in automaton.states}
        named = {self._event(transition.event): None for state in automaton.states for transition in state.transitions}
        for event in named:
            allowed: list[ex.Expression] = []
            always = True
            for state, location in here.items():
                tried = [transition for transition in state.transitions if self._event(transition.event) is event]
                self._edges(
                    event,
                    location,
                    [(transition, here[transition.target or state]) for transition in tried],
                    expressions,
                )
                unguarded = any(transition.guard is None for transition in tried)
                always = always and unguarded
                if tried:
                    guards = [self._guard(transition, expressions) for transition in tried]
                    parts = [sct.LocationReference(location=location), None if unguarded else disjunction(guards)]
                    allowed += filter(None, [conjunction(filter(None, parts))])
            holds = disjunction(allowed)
            if not always and holds is not None:
                self.allowed[event] = holds

    def _edges(
        self,
        event: sct.Event,
        location: sct.Location,
        tried: Sequence[tuple[robosc.RequirementTransition, sct.Location]],
        expressions: SctExpressions,
    ) -> None:
        """Add the edges of a location for an event: the first transition whose condition holds is taken.

        If no condition holds, a requirement forbids the event, so that the target does not matter: the last transition
        is taken.
        """
        before: list[ex.Expression] = []
        for number, (transition, target) in enumerate(tried, start=1):
            own = [] if number == len(tried) else [self._guard(transition, expressions)]
            guard = conjunction([*(ex.Negation(operand=copy_tree(other)) for other in before), *own])
            location.edges.append(sct.Edge(event=event, guard=guard, target=target, source=transition.source))
            before += map(copy_tree, own)
        if not tried:
            location.edges.append(sct.Edge(event=event, target=location))

    def _guard(self, transition: robosc.RequirementTransition, expressions: SctExpressions) -> ex.Expression:
        if transition.guard is None:
            return ex.BooleanLiteral(value=True)
        return expressions(transition.guard, self._within, transition)


def _no_bound(count: robosc.CountRequirement) -> Diagnostic:
    message = f"`at most` counts to a constant from 1 to {MOST:,}"
    return Diagnostic(*place(count.bound), Severity.ERROR, "integer-range", message, "write such an integer")
