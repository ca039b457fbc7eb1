"""Normalized expressions as terms. Equal terms are the same object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.domains import BOOLEAN, Interval, domain
from robosc.model.semantics.operators import BY_CLASS

if TYPE_CHECKING:
    from collections.abc import Container, Hashable, Iterable, Iterator, Mapping, Sequence

#: Sort of a term's value: None for a truth value, `int`, or the owner of the literals or locations.
Sort = type[int] | ex.Enumeration | sct.Plant | None
#: Maximum number of values of a variable for which conditions on it are decided by trying all of them.
_TRIED = 1024

COMPLEMENTS: Final[Mapping[type[ex.Expression], type[ex.Expression]]] = {
    ex.Equation: ex.Inequation,
    ex.Inequation: ex.Equation,
    ex.LessThan: ex.GreaterOrEqual,
    ex.GreaterOrEqual: ex.LessThan,
    ex.GreaterThan: ex.LessOrEqual,
    ex.LessOrEqual: ex.GreaterThan,
}
_REFLEXIVE = (ex.Equation, ex.LessOrEqual, ex.GreaterOrEqual)
_COMMUTATIVE = (ex.Equation, ex.Inequation, ex.Addition, ex.Multiplication, engine.And, engine.Or)


class Term:
    """A normalized expression: the class of its operator or reference, its operands, and the content of a leaf.

    `values` is the interval of its values. `cells` are the variables and inputs that it depends on. If
    there are several, the set may be incomplete.
    """

    __slots__ = ("cells", "leaf", "operands", "operator", "sort", "values")
    cells: dict[engine.Declaration, None]

    def __init__(
        self,
        operator: type[ex.Expression],
        operands: tuple[Term, ...],
        leaf: Any,
        sort: Sort,
        values: Interval,
    ) -> None:
        self.operator = operator
        self.operands = operands
        self.leaf = leaf
        self.sort = sort
        self.values = values
        cells: dict[engine.Declaration, None] = {}
        if isinstance(leaf, engine.Declaration):
            cells[leaf] = None
        for operand in operands:
            cells |= operand.cells
            if len(cells) > 1:
                break
        self.cells = cells

    @property
    def constant(self) -> int | None:
        """The only value of the term. None if it may have several."""
        return self.values.single

    def below(self, leaves: Container[Term] = ()) -> Iterator[Term]:
        """Iterate over the term and its parts, each once and before the terms that contain it.

        Skips parts of `leaves`.
        """
        seen: set[Term] = set()
        pending = [(self, False)]
        while pending:
            term, ready = pending.pop()
            if ready:
                yield term
            elif term not in seen:
                seen.add(term)
                pending.append((term, True))
                if term not in leaves:
                    pending += [(operand, False) for operand in reversed(term.operands)]

    def reads(self) -> dict[engine.Declaration, None]:
        """Return the variables and inputs that the term depends on, in the order of the text."""
        return dict.fromkeys(term.leaf for term in self.below() if isinstance(term.leaf, engine.Declaration))


class Terms:
    """Creates terms. Simplifies them at creation as far as they are decided before the robot runs."""

    def __init__(self) -> None:
        self._cache: dict[Hashable, Term] = {}
        self._tables: dict[Term, int] = {}
        self._opposites: dict[Term, Term] = {}
        self._positions: dict[sct.Location, int] = {}
        self.true = self.constant(None, 1)
        self.false = self.constant(None, 0)

    def constant(self, sort: Sort, value: int) -> Term:
        """Return a constant: a truth value, an integer, or the literal or location at a position."""
        kind: type[ex.Expression] = ex.BooleanLiteral if sort is None else ex.IntegerLiteral
        if isinstance(sort, (sct.Plant, ex.Enumeration)):
            kind = engine.LocationLiteral if isinstance(sort, sct.Plant) else ex.EnumerationLiteralReference
        return self._make(kind, (), value, sort, Interval(value, value))

    def reference(self, declared: engine.Declaration) -> Term:
        """Return the value of a variable or an input."""
        values = domain(declared.type)
        match declared.type:
            case ex.BooleanType():
                sort: Sort = None
            case ex.EnumerationType(enumeration=owner) | engine.LocationType(plant=owner):
                sort = owner
            case _:
                sort = int
        if values.single is not None:
            return self.constant(sort, values.low)
        kind = engine.InputReference if isinstance(declared, engine.Input) else engine.VariableReference
        return self._make(kind, (), declared, sort, values)

    def at(self, variable: engine.StateVariable | None, location: sct.Location, *, holds: bool = True) -> Term:
        """Return the condition that a plant is in a location, or is not.

        Without a variable, the plant has no other location.
        """
        if variable is None:
            return self.true if holds else self.false
        place = self.place(variable.plant, location)
        return self.operation(ex.Equation if holds else ex.Inequation, self.reference(variable), place)

    def place(self, plant: sct.Plant, location: sct.Location) -> Term:
        """Return a location of a plant as a value."""
        if location not in self._positions:
            self._positions |= {known: position for position, known in enumerate(plant.locations)}
        return self.constant(plant, self._positions[location])

    def operation(self, kind: type[ex.Expression], *operands: Term) -> Term:
        """Return an operator on its operands, except for junctions and negations.

        Raises ValueError for an operator that no sct model has: doubles, strings, division.
        """
        if kind is ex.Conditional:
            return self._conditional(*operands)
        if kind in COMPLEMENTS:
            return self._comparison(kind, *operands)
        return self._make(kind, operands, None, int, _interval(kind, *operands))

    def call(self, function: str, value: Term, *others: Term) -> Term:
        """Return a function of integers: `mod` as a remainder, the others by cases."""
        match function, others:
            case "mod", (divisor,):
                return self.modulo(value, divisor)
            case "abs", ():
                below = self.operation(ex.LessThan, value, self.constant(int, 0))
                return self.operation(ex.Conditional, below, self.operation(ex.UnaryMinus, value), value)
            case "min", (other,):
                return self.operation(ex.Conditional, self.operation(ex.LessThan, other, value), other, value)
            case "max", (other,):
                return self.operation(ex.Conditional, self.operation(ex.GreaterThan, other, value), other, value)
        raise ValueError(f"no term for `{function}`")

    def modulo(self, value: Term, divisor: Term) -> Term:
        """Return `value mod divisor`.

        A remainder has the sign of the value; if it may be negative, it is made positive.
        """
        if Interval(0, divisor.values.low - 1).holds(value.values):
            return value
        rest = self.operation(engine.Remainder, value, divisor)
        if value.values.low >= 0:
            return rest
        return self.operation(engine.Remainder, self.operation(ex.Addition, rest, divisor), divisor)

    def _conditional(self, condition: Term, then: Term, otherwise: Term) -> Term:
        if condition.constant is not None or then is otherwise:
            return otherwise if condition.constant == 0 else then
        operands = (condition, then, otherwise)
        return self._decided(self._make(ex.Conditional, operands, None, then.sort, then.values.union(otherwise.values)))

    def _comparison(self, kind: type[ex.Expression], left: Term, right: Term) -> Term:
        if left is right:
            return self.true if kind in _REFLEXIVE else self.false
        for side, other in ((left, right), (right, left)):
            if side.constant is None:
                continue
            if other.sort is None:
                return other if (side is self.true) is (kind is ex.Equation) else self.opposite(other)
            # Not above the lowest value or not below the highest: equal to it.
            smaller, greater = (ex.LessOrEqual, ex.GreaterOrEqual)[:: 1 if side is right else -1]
            if (kind is smaller and side.values.low == other.values.low) or (
                kind is greater and side.values.low == other.values.high
            ):
                kind = ex.Equation
            # Not the lowest value: above it. Not the highest value: below it. Opposites of the above then share one
            # form.
            if kind is ex.Inequation and other.sort is int:
                if side.values.low == other.values.low:
                    kind = ex.GreaterThan if side is right else ex.LessThan
                elif side.values.low == other.values.high:
                    kind = ex.LessThan if side is right else ex.GreaterThan
            # One of two locations or literals: not equal to one is equal to the other.
            if (
                kind is ex.Inequation
                and other.sort is not int
                and other.values == BOOLEAN
                and BOOLEAN.holds(side.values)
            ):
                return self._comparison(ex.Equation, other, self.constant(other.sort, 1 - side.values.low))
        return self._decided(self._make(kind, (left, right), None, None, _interval(kind, left, right)))

    def _decided(self, condition: Term) -> Term:
        """Return a condition, or its truth value if it is the same for all values of its only variable.

        Skips comparisons of a variable with a constant, which intervals decide.
        """
        if condition.sort is None and len(condition.cells) == 1:
            [cell] = condition.cells
            is_open = condition.operator is ex.Conditional or any(operand.operands for operand in condition.operands)
            if is_open and _size(cell) <= _TRIED:
                table = self._table(condition, cell)
                if table in (0, (1 << _size(cell)) - 1):
                    return self.true if table else self.false
        return condition

    def negation(self, condition: Term) -> Term:
        """Return the opposite of a condition that is no junction and no conditional.

        A comparison becomes its complement.
        """
        if condition.operator in COMPLEMENTS:
            return self._comparison(COMPLEMENTS[condition.operator], *condition.operands)
        if condition.operator is ex.Negation:
            return condition.operands[0]
        return self._make(ex.Negation, (condition,), None, None, _interval(ex.Negation, condition))

    def junction(self, kind: type[engine.And | engine.Or], conditions: Iterable[Term]) -> Term:
        """Return a conjunction or disjunction.

        Removes neutral and duplicate parts, and flattens nested ones of its class.
        """
        neutral, absorbing = (self.true, self.false) if kind is engine.And else (self.false, self.true)
        parts: dict[Term, None] = {}
        for condition in conditions:
            parts |= dict.fromkeys(condition.operands if condition.operator is kind else (condition,))
        parts.pop(neutral, None)
        if absorbing in parts or self._contradictory(kind, parts):
            return absorbing
        if len(parts) < 2:
            return next(iter(parts), neutral)
        return self._make(kind, tuple(parts), None, None, BOOLEAN)

    def opposite(self, condition: Term) -> Term:
        """Return the opposite of any condition. Junctions and conditionals are negated part by part."""
        opposites, pending = self._opposites, [condition]
        while pending:
            term = pending[-1]
            parts: tuple[Term, ...] = ()
            if term.operator in (engine.And, engine.Or):
                parts = term.operands
            elif term.operator is ex.Conditional:
                parts = term.operands[1:]
            missing = [part for part in parts if part not in opposites]
            if missing:
                pending += missing
                continue
            turned = [opposites[part] for part in parts]
            if term.operator is ex.Conditional:
                opposites[term] = self.operation(ex.Conditional, term.operands[0], *turned)
            elif parts:
                opposites[term] = self.junction(engine.Or if term.operator is engine.And else engine.And, turned)
            else:
                opposites[term] = self.negation(term)
            pending.pop()
        return opposites[condition]

    def _contradictory(self, kind: type[engine.And | engine.Or], parts: Iterable[Term]) -> bool:
        """Return whether the parts on one variable or location alone decide the junction."""
        groups: dict[engine.Declaration, list[Term]] = {}
        for part in parts:
            if len(part.cells) == 1:
                groups.setdefault(next(iter(part.cells)), []).append(part)
        for cell, group in groups.items():
            # A single part was decided at its creation.
            if len(group) > 1 and _size(cell) <= _TRIED:
                everywhere = (1 << _size(cell)) - 1
                table = everywhere if kind is engine.And else 0
                for part in group:
                    table = table & self._table(part, cell) if kind is engine.And else table | self._table(part, cell)
                if table == (0 if kind is engine.And else everywhere):
                    return True
        return False

    def _table(self, condition: Term, cell: engine.Declaration) -> int:
        """Return the truth table of a condition on one cell: a bit for each value, the lowest value first."""
        if condition not in self._tables:
            order = list(condition.below(self._tables))
            table = 0
            for value in range(cell.maximum, cell.minimum - 1, -1):
                known: dict[Term, int] = {}
                for term in order:
                    if term in self._tables:
                        known[term] = self._tables[term] >> (value - cell.minimum) & 1
                    elif term.operands:
                        known[term] = _value(term, [known[operand] for operand in term.operands])
                    else:
                        known[term] = value if term.constant is None else term.constant
                table = table << 1 | bool(known[condition])
            self._tables[condition] = table
        return self._tables[condition]

    def saturation(self, value: Term, bounds: Interval) -> Term:
        """Return an integer limited to the bounds of a variable."""
        if bounds.holds(value.values):
            return value
        low, high = (min(max(bound, bounds.low), bounds.high) for bound in value.values)
        if low == high:
            return self.constant(int, low)
        return self._make(engine.Saturation, (value,), bounds, int, Interval(low, high))

    def _make(
        self, kind: type[ex.Expression], operands: Sequence[Term], leaf: Hashable, sort: Sort, values: Interval
    ) -> Term:
        if values.single is not None and operands:
            return self.constant(sort, values.low)
        operands = tuple(operands)
        key = (kind, frozenset(operands) if kind in _COMMUTATIVE else operands, leaf, sort)
        if key not in self._cache:
            self._cache[key] = Term(kind, operands, leaf, sort, values)
        return self._cache[key]


def _size(cell: engine.Declaration) -> int:
    """Return the number of values of a variable. `len` of a range would be limited to 2^63."""
    return int(cell.maximum - cell.minimum + 1)


def _interval(kind: type[ex.Expression], *operands: Term) -> Interval:
    row = BY_CLASS.get(kind)
    if row is None or row.interval is None:
        raise ValueError(f"an sct model holds no {kind.__name__}")
    return row.interval(*[operand.values for operand in operands])


def _value(term: Term, operands: Sequence[int]) -> int:
    """Return the value of a term for the values of its operands."""
    kind = term.operator
    if kind is ex.Conditional:
        return operands[1 if operands[0] else 2]
    if kind in (engine.And, engine.Or):
        return all(operands) if kind is engine.And else any(operands)
    return int(BY_CLASS[kind].compute(*operands))
