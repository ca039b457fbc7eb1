"""Plain automata of an SCT model, and their supervisor by libFAUDES: a second opinion, explicit state by state.

A variable becomes a part of its plant's state. An event with data becomes one event for each value. A requirement
becomes an automaton that follows the plants in its condition. Automata cannot represent a guard or an update that reads
another plant: it raises a ValueError.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from contextlib import AbstractContextManager

#: The values of locations, with the plant as key, and of variables.
Valuation = dict[sct.Plant | sct.DiscreteVariable, Any]


@dataclass
class Automaton:
    """A deterministic automaton. State 0 is initial. A transition leads from a state by an event to a state.

    `values` contains the values of plants and variables in each state.
    """

    alphabet: frozenset[str]
    values: list[Valuation]
    transitions: dict[tuple[int, str], int]
    marked: list[bool]


def plants(model: sct.SupervisoryControlModel) -> dict[sct.Plant, Automaton]:
    """Return the automaton of each plant. Its states contain all variables of the plant."""
    return {plant: _plant(plant) for plant in model.plants}


def requirements(model: sct.SupervisoryControlModel, of: Mapping[sct.Plant, Automaton]) -> list[Automaton]:
    """Return automata that permit what the requirements permit, one for all requirements on the same plants."""
    asked: dict[tuple[sct.Plant, ...], list[tuple[str, ex.Expression, bool]]] = {}
    for requirement in model.requirements:
        needed = requirement.kind == sct.RequirementKind.needs
        for part in _parts(requirement.condition, ex.Conjunction if needed else ex.Disjunction):
            read = _plants_read(part)
            about = tuple(plant for plant in model.plants if plant in read)
            asked.setdefault(about, []).append((event_name(requirement.event), part, needed))
    return [_requirement([of[name] for name in about], parts) for about, parts in asked.items()]


def uncontrollable(model: sct.SupervisoryControlModel) -> set[str]:
    """Return the names of the uncontrollable events, with each of their values."""
    return {
        label
        for plant in model.plants
        for event in plant.events
        if not event.controllable
        for label, _ in _occurrences(event)
    }


def _plant(plant: sct.Plant) -> Automaton:
    initial: Valuation = {plant: next(location for location in plant.locations if location.initial)}
    for variable in plant.variables:
        initial[variable] = evaluate(variable.initial, _reading({}))
    events = dict.fromkeys(edge.event for edge in edges_of(plant))
    occurrences = [(event, *occurrence) for event in events for occurrence in _occurrences(event)]

    def successors(values: Valuation) -> Iterator[tuple[str, Valuation]]:
        for event, label, inputs in occurrences:
            read = _reading({**values, **inputs})
            for edge in edges_from(values[plant]):
                if edge.event is event and (edge.guard is None or evaluate(edge.guard, read)):
                    updated = {
                        update.variable: _saturated(evaluate(update.value, read), update.variable.type)
                        for update in edge.updates
                    }
                    yield label, {**values, **updated, plant: edge.target}

    found, transitions = _explored(initial, successors)
    marked = [values[plant].marked for values in found]
    return Automaton(frozenset(label for _, label, _ in occurrences), found, transitions, marked)


def _requirement(followed: Sequence[Automaton], parts: Iterable[tuple[str, ex.Expression, bool]]) -> Automaton:
    """Return the product of the followed plants, restricted to events whose conditions hold."""
    alphabet = frozenset[str]().union(*(plant.alphabet for plant in followed))
    conditions: dict[str, list[tuple[ex.Expression, bool]]] = {}
    for label, condition, needed in parts:
        conditions.setdefault(label, []).append((condition, needed))

    def successors(state: tuple[int, ...]) -> Iterator[tuple[str, tuple[int, ...]]]:
        values = {
            key: value for at, plant in zip(state, followed, strict=True) for key, value in plant.values[at].items()
        }
        for label in sorted(alphabet | conditions.keys()):
            after = tuple(
                plant.transitions.get((at, label), -1) if label in plant.alphabet else at
                for at, plant in zip(state, followed, strict=True)
            )
            allowed = (
                evaluate(condition, _reading(values)) == needed for condition, needed in conditions.get(label, ())
            )
            if -1 not in after and all(allowed):
                yield label, after

    found, transitions = _explored(tuple(0 for _ in followed), successors)
    return Automaton(alphabet | conditions.keys(), [], transitions, [True] * len(found))


def _explored(
    initial: Any, successors: Callable[[Any], Iterable[tuple[str, Any]]]
) -> tuple[list[Any], dict[tuple[int, str], int]]:
    """Return all reachable states and the transitions between their numbers."""

    def key(state: Any) -> Any:
        return tuple(state.values()) if isinstance(state, dict) else state

    found, number = [initial], {key(initial): 0}
    transitions = {}
    for at, state in enumerate(found):
        for label, after in successors(state):
            if key(after) not in number:
                number[key(after)] = len(found)
                found.append(after)
            transitions[at, label] = number[key(after)]
    return found, transitions


def _occurrences(event: sct.Event) -> list[tuple[str, dict[sct.Input, Any]]]:
    """Return the names and the data of an event, for all values of its inputs."""
    occurrences = []
    for values in product(*(_values(input_.type) for input_ in event.inputs)):
        data = ", ".join(value.name if isinstance(value, ex.EnumerationLiteral) else str(value) for value in values)
        name = f"{event_name(event)}({data})" if values else event_name(event)
        occurrences.append((name, dict(zip(event.inputs, values, strict=True))))
    return occurrences


def _values(kind: ex.Type) -> list[Any]:
    if isinstance(kind, ex.IntegerType):
        assert kind.minimum is not None
        assert kind.maximum is not None
        return list(range(kind.minimum, kind.maximum + 1))
    return list(kind.enumeration.literals) if isinstance(kind, ex.EnumerationType) else [False, True]


def _saturated(value: Any, kind: ex.Type) -> Any:
    return min(max(value, kind.minimum), kind.maximum) if isinstance(kind, ex.IntegerType) else value


def _reading(values: Mapping[Any, Any]) -> Callable[[ex.Expression], Any]:
    def read(reference: ex.Expression) -> Any:
        match reference:
            case ex.EnumerationLiteralReference():
                return reference.literal
            case sct.LocationReference():
                return _known(reference.location.eContainer()) is reference.location
            case sct.VariableReference():
                return _known(reference.variable)
            case sct.InputReference():
                return _known(reference.input)
        raise TypeError(reference)

    def _known(element: Any) -> Any:
        if element not in values:
            raise ValueError(f"{element.name} belongs to another plant")
        return values[element]

    return read


def _parts(condition: ex.Expression, glue: type[ex.BinaryExpression]) -> Iterator[ex.Expression]:
    if isinstance(condition, glue):
        yield from _parts(condition.left, glue)
        yield from _parts(condition.right, glue)
    else:
        yield condition


def _plants_read(condition: ex.Expression) -> set[sct.Plant]:
    references = (element for _, element in tree(condition))
    return {
        (reference.location if isinstance(reference, sct.LocationReference) else reference.variable).eContainer()
        for reference in references
        if isinstance(reference, sct.LocationReference | sct.VariableReference)
    }


def faudes_states(
    model: sct.SupervisoryControlModel, during: Callable[[str], AbstractContextManager[None]]
) -> tuple[int, int]:
    """Return the numbers of states that libFAUDES computes without requirements and under the supervisor.

    `during` receives the name of each phase. Raises ImportError if `faudes` is not installed.
    """
    plant, supervisor = faudes_supervisor(model, during)
    return plant.Size(), supervisor.Size()


def faudes_supervisor(
    model: sct.SupervisoryControlModel, during: Callable[[str], AbstractContextManager[None]] = nullcontext
) -> tuple[Any, Any]:
    """Return the composed plants and the supervisor as generators of libFAUDES. Arguments as of `faudes_states`."""
    import faudes  # noqa: PLC0415  # an optional dependency

    faudes.StateNamesOff()
    never_forbidden = uncontrollable(model)
    with during("automata"):
        flat = plants(model)
        plants_ = [_generator(plant, never_forbidden) for plant in flat.values()]
        requirements_ = [_generator(requirement, never_forbidden) for requirement in requirements(model, flat)]
    with during("plants"):
        plant = _composed(plants_)
    with during("requirements"):
        specification = _composed(requirements_)
        faudes.InvProject(specification, plant.Alphabet())
    with during("supervisor"):
        supervisor = faudes.System()
        faudes.SupCon(plant, specification, supervisor)
    return plant, supervisor


def _composed(generators: list[Any]) -> Any:
    import faudes  # noqa: PLC0415

    whole = generators[0]
    for generator in generators[1:]:
        part, whole = whole, faudes.System()
        faudes.Parallel(part, generator, whole)
    return whole


def _generator(automaton: Automaton, never_forbidden: set[str]) -> Any:
    import faudes  # noqa: PLC0415

    made = faudes.System()
    events = {
        label: (made.InsUncontrollableEvent if label in never_forbidden else made.InsControllableEvent)(label)
        for label in sorted(automaton.alphabet)
    }
    states = [made.InsState() for _ in automaton.marked]
    made.SetInitState(states[0])
    for state, marked in zip(states, automaton.marked, strict=True):
        if marked:
            made.SetMarkedState(state)
    for (at, label), after in automaton.transitions.items():
        made.SetTransition(states[at], events[label], states[after])
    return made
