"""Plant invariants over states: the system itself keeps them, so no edge leads to a state that violates one.

If only one plant changes the elements of an invariant with an event, the guards of its edges get the invariant. If
several plants change them together, the event is excluded in states in which their edges would violate it.
"""

from __future__ import annotations

from itertools import product
from math import prod
from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree, fold, operands, parts, with_operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    Element = sct.Plant | sct.DiscreteVariable

#: Limits for an event in several plants: combinations of edges, and operators and operands of the result.
_MOST, _LARGEST = 1_000, 100_000


def keep(
    invariant: ex.Expression, edges: dict[sct.Event, dict[sct.Plant, list[sct.Edge]]]
) -> Iterator[tuple[sct.Event, ex.Expression | None]]:
    """Add an invariant to guards; yield each event to exclude with its condition.

    The condition is None if there are too many combinations of edges.
    """
    elements = set(_read(invariant))
    for event, by_plant in edges.items():
        changing = {
            plant: own for plant, own in by_plant.items() if any(elements & set(_changed(edge)) for edge in own)
        }
        if len(changing) == 1 and all(plant.kind != sct.PlantKind.requirement for plant in changing):
            [own] = changing.values()
            for edge in own:
                if elements & set(_changed(edge)):
                    parts = [part for part in (edge.guard, after(invariant, [edge])) if part is not None]
                    edge.guard = conjunction(parts)
        elif changing:
            yield event, _together(invariant, list(changing.values()))


def _together(invariant: ex.Expression, edges: Sequence[Sequence[sct.Edge]]) -> ex.Expression | None:
    """Return the condition under which joint edges of several plants keep the invariant.

    Returns None if it would be too large.
    """
    ways = prod(map(len, edges))
    if ways > _MOST or ways * sum(1 for _ in parts(invariant)) > _LARGEST:
        return None
    conditions = []
    for chosen in product(*edges):
        taken = conjunction(part for edge in chosen for part in _enabled(edge))
        result = after(invariant, chosen)
        conditions.append(result if taken is None else ex.Implication(left=taken, right=result))
    return conjunction(conditions)


def after(condition: ex.Expression, edges: Iterable[sct.Edge]) -> ex.Expression:
    """Return the condition on the state before edges of different plants under which a condition holds after them."""
    targets = {edge.target.eContainer(): edge.target for edge in edges}
    values = {update.variable: update.value for edge in edges for update in edge.updates}

    def replaced(part: ex.Expression, operands: Sequence[ex.Expression]) -> ex.Expression:
        if isinstance(part, sct.LocationReference) and part.location.eContainer() in targets:
            return ex.BooleanLiteral(value=targets[part.location.eContainer()] is part.location)
        if isinstance(part, sct.VariableReference) and part.variable in values:
            return copy_tree(values[part.variable])
        return with_operands(part, operands) if operands else copy_tree(part)

    return fold(replaced, condition, operands)


def _enabled(edge: sct.Edge) -> Iterator[ex.Expression]:
    if len(edge.target.eContainer().locations) > 1:
        yield sct.LocationReference(location=edge.eContainer())
    if edge.guard is not None:
        yield copy_tree(edge.guard)


def _changed(edge: sct.Edge) -> Iterator[Element]:
    if edge.target is not edge.eContainer():
        yield edge.target.eContainer()
    yield from (update.variable for update in edge.updates)


def _read(condition: ex.Expression) -> Iterator[Element]:
    for _, node in tree(condition):
        match node:
            case sct.LocationReference():
                yield node.location.eContainer()
            case sct.VariableReference():
                yield node.variable
