"""Expressions of an engine model as C: a table of spellings, and what C asks for besides."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.types import integer_type, number
from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.operators import ATOM, PRECEDENCE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2t.c.names import CNames

_SYMBOLS: Mapping[type[ex.Expression], str] = {
    ex.Equation: "==",
    ex.Inequation: "!=",
    ex.LessThan: "<",
    ex.LessOrEqual: "<=",
    ex.GreaterThan: ">",
    ex.GreaterOrEqual: ">=",
    ex.Addition: "+",
    ex.Subtraction: "-",
    ex.Multiplication: "*",
}
_CONDITIONAL = 0
_JUNCTION = PRECEDENCE[ex.Conjunction]
_UNARY = PRECEDENCE[ex.Negation]
_CHAINS = (ex.Addition, ex.Multiplication)
#: A text, and how tightly its outermost operator binds.
Written = tuple[str, int]


class CPrinter:
    """Prints expressions over `state->…`, `inputs->…` and, for values before the event, `old.…`."""

    def __init__(self, names: CNames) -> None:
        self._names = names

    def __call__(self, expression: ex.Expression) -> str:
        """The text, without parentheses around it."""
        return self.written(expression)[0]

    def written(self, expression: ex.Expression) -> Written:
        """The text and how tightly it binds. Expressions may be deep: this function does not call itself."""
        done: list[Written] = []
        pending: list[tuple[ex.Expression, int]] = [(expression, -1)]
        while pending:
            node, count = pending.pop()
            if count < 0:
                operands = _operands(node)
                pending.append((node, len(operands)))
                pending += [(operand, -1) for operand in reversed(operands)]
            else:
                parts = done[len(done) - count :]
                del done[len(done) - count :]
                done.append(self._operator(node, parts) if parts else self._leaf(node))
        return done[0]

    def joined(self, junction: engine.And | engine.Or) -> tuple[str, list[str]]:
        """The operator of a conjunction or disjunction, and its operands with the parentheses that they need in it."""
        symbol = "&&" if isinstance(junction, engine.And) else "||"
        return symbol, [around(self.written(operand), _JUNCTION + 1) for operand in junction.operands]

    def target(self, variable: engine.StateVariable) -> str:
        """Where a variable is assigned to."""
        return f"state->{self._names.of(variable)}"

    def constant(self, kind: ex.Type, value: int) -> str:
        """A value of a type."""
        match kind:
            case ex.BooleanType():
                return "true" if value else "false"
            case ex.EnumerationType(enumeration=enumeration):
                return self._names.enumerator(enumeration.literals[value])
            case engine.LocationType(plant=plant):
                return self._names.enumerator(plant.locations[value])
        return number(value)

    def _operator(self, node: ex.Expression, parts: Sequence[Written]) -> Written:
        match node:
            case engine.And() | engine.Or():
                symbol = " && " if isinstance(node, engine.And) else " || "
                return symbol.join(around(part, _JUNCTION + 1) for part in parts), _JUNCTION
            case ex.Negation():
                return f"!{around(parts[0], ATOM)}", _UNARY
            case ex.UnaryMinus(operand=ex.IntegerLiteral(value=value)):
                return number(-value), _UNARY
            case ex.UnaryMinus():
                return f"-{around(parts[0], ATOM)}", _UNARY
            case engine.Conversion(bits=16, widens=True):
                return parts[0]  # C computes in `int`, which has 16 bits at least.
            case engine.Conversion():
                return f"({integer_type(node.bits, signed=node.signed)}){around(parts[0], ATOM)}", _UNARY
            case engine.Saturation():
                return f"{clamp(node)}({parts[0][0]}, {number(node.minimum)}, {number(node.maximum)})", ATOM
            case ex.Conditional():
                condition, then, otherwise = (around(part, _CONDITIONAL + 1) for part in parts)
                return f"{condition} ? {then} : {otherwise}", _CONDITIONAL
            case ex.FunctionCall(function="mod"):
                # What C leaves has the sign of the value.
                dividend, divisor = (around(part, ATOM) for part in parts)
                return f"(({dividend} % {divisor}) + {divisor}) % {divisor}", PRECEDENCE[ex.Multiplication]
        assert isinstance(node, ex.BinaryExpression)
        return self._binary(node, parts)

    def _binary(self, node: ex.BinaryExpression, parts: Sequence[Written]) -> Written:
        bound = PRECEDENCE[type(node)]
        sides = [(node.left, node.right, parts[0]), (node.right, node.left, parts[1])]
        if bound >= PRECEDENCE[ex.Addition]:
            chain = isinstance(node, _CHAINS) and type(node) is type(node.left)
            left, right = around(parts[0], bound if chain else bound + 1), around(parts[1], bound + 1)
        else:
            left, right = (self._compared(side, other, written) for side, other, written in sides)
        return f"{left} {_SYMBOLS[type(node)]} {right}", bound

    def _compared(self, side: ex.Expression, other: ex.Expression, written: Written) -> str:
        """A side of a comparison: a number, unsigned if the other side is, or a condition in parentheses."""
        if isinstance(side, ex.IntegerLiteral) and _is_unsigned(other):
            return f"{written[0]}U"
        return around(written, ATOM if isinstance(side, ex.Negation) else PRECEDENCE[ex.Addition])

    def _leaf(self, node: ex.Expression) -> Written:
        match node:
            case engine.VariableReference():
                return f"{'old.' if node.before else 'state->'}{self._names.of(node.variable)}", ATOM
            case engine.InputReference():
                return f"inputs->{self._names.of(node.input)}", ATOM
            case engine.ConditionReference():
                return f"{node.condition.name}(state)", ATOM
            case engine.LocationLiteral():
                return self._names.enumerator(node.location), ATOM
            case ex.EnumerationLiteralReference():
                return self._names.enumerator(node.literal), ATOM
            case ex.BooleanLiteral():
                return ("true" if node.value else "false"), ATOM
        assert isinstance(node, ex.IntegerLiteral)
        return number(node.value), ATOM


def clamp(saturation: engine.Saturation) -> str:
    """The function of the engine that gives the nearest value within bounds."""
    return "clamp" if saturation.bits == 32 else "clampwide"


def around(written: Written, least: int) -> str:
    """The text, in parentheses where it binds less tightly than `least`."""
    text, bound = written
    return text if bound >= least else f"({text})"


def _is_unsigned(node: ex.Expression) -> bool:
    """Whether it is a number that is stored without sign, with which C is to compare a constant without sign."""
    match node:
        case engine.VariableReference(variable=declared) | engine.InputReference(input=declared):
            return isinstance(declared.type, ex.IntegerType) and not declared.signed
    return False


def _operands(node: ex.Expression) -> Sequence[ex.Expression]:
    match node:
        case ex.BinaryExpression():
            return node.left, node.right
        case ex.UnaryExpression():
            return (node.operand,)
        case ex.FunctionCall():
            return list(node.arguments)
        case engine.And() | engine.Or():
            return list(node.operands)
        case ex.Conditional():
            return node.condition, node.then, node.otherwise
    return ()
