"""Which values an expression of an sct model can have: what C's types must hold, and which comparisons are decided."""

from __future__ import annotations

from itertools import product
from math import prod
from typing import TYPE_CHECKING

from robosc.m2t.c.nodes import Junction, Node, Not, children_of, is_condition, junction
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import Interval, domain, truth
from robosc.semantics.operators import operator_of

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping, Sequence

#: How many values a variable may have for the conditions on it to be decided by trying them all.
_TRIED = 1024
#: The same for all conditions on it together.
_TRIALS = 1 << 16
_REFLEXIVE = (ex.Equation, ex.LessOrEqual, ex.GreaterOrEqual)
_IRREFLEXIVE = (ex.Inequation, ex.LessThan, ex.GreaterThan)
_COMMUTATIVE = (ex.Equation, ex.Inequation, ex.Addition, ex.Multiplication)


#: What an expression reads.
Cell = sct.Plant | sct.DiscreteVariable | sct.Input


class Ranges:
    """Finds the values of expressions; each is looked at once.

    `ranges(expression)` is the smallest interval that interval arithmetic gives; a condition that it can't decide but
    that reads one variable or location only is tried with every value. Raises TypeError for what no sct model holds
    (doubles, strings, division).
    """

    def __init__(self) -> None:
        self._values: dict[Node, Interval] = {}
        self._cells: dict[Node, frozenset[Cell]] = {}
        self._joined: dict[Node, Junction | None] = {}
        self._reduced: dict[Node, Node] = {}
        self._shapes: dict[Node, int] = {}
        self._numbers: dict[Hashable, int] = {}

    def __call__(self, node: Node) -> Interval:
        """The values that the expression can have."""
        return self.values(node)

    def values(self, node: Node) -> Interval:
        """The same, by a call that takes none of the C stack."""
        if node not in self._values:
            self._values[node] = self._decided(node, _evaluate(node, {}, self.values))
        return self._values[node]

    def cells(self, node: Node) -> frozenset[Cell]:
        """What the value of the expression depends on."""
        if node not in self._cells:
            self._cells[node] = self._read(node)
        return self._cells[node]

    def joined(self, node: Node) -> Junction | None:
        """A node as conjunction or disjunction, without parts that are constant or say the same as one before."""
        if node not in self._joined:
            self._joined[node] = self._join(node)
        return self._joined[node]

    def _join(self, node: Node) -> Junction | None:
        joined = junction(node)
        if joined is None:
            return None
        undecided = [self.reduced(part) for part in joined.parts if self.values(part).single is None]
        inner = [(part, self.joined(part)) for part in undecided]
        parts = [
            each
            for part, nested in inner
            for each in (nested.parts if nested and nested.neutral is joined.neutral else [part])
        ]
        return Junction(joined.neutral, self._distinct(parts))

    def _distinct(self, parts: Sequence[Node]) -> list[Node]:
        """Parts without those that say the same as one before."""
        kept: dict[int, Node] = {}
        for part in parts:
            kept.setdefault(self._shape(part), part)
        return list(kept.values())

    def reduced(self, node: Node) -> Node:
        """The part of an expression that decides it, where the rest is constant."""
        if node not in self._reduced:
            part = self._deciding(node) if self.values(node).single is None else None
            self._reduced[node] = node if part is None else self.reduced(part)
        return self._reduced[node]

    def _deciding(self, node: Node) -> Node | None:
        joined = self.joined(node)
        if joined is not None:
            return joined.parts[0] if len(joined.parts) == 1 else None
        if isinstance(node, ex.Conditional):
            condition = self.values(node.condition).single
            if condition is not None:
                return node.then if condition else node.otherwise
            return node.then if self.same(node.then, node.otherwise) else None
        if isinstance(node, (Not, ex.Negation)):
            denied = self.reduced(node.operand)
            return denied.operand if isinstance(denied, (Not, ex.Negation)) else None
        if isinstance(node, (ex.Equation, ex.Inequation)) and is_condition(node.left):
            return self._compared(node)
        return None

    def _compared(self, node: ex.BinaryExpression) -> Node | None:
        """What a comparison of conditions comes down to, where one of them is constant."""
        for side, other in ((node.left, node.right), (node.right, node.left)):
            value = self.values(side).single
            if value is not None:
                return other if value == isinstance(node, ex.Equation) else Not(other)
        return None

    def _read(self, node: Node) -> frozenset[Cell]:
        if self.values(node).single is not None:
            return frozenset()
        node = self.reduced(node)
        own = _cell(node)
        if own is not None:
            return frozenset([own])
        joined = self.joined(node)
        children = children_of(node) if joined is None else joined.parts
        return frozenset().union(*[self.cells(child) for child in children])

    def same(self, one: Node, other: Node) -> bool:
        """Whether two expressions are written the same once all that is constant has been left out."""
        return self._shape(one) == self._shape(other)

    def _shape(self, node: Node) -> int:
        """A number that the expressions share that are written the same."""
        if node not in self._shapes:
            written = self._written(node)
            self._shapes[node] = self._numbers.setdefault(written, len(self._numbers))
        return self._shapes[node]

    def _written(self, node: Node) -> Hashable:
        single = self.values(node).single
        if single is not None:
            return single
        node = self.reduced(node)
        location = node.location if isinstance(node, sct.LocationReference) else None
        parts = [self._shape(child) for child in children_of(node)]
        if isinstance(node, _COMMUTATIVE):
            parts.sort()
        return type(node), self.values(node), location, _cell(node), tuple(parts)

    def _decided(self, node: Node, values: Interval) -> Interval:
        """Decides what intervals can't: a comparison of equals, conditions on one cell that contradict each other."""
        if values.single is not None:
            return values
        if isinstance(node, _REFLEXIVE + _IRREFLEXIVE) and self.same(node.left, node.right):
            return Interval(1, 1) if isinstance(node, _REFLEXIVE) else Interval(0, 0)
        joined = self.joined(node)
        if joined is None:
            return values
        neutral, parts = joined
        by_cell: dict[frozenset[Cell], list[Node]] = {}
        for part in parts:
            if len(self.cells(part)) == 1:
                by_cell.setdefault(self.cells(part), []).append(part)
        for cells, group in by_cell.items():
            if len(group) > 1 and not self._agree(cells, group, neutral):
                return Interval(1 - neutral, 1 - neutral)
        return values

    def _agree(self, cells: frozenset[Cell], group: Sequence[Node], neutral: bool) -> bool:
        """Whether all conditions of the group can be `neutral` for one value of what they depend on."""
        domains = [_domain(cell) for cell in cells]
        # No `len`: that of a range ends at 2^63.
        values_of_all = prod(domain.high - domain.low + 1 for domain in domains)
        if values_of_all > _TRIED or values_of_all * len(group) > _TRIALS:
            return True
        for values in product(*(range(values.low, values.high + 1) for values in domains)):
            at = dict(zip(cells, values, strict=True))

            def evaluate(node: Node, at: Mapping[Cell, int] = at) -> Interval:
                # What is decided may read other cells, of which nothing is known here.
                return self.values(node) if self.values(node).single is not None else _evaluate(node, at, evaluate)

            if all(evaluate(part).single in {neutral, None} for part in group):
                return True
        return False


