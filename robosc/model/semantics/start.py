"""Initial state of a run. A model from CIF may have several; the first one in the order of its text is used.

States are compared by each plant and variable in turn: an earlier location or a lower value comes first. Only states
that satisfy all initial predicates and the supervisor's initial condition count.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.model.semantics.domains import domain
from robosc.model.semantics.evaluation import Program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Element with a state. A plant stands for its location, which is identified by its number.
_Element: TypeAlias = "sct.Plant | sct.DiscreteVariable"


def first_state(model: sct.SupervisoryControlModel) -> dict[_Element, int]:
    """Return the number of each plant's location and the value of each variable. An enumeration's value is a position.

    Raises ValueError if no state satisfies all predicates: the model then has no supervisor.
    """
    choices = {element: values for plant in model.plants for element, values in _choices(plant)}
    predicates = list(model.initialPredicates)
    if model.supervisor is not None and model.supervisor.initial is not None:
        predicates.append(model.supervisor.initial)
    start: dict[_Element, int] = {element: values[0] for element, values in choices.items()}
    order = list(choices)
    place = {element: number for number, element in enumerate(order)}
    # Each predicate is checked as soon as all elements that it reads have values.
    predicates_by_last: dict[int, list[Program[bool]]] = {}
    for predicate in predicates:
        last = max((place[element] for element in _read(predicate)), default=-1)
        predicates_by_last.setdefault(last, []).append(Program(predicate, _reader(start)))
    if not all(program() for program in predicates_by_last.get(-1, ())):
        raise ValueError("no state is initial")
    # Only elements that predicates read need a search.
    searched = sorted({place[element] for predicate in predicates for element in _read(predicate)})
    left: list[Iterator[int]] = []
    while len(left) < len(searched):
        left.append(iter(choices[order[searched[len(left)]]]))
        while not _next(
            start, order[searched[len(left) - 1]], left[-1], predicates_by_last.get(searched[len(left) - 1], [])
        ):
            left.pop()
            if not left:
                raise ValueError("no state is initial")
    return start


def _next(
    start: dict[_Element, int], element: _Element, values: Iterator[int], predicates: list[Program[bool]]
) -> bool:
    """Set the next value for which the predicates hold. Return whether there is one."""
    for value in values:
        start[element] = value
        if all(predicate() for predicate in predicates):
            return True
    return False


def _choices(plant: sct.Plant) -> Iterator[tuple[_Element, range | list[int]]]:
    yield plant, [number for number, location in enumerate(plant.locations) if location.initial]
    for variable in plant.variables:
        if variable.initial is None:
            low, high = domain(variable.type)
            yield variable, range(low, high + 1)
        else:
            yield variable, [int(Program[int](variable.initial, _reader({}))())]


def _read(predicate: ex.Expression) -> Iterator[_Element]:
    for _, part in tree(predicate):
        if isinstance(part, sct.LocationReference):
            yield part.location.eContainer()
        elif isinstance(part, sct.VariableReference):
            yield part.variable


def _reader(start: dict[_Element, int]) -> Callable[[ex.Expression], Callable[[], int]]:
    def reader(reference: ex.Expression) -> Callable[[], int]:
        match reference:
            case sct.LocationReference():
                plant = reference.location.eContainer()
                number = list(plant.locations).index(reference.location)
                return lambda: start[plant] == number
            case sct.VariableReference():
                return lambda: start[reference.variable]
        assert isinstance(reference, ex.EnumerationLiteralReference)
        position = list(reference.literal.eContainer().literals).index(reference.literal)
        return lambda: position

    return reader
