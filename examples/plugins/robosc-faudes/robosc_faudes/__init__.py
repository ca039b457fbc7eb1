"""A synthesizer of RoboSC: libFAUDES (https://fgdes.tf.fau.de/faudes) computes the supervisor, state by state.

Plants and requirements become automata, and `SupCon` computes their supervisor. The guard of an event follows from the
supervisor's states in which the event is allowed, out of those in which the plants can execute it. `robosc verify`
checks the guards.
"""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.roles import event_name
from robosc_faudes.automata import Automaton, faudes_supervisor, plants

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    Element = sct.Plant | sct.DiscreteVariable
    #: The values of all elements, in their order.
    Values = tuple[Any, ...]


def synthesize(model: sct.SupervisoryControlModel) -> sct.Supervisor | None:
    """Return the supervisor, or None if it is empty. Raise ValueError for a model that automata cannot represent."""
    flat = list(plants(model).values())
    _, supervisor = faudes_supervisor(model)
    if supervisor.InitStatesEmpty():
        return None
    elements: list[Element] = [element for plant in model.plants for element in (plant, *plant.variables)]
    events = [event for plant in model.plants for event in plant.events if event.controllable]
    allowed, possible = _states(supervisor, flat, elements, {event_name(event) for event in events})
    return sct.Supervisor(
        guards=[
            sct.EventGuard(event=event, synthesis=_condition(elements, allowed[name], possible[name] - allowed[name]))
            for event in events
            for name in [event_name(event)]
        ]
    )


def _states(
    supervisor: Any, flat: Sequence[Automaton], elements: Sequence[Element], controllable: Iterable[str]
) -> tuple[Mapping[str, set[Values]], Mapping[str, set[Values]]]:
    """Return the reachable states in which each controllable event is allowed, and those in which it is possible."""
    allowed: dict[str, set[Values]] = {name: set() for name in controllable}
    possible: dict[str, set[Values]] = {name: set() for name in allowed}
    numbers = {
        label: supervisor.EventIndex(label)
        for label in sorted(set().union(*(generator.alphabet for generator in flat)))
    }
    start = (supervisor.InitState(), tuple(0 for _ in flat))
    pending, seen = [start], {start}
    while pending:
        state, places = pending.pop()
        known = {key: value for plant, at in zip(flat, places, strict=True) for key, value in plant.values[at].items()}
        values = tuple(_plain(known[element]) for element in elements)
        for label, number in numbers.items():
            after = tuple(
                plant.transitions.get((at, label), -1) if label in plant.alphabet else at
                for plant, at in zip(flat, places, strict=True)
            )
            if -1 in after:
                continue
            if label in possible:
                possible[label].add(values)
            if supervisor.ExistsTransition(state, number):
                if label in allowed:
                    allowed[label].add(values)
                reached = (supervisor.SuccessorState(state, number), after)
                if reached not in seen:
                    seen.add(reached)
                    pending.append(reached)
    return allowed, possible


def _plain(value: Any) -> Any:
    """Return a value that can be sorted: the name of a location or literal."""
    return value.name if isinstance(value, (sct.Location, ex.EnumerationLiteral)) else value


def _condition(elements: Sequence[Element], allowed: set[Values], forbidden: set[Values]) -> ex.Expression | None:
    """Return a condition that holds in all `allowed` and no `forbidden` states, over few elements (greedy search)."""
    if not forbidden:
        return None
    if not allowed:
        return ex.BooleanLiteral(value=False)
    kept = list(range(len(elements)))
    for place in range(len(elements)):
        fewer = [other for other in kept if other != place]
        if not _projected(allowed, fewer) & _projected(forbidden, fewer):
            kept = fewer
    inside, outside = _projected(allowed, kept), _projected(forbidden, kept)
    named = [elements[place] for place in kept]
    if len(inside) <= len(outside):
        return _any(named, inside)
    return ex.Negation(operand=_any(named, outside))


def _projected(states: set[Values], kept: Sequence[int]) -> set[Values]:
    return {tuple(state[place] for place in kept) for state in states}


def _any(elements: Sequence[Element], states: set[Values]) -> ex.Expression:
    conjunctions = [
        reduce(
            lambda left, right: ex.Conjunction(left=left, right=right),
            [_equals(element, value) for element, value in zip(elements, values, strict=True)],
        )
        for values in sorted(states)
    ]
    return reduce(lambda left, right: ex.Disjunction(left=left, right=right), conjunctions)


def _equals(element: Element, value: Any) -> ex.Expression:
    if isinstance(element, sct.Plant):
        return sct.LocationReference(location=next(place for place in element.locations if place.name == value))
    read = sct.VariableReference(variable=element)
    if isinstance(element.type, ex.BooleanType):
        return read if value else ex.Negation(operand=read)
    if isinstance(element.type, ex.EnumerationType):
        literal = next(literal for literal in element.type.enumeration.literals if literal.name == value)
        return ex.Equation(left=read, right=ex.EnumerationLiteralReference(literal=literal))
    number = ex.IntegerLiteral(value=abs(value))
    return ex.Equation(left=read, right=ex.UnaryMinus(operand=number) if value < 0 else number)