def _domain(cell: Cell) -> Interval:
    return domain(cell if isinstance(cell, sct.Plant) else cell.type)


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


def _evaluate(node: Node, at: Mapping[Cell, int], of: Callable[[Node], Interval]) -> Interval:  # noqa: C901
    """The values of a node, given those of its children, where some cells have one value only."""
    joined = junction(node)
    if joined is not None:
        neutral, parts = joined
        choose = min if neutral else max
        values = [of(part) for part in parts]
        return Interval(
            choose((each.low for each in values), default=int(neutral)),
            choose((each.high for each in values), default=int(neutral)),
        )
    match node:
        case ex.BooleanLiteral() | ex.IntegerLiteral():
            return Interval(int(node.value), int(node.value))
        case ex.EnumerationLiteralReference():
            position = node.literal.eContainer().literals.index(node.literal)
            return Interval(position, position)
        case sct.VariableReference() | sct.InputReference():
            cell = _cell(node)
            assert isinstance(cell, (sct.DiscreteVariable, sct.Input))
            return Interval(at[cell], at[cell]) if cell in at else domain(cell.type)
        case sct.LocationReference():
            plant = _plant(node.location)
            if plant not in at:
                return truth(len(plant.locations) > 1, can_be_true=True)
            position = plant.locations.index(node.location)
            return truth(at[plant] != position, at[plant] == position)
        case Not():
            value = of(node.operand)
            return Interval(1 - value.high, 1 - value.low)
        case ex.Conditional():
            condition = of(node.condition).single
            if condition is not None:
                return of(node.then if condition else node.otherwise)
            return of(node.then).union(of(node.otherwise))
    row = operator_of(node) if isinstance(node, ex.Expression) else None
    if row is None or row.interval is None:
        raise TypeError(f"an sct model holds no {type(node).__name__}")
    return row.interval(*[of(child) for child in children_of(node)])
