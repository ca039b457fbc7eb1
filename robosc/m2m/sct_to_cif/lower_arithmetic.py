"""Pass: lowers expressions to what CIF's data-based synthesis accepts: no negative number, no `*`, at most one `-`.

A comparison becomes a comparison of two sums; subtracted terms move to the other side. A product of variables is split
by the values of one factor. A function becomes a choice between sums. An assigned value saturates; its subtracted terms
are subtracted at the end, the only place where synthesis accepts a `-`. All other expressions stay unchanged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.m2m.sct_to_cif.linear import LARGEST, Linear, Unsupported, bounds, shift
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.operators import BY_CLASS, COMPARISONS
from robosc.model.semantics.walks import copy_tree, operands, walk, with_operands

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Mapping

    from robosc.m2m.sct_to_cif.linear import Cell

#: Maximum number of cases of one expression.
MOST_CASES = 1024

_ATOMS = (
    ex.BooleanLiteral,
    ex.EnumerationLiteralReference,
    sct.LocationReference,
    sct.VariableReference,
    sct.InputReference,
)
_NUMERIC = (ex.IntegerLiteral, ex.Addition, ex.Subtraction, ex.Multiplication, ex.UnaryMinus, ex.FunctionCall)
_Comparison = type[ex.BinaryExpression]
#: Alternatives: the first one whose condition holds counts. The last one has no condition.
_Pieces = list[tuple[ex.Expression | None, Linear]]
#: An expression, and whether it is needed as a number.
_Part = tuple[ex.Expression, bool]


class Lowering:
    """Lowers expressions. Raises Unsupported for an expression that CIF cannot express.

    `copies` maps each referenced element to its lowered element. `numbered` maps each location that a variable replaces
    to this variable and a number.
    """

    def __init__(
        self, copies: Mapping[Any, Any], numbered: Mapping[sct.Location, tuple[sct.DiscreteVariable, int]]
    ) -> None:
        self._copies = copies
        self._numbered = numbered

    def condition(self, expression: ex.Expression) -> ex.Expression:
        """Lower a boolean or enumeration-valued expression to a new tree. Raises Unsupported."""
        lowered: ex.Expression = walk(self._lowered, (expression, False))
        return lowered

    def _lowered(self, part: _Part) -> Generator[_Part, Any, Any]:
        """Lower an expression. The result for a number is its pieces."""
        expression, number = part
        return (yield from self._number_lowered(expression) if number else self._condition_lowered(expression))

    def _condition_lowered(self, expression: ex.Expression) -> Generator[_Part, Any, ex.Expression]:
        if isinstance(expression, COMPARISONS) and _is_number(expression.left):
            if _is_plain(expression.left) and _is_plain(expression.right):
                return copy_tree(expression, self._copies)
            left, right = (yield expression.left, True), (yield expression.right, True)
            pieces = _sum(expression, left, _scaled(right, -1))
            return _compared(type(expression), pieces, Linear(0), expression)
        if isinstance(expression, sct.LocationReference) and expression.location in self._numbered:
            variable, number = self._numbered[expression.location]
            return ex.Equation(left=sct.VariableReference(variable=variable), right=ex.IntegerLiteral(value=number))
        if isinstance(expression, _ATOMS):
            return copy_tree(expression, self._copies)
        if not isinstance(expression, (ex.Conditional, ex.Negation, ex.BinaryExpression)):
            raise Unsupported(expression, f"CIF has no {type(expression).__name__}")
        operands_lowered = []
        for operand in operands(expression):
            operands_lowered.append((yield operand, False))  # noqa: PERF401 - no comprehension yields
        if isinstance(expression, ex.Conditional):
            return ex.Conditional(
                condition=operands_lowered[0], then=operands_lowered[1], otherwise=operands_lowered[2]
            )
        return with_operands(expression, operands_lowered)

    def lower_assignment(self, variable: sct.DiscreteVariable, value: ex.Expression) -> ex.Expression:
        """Lower the value that is assigned to a variable, limited to its range. Raises Unsupported."""
        if not isinstance(variable.type, ex.IntegerType):
            return self.condition(value)
        low, high = bounds(self._copies[variable])
        pieces = self._linear(value)
        if _is_plain(value) and len(pieces) == 1 and shift(variable) == 0:
            least, greatest = pieces[0][1].range()
            if low <= least and greatest <= high:
                return copy_tree(value, self._copies)
        guards = [guard for guard, _ in pieces]
        parts = [_saturated(piece + Linear(shift(variable)), low, high, value) for _, piece in pieces]
        minuend = _first(zip(guards, (positive for positive, _ in parts), strict=True))
        subtrahends = [subtracted for _, subtracted in parts]
        if not any(subtrahend.factors or subtrahend.constant for subtrahend in subtrahends):
            return minuend
        if all(subtrahend == subtrahends[0] for subtrahend in subtrahends):
            return ex.Subtraction(left=minuend, right=_expression_of(subtrahends[0], value))
        return ex.Subtraction(
            left=minuend,
            right=_first(
                (guard, _expression_of(subtrahend, value))
                for guard, subtrahend in zip(guards, subtrahends, strict=True)
            ),
        )

    def _linear(self, expression: ex.Expression) -> _Pieces:
        pieces: _Pieces = walk(self._lowered, (expression, True))
        return pieces

    def _number_lowered(self, expression: ex.Expression) -> Generator[_Part, Any, _Pieces]:
        match expression:
            case ex.IntegerLiteral():
                return [(None, Linear(expression.value))]
            case sct.VariableReference():
                return [(None, self._cell_value(expression.variable))]
            case sct.InputReference():
                return [(None, self._cell_value(expression.input))]
            case ex.UnaryMinus():
                return _scaled((yield expression.operand, True), -1)
            case ex.Addition() | ex.Subtraction():
                left, right = (yield expression.left, True), (yield expression.right, True)
                return _sum(expression, left, right if isinstance(expression, ex.Addition) else _scaled(right, -1))
            case ex.Multiplication():
                left, right = (yield expression.left, True), (yield expression.right, True)
                return _product(expression, left, right)
            case ex.FunctionCall():
                first, last = (yield expression.arguments[0], True), (yield expression.arguments[-1], True)
                return _called(expression, first, last)
            case ex.Conditional():
                chosen = yield expression.condition, False
                then = yield expression.then, True
                otherwise = yield expression.otherwise, True
                return _choice(expression, chosen, then, otherwise)
        raise Unsupported(expression, f"CIF has no {type(expression).__name__}")

    def _cell_value(self, cell: Cell) -> Linear:
        """Return the original value of a variable or input in terms of its lowered cell."""
        return Linear(-shift(cell), {self._copies[cell]: 1})


def _is_number(expression: ex.Expression) -> bool:
    while isinstance(expression, ex.Conditional):
        expression = expression.then
    match expression:
        case sct.VariableReference():
            return isinstance(expression.variable.type, ex.IntegerType)
        case sct.InputReference():
            return isinstance(expression.input.type, ex.IntegerType)
    return isinstance(expression, _NUMERIC)


def _is_plain(expression: ex.Expression) -> bool:
    """Return whether CIF accepts a number unchanged: a sum of numbers that are never negative."""
    pending = [expression]
    while pending:
        match part := pending.pop():
            case ex.IntegerLiteral() if 0 <= part.value <= LARGEST:
                continue
            case sct.VariableReference() if shift(part.variable) == 0:
                continue
            case sct.InputReference() if shift(part.input) == 0:
                continue
            case ex.Addition():
                pending += [part.left, part.right]
            case _:
                return False
    return True


def _against_zero(operator: _Comparison, value: Linear, origin: ex.Expression) -> ex.Expression:
    if not value.factors:
        return ex.BooleanLiteral(value=BY_CLASS[operator].compute(value.constant, 0))
    left, right = (_expression_of(side, origin) for side in value.sides())
    return operator(left=left, right=right)


def _compared(operator: _Comparison, pieces: _Pieces, added: Linear, origin: ex.Expression) -> ex.Expression:
    """Compare alternatives with zero, after adding `added` to each."""
    return _first((guard, _against_zero(operator, piece + added, origin)) for guard, piece in pieces)


def _expression_of(value: Linear, origin: ex.Expression) -> ex.Expression:
    if value.range()[1] > LARGEST:
        raise Unsupported(origin, "its numbers do not fit 32 bits")
    return value.tree()


def _saturated(value: Linear, low: int, high: int, origin: ex.Expression) -> tuple[ex.Expression, Linear]:
    """Return two terms that are never negative and whose difference is the value, limited to the bounds."""
    least, greatest = value.range()
    if least >= high or greatest <= low:
        return ex.IntegerLiteral(value=high if least >= high else low), Linear(0)
    positive, subtracted = value.sides()
    result = _expression_of(positive, origin)
    # The first term is limited to the bounds, each increased by the subtracted terms.
    for outside, operator, bound in ((least < low, ex.LessThan, low), (greatest > high, ex.GreaterThan, high)):
        if outside:
            result = ex.Conditional(
                condition=_against_zero(operator, value + Linear(-bound), origin),
                then=_expression_of(subtracted + Linear(bound), origin),
                otherwise=result,
            )
    return result, subtracted


def _first(alternatives: Iterable[tuple[ex.Expression | None, ex.Expression]]) -> ex.Expression:
    """Return the expression of the first alternative whose condition holds."""
    result: ex.Expression | None = None
    for guard, value in reversed(list(alternatives)):
        if guard is None or result is None:
            result = value
        else:
            result = ex.Conditional(condition=copy_tree(guard), then=value, otherwise=result)
    assert result is not None
    return result


def _scaled(pieces: _Pieces, factor: int) -> _Pieces:
    return [(guard, piece.times(factor)) for guard, piece in pieces]


def _sum(origin: ex.Expression, left: _Pieces, right: _Pieces) -> _Pieces:
    _limit(origin, len(left) * len(right))
    return [(_both(condition, other), first + second) for condition, first in left for other, second in right]


def _product(expression: ex.Multiplication, left: _Pieces, right: _Pieces) -> _Pieces:
    """Split a product by the values of the factor that has fewer."""
    split, others = sorted((left, right), key=_values)
    _limit(expression, _values(split) * len(others))
    low = min(piece.range()[0] for _, piece in split)
    high = max(piece.range()[1] for _, piece in split)
    pieces: _Pieces = []
    for value in range(low, high + 1):
        guard = _compared(ex.Equation, split, Linear(-value), expression) if value < high else None
        pieces += [(_both(guard, other), piece.times(value)) for other, piece in others]
    return pieces


#: Comparisons by which functions choose between two values.
_CHOOSING = {"abs": ex.LessThan, "min": ex.LessThan, "max": ex.GreaterThan}


def _called(call: ex.FunctionCall, first: _Pieces, last: _Pieces) -> _Pieces:
    """Lower a function of its first and its last argument. All but `mod` choose between values.

    Raises ValueError for a function that no sct model has.
    """
    if call.function == "mod":
        return _modulo(call, first, last[0][1].constant)
    if call.function not in _CHOOSING:
        raise ValueError(f"no lowering for `{call.function}`")
    if call.function == "abs":
        other, difference = _scaled(first, -1), first
    else:  # Put the shorter one first: its alternatives repeat the condition.
        first, other = sorted((first, last), key=len, reverse=True)
        difference = _sum(call, other, _scaled(first, -1))
    chosen = _compared(_CHOOSING[call.function], difference, Linear(0), call)
    return _choice(call, chosen, other, first)


def _choice(origin: ex.Expression, condition: ex.Expression, then: _Pieces, otherwise: _Pieces) -> _Pieces:
    _limit(origin, len(then) + len(otherwise))
    return [*((_both(condition, guard), piece) for guard, piece in then), *otherwise]


def _modulo(expression: ex.FunctionCall, values: _Pieces, divisor: int) -> _Pieces:
    """Split a remainder by the quotient."""
    pieces: _Pieces = []
    for guard, value in values:
        low, high = (bound // divisor for bound in value.range())
        _limit(expression, len(pieces) + high - low + 1)
        for times in range(low, high + 1):
            rest = value + Linear(-times * divisor)
            below = _against_zero(ex.LessThan, rest + Linear(-divisor), expression) if times < high else None
            pieces.append((_both(guard, below), rest))
    return pieces


def _values(pieces: _Pieces) -> int:
    ranges = [piece.range() for _, piece in pieces]
    return max(high for _, high in ranges) - min(low for low, _ in ranges) + 1


def _both(left: ex.Expression | None, right: ex.Expression | None) -> ex.Expression | None:
    """Return the conjunction of two conditions in a new tree. Either condition may be missing."""
    parts = [copy_tree(part) for part in (left, right) if part is not None]
    return ex.Conjunction(left=parts[0], right=parts[1]) if len(parts) == 2 else next(iter(parts), None)


def _limit(origin: ex.Expression, cases: int) -> None:
    if cases > MOST_CASES:
        raise Unsupported(origin, f"it needs {cases} cases; the maximum is {MOST_CASES}")
