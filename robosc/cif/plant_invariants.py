"""Plant invariants over states: the system itself never leaves them, so no edge leads out of them.

An event that changes what such an invariant reads in one plant alone has it in the guards of its edges there. One that
changes it in several plants at once is excluded where their edges together would lead out.
"""

from __future__ import annotations

from itertools import product
from math import prod
from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.reflection import tree
from robosc.semantics.printing import conjunction
from robosc.semantics.walks import copied, fold, operands, parts, with_operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    Element = sct.Plant | sct.DiscreteVariable

#: So many ways to take an event in several plants are looked at, and so many operators and operands made of them.
_MOST, _LARGEST = 1_000, 100_000


def keep(
    invariant: ex.Expression, edges: dict[sct.Event, dict[sct.Plant, list[sct.Edge]]]
) -> Iterator[tuple[sct.Event, ex.Expression | None]]:
    """Puts an invariant into guards; gives the events that are excluded, where not by what; None: in too many ways."""
    read = set(_read(invariant))
    for event, by_plant in edges.items():
        changing = {plant: own for plant, own in by_plant.items() if any(read & set(_changed(edge)) for edge in own)}
        if len(changing) == 1 and all(plant.kind != sct.PlantKind.requirement for plant in changing):
            [own] = changing.values()
            for edge in own:
                if read & set(_changed(edge)):
                    parts = [part for part in (edge.guard, after(invariant, [edge])) if part is not None]
                    edge.guard = conjunction(parts)
        elif changing:
            yield event, _together(invariant, list(changing.values()))


def _together(invariant: ex.Expression, edges: Sequence[Sequence[sct.Edge]]) -> ex.Expression | None:
    """That what edges of several plants do together keeps the invariant."""
    ways = prod(map(len, edges))
    if ways > _MOST or ways * sum(1 for _ in parts(invariant)) > _LARGEST:
        return None
    kept = []
    for chosen in product(*edges):
        taken = conjunction(part for edge in chosen for part in _enabled(edge))
        result = after(invariant, chosen)
        kept.append(result if taken is None else ex.Implication(left=taken, right=result))
    return conjunction(kept)


def after(condition: ex.Expression, edges: Iterable[sct.Edge]) -> ex.Expression:
    """That a condition holds after some edges of different plants, as a condition on the state before."""
    targets = {edge.target.eContainer(): edge.target for edge in edges}
    values = {update.variable: update.value for edge in edges for update in edge.updates}

    def replaced(part: ex.Expression, given: Sequence[ex.Expression]) -> ex.Expression:
        if isinstance(part, sct.LocationReference) and part.location.eContainer() in targets:
            return ex.BooleanLiteral(value=targets[part.location.eContainer()] is part.location)
        if isinstance(part, sct.VariableReference) and part.variable in values:
            return copied(values[part.variable])
        return with_operands(part, given) if given else copied(part)

    return fold(replaced, condition, operands)


def _enabled(edge: sct.Edge) -> Iterator[ex.Expression]:
    if len(edge.target.eContainer().locations) > 1:
        yield sct.LocationReference(location=edge.eContainer())
    if edge.guard is not None:
        yield copied(edge.guard)


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
