"""Which values an expression of an sct model can have: what C's types must hold, and which comparisons are decided."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import prod
from typing import TYPE_CHECKING

from robosc.m2t.c.types import Interval, interval_of
from robosc.metamodel import expression as ex
from robosc.metamodel import sct

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

#: How many values a variable may have for the conditions on it to be decided by trying them all.
_TRIED = 1024


@dataclass(frozen=True, eq=False)
class All:
    """A conjunction of any number of conditions; of none: true."""

    parts: Sequence[Node]


@dataclass(frozen=True, eq=False)
class Some:
    """A disjunction of any number of conditions; of none: false."""

    parts: Sequence[Node]


#: An expression, or conditions put together from several without moving them out of their model.
Node = ex.Expression | All | Some
#: What an expression reads.
Cell = sct.Plant | sct.DiscreteVariable | sct.Input


def parts_of(node: Node) -> list[Node] | None:
    """The parts of a conjunction or disjunction, nested ones of the same kind taken apart; None of anything else."""
    if isinstance(node, (All, ex.Conjunction)):
        return _flat(node, (All, ex.Conjunction))
    if isinstance(node, (Some, ex.Disjunction)):
        return _flat(node, (Some, ex.Disjunction))
    return None


def _flat(node: Node, kinds: tuple[type, ...]) -> list[Node]:
    if not isinstance(node, kinds):
        return [node]
    children: Sequence[Node] = (
        [node.left, node.right] if isinstance(node, ex.BinaryExpression) else node.parts  # type: ignore[union-attr]
    )
    return [part for child in children for part in _flat(child, kinds)]


def children_of(node: Node) -> list[Node]:
    """The operands of an expression, from left to right."""
    match node:
        case All() | Some():
            return list(node.parts)
        case ex.BinaryExpression():
            return [node.left, node.right]
        case ex.UnaryExpression():
            return [node.operand]
        case ex.Conditional():
            return [node.condition, node.then, node.otherwise]
    return []


class Ranges:
    """Finds the values of expressions; each is looked at once.

    `ranges(expression)` is the smallest interval that interval arithmetic gives; a condition that it can't decide but
    that reads one variable or location only is tried with every value. Raises TypeError for what no sct model holds
    (doubles, strings, division).
    """

    def __init__(self) -> None:
        self._values: dict[Node, Interval] = {}
        self._cells: dict[Node, frozenset[Cell]] = {}

    def __call__(self, node: Node) -> Interval:
        """The values that the expression can have."""
        if node not in self._values:
            self._values[node] = self._decided(node, _evaluate(node, {}, self))
        return self._values[node]

    def cells(self, node: Node) -> frozenset[Cell]:
        """What the expression reads."""
        if node not in self._cells:
            read = frozenset().union(*(self.cells(child) for child in children_of(node)))
            own = _cell(node)
            self._cells[node] = read if own is None else frozenset([own])
        return self._cells[node]

    def _decided(self, node: Node, values: Interval) -> Interval:
        """Narrows what an operator on conditions can be by looking at the conditions on one cell together."""
        parts = parts_of(node)
        if parts is None or values.single is not None:
            return values
        neutral = isinstance(node, (All, ex.Conjunction))
        by_cell: dict[frozenset[Cell], list[Node]] = {}
        for part in parts:
            if len(self.cells(part)) == 1:
                by_cell.setdefault(self.cells(part), []).append(part)
        for cells, group in by_cell.items():
            if len(group) > 1 and not _both(cells, group, neutral):
                return Interval(1 - neutral, 1 - neutral)
        return values


def _both(cells: frozenset[Cell], group: Sequence[Node], neutral: bool) -> bool:
    """Whether all conditions of the group are `neutral` for some value of what they read."""
    domains = [_domain(cell) for cell in cells]
    if prod(map(len, domains)) > _TRIED:
        return True
    for values in product(*domains):
        at = dict(zip(cells, values, strict=True))

        def evaluate(node: Node, at: Mapping[Cell, int] = at) -> Interval:
            return _evaluate(node, at, evaluate)

        if all(evaluate(part).single == neutral for part in group):
            return True
    return False


def _domain(cell: Cell) -> range:
    if isinstance(cell, sct.Plant):
        return range(len(cell.locations))
    values = interval_of(cell.type)
    return range(values.low, values.high + 1)


def _cell(node: Node) -> Cell | None:
    match node:
        case sct.VariableReference():
            return node.variable
        case sct.InputReference():
            return node.input
        case sct.LocationReference():
            return _plant(node.location)
    return None


def _plant(location: sct.Location) -> sct.Plant:
    plant = location.eContainer()
    assert isinstance(plant, sct.Plant)
    return plant


def _truth(can_be_false: bool, can_be_true: bool) -> Interval:
    return Interval(0 if can_be_false else 1, 1 if can_be_true else 0)


def _evaluate(node: Node, at: Mapping[Cell, int], of: Callable[[Node], Interval]) -> Interval:  # noqa: C901
    """The values of a node, given those of its children, where some cells have one value only."""
    parts = parts_of(node)
    if parts is not None:
        values = [of(part) for part in parts]
        if isinstance(node, (All, ex.Conjunction)):
            return Interval(
                min((each.low for each in values), default=1), min((each.high for each in values), default=1)
            )
        return Interval(max((each.low for each in values), default=0), max((each.high for each in values), default=0))
    match node:
        case ex.BooleanLiteral() | ex.IntegerLiteral():
            return Interval(int(node.value), int(node.value))
        case ex.EnumerationLiteralReference():
            position = node.literal.eContainer().literals.index(node.literal)
            return Interval(position, position)
        case sct.VariableReference() | sct.InputReference():
            cell = _cell(node)
            assert isinstance(cell, (sct.DiscreteVariable, sct.Input))
            return Interval(at[cell], at[cell]) if cell in at else interval_of(cell.type)
        case sct.LocationReference():
            plant = _plant(node.location)
            position = plant.locations.index(node.location)
            return (
                _truth(at[plant] != position, at[plant] == position)
                if plant in at
                else _truth(len(plant.locations) > 1, can_be_true=True)
            )
        case ex.Negation():
            value = of(node.operand)
            return Interval(1 - value.high, 1 - value.low)
        case ex.UnaryMinus():
            value = of(node.operand)
            return Interval(-value.high, -value.low)
        case ex.Conditional():
            condition = of(node.condition).single
            if condition is not None:
                return of(node.then if condition else node.otherwise)
            return of(node.then).union(of(node.otherwise))
        case ex.BinaryExpression():
            return _binary(node, of(node.left), of(node.right))
    raise TypeError(f"an sct model holds no {type(node).__name__}")


def _binary(node: ex.BinaryExpression, left: Interval, right: Interval) -> Interval:
    match node:
        case ex.Implication():
            return Interval(max(1 - left.high, right.low), max(1 - left.low, right.high))
        case ex.Addition():
            return Interval(left.low + right.low, left.high + right.high)
        case ex.Subtraction():
            return Interval(left.low - right.high, left.high - right.low)
        case ex.Multiplication():
            corners = [a * b for a in left for b in right]
            return Interval(min(corners), max(corners))
    same = _same(node.left, node.right)
    match node:
        case ex.Equation() | ex.Inequation():
            differ = not same and (left.single is None or left != right)
            agree = same or (left.low <= right.high and right.low <= left.high)
            return _truth(differ, agree) if isinstance(node, ex.Equation) else _truth(agree, differ)
        case ex.LessThan():
            return _truth(same or left.high >= right.low, not same and left.low < right.high)
        case ex.LessOrEqual():
            return _truth(not same and left.high > right.low, same or left.low <= right.high)
        case ex.GreaterThan():
            return _truth(same or left.low <= right.high, not same and left.high > right.low)
        case ex.GreaterOrEqual():
            return _truth(not same and left.low < right.high, same or left.high >= right.low)
    raise TypeError(f"an sct model holds no {type(node).__name__}")


def _same(one: ex.Expression, other: ex.Expression) -> bool:
    """Whether two expressions are written the same."""
    if type(one) is not type(other):
        return False
    match one:
        case ex.BooleanLiteral() | ex.IntegerLiteral():
            return bool(one.value == other.value)  # type: ignore[attr-defined]
        case ex.EnumerationLiteralReference():
            return one.literal is other.literal  # type: ignore[attr-defined]
        case sct.LocationReference():
            return one.location is other.location  # type: ignore[attr-defined]
        case sct.VariableReference() | sct.InputReference():
            return _cell(one) is _cell(other)
    return all(_same(a, b) for a, b in zip(children_of(one), children_of(other), strict=True))  # type: ignore[arg-type]
