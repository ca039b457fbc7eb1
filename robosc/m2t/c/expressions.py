"""Prints types, constants, expressions, guards and effects of an engine model as C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.domains import Width, domain, storage
from robosc.model.semantics.operators import COMPARISONS, PRECEDENCE, SYMBOLS
from robosc.model.semantics.printing import Printed, Printer

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.m2t.c.names import CNames

_INDENT = "    "
_CONDITIONAL = 0
_JUNCTION = PRECEDENCE[ex.Conjunction]
_UNARY = PRECEDENCE[ex.Negation]


def integer_type(bits: int, *, signed: bool) -> str:
    """Return the type of <stdint.h> of a width."""
    return f"{'' if signed else 'u'}int{bits}_t"


def type_name(kind: ex.Type) -> str:
    """Return the C type that stores a value of a type of an sct or engine model."""
    if isinstance(kind, ex.BooleanType):
        return "bool"
    width = storage(domain(kind))
    return integer_type(width.bits, signed=width.signed)


def unsigned_type(most: int) -> str:
    """Return the C type for a number up to `most` that mixes with `unsigned` numbers."""
    return next(f"uint{bits}_t" for bits in (8, 16, 32) if Width(bits, signed=False).values.high >= most)


def number(value: int) -> str:
    """Return a constant of any integer type. C has no literal for its most negative number."""
    return f"(-{-(value + 1)} - 1)" if value == -(2**63) else str(value)


def clamp(saturation: engine.Saturation) -> str:
    """Return the engine's function that limits a value to bounds."""
    return "clamp" if saturation.bits == 32 else "clampwide"


class CPrinter(Printer):
    """Prints expressions over `state->…`, `inputs->…` and, for values before the event, `old.…`."""

    symbols = {  # noqa: RUF012  # ClassVar in the parent
        **SYMBOLS,
        ex.Equation: "==",
        engine.Remainder: "%",
        sct.Quotient: "/",
        engine.And: "&&",
        engine.Or: "||",
    }

    #: Prefix of the name of a state member.
    state = "state->"
    #: Prefix of the name of an input.
    inputs = "inputs->"

    def __init__(self, names: CNames) -> None:
        self._names = names

    def write(self, expression: ex.Expression, printed: Sequence[Printed]) -> Printed:
        """Print an expression, with C's forms of long junctions, conversions, saturation and `?:`."""
        match expression:
            case engine.And() | engine.Or():
                return Printed(f" {self.symbols[type(expression)]} ".join(_operands(printed)), _JUNCTION)
            case ex.UnaryMinus(operand=ex.IntegerLiteral(value=value)):
                return Printed(number(-value), _UNARY)
            case engine.Conversion(bits=16, widens=True):
                return printed[0]  # C computes in `int`, which has at least 16 bits.
            case engine.Conversion(bits=bits, signed=signed):
                return Printed(f"({integer_type(bits, signed=signed)}){printed[0].tight}", _UNARY)
            case engine.Saturation(minimum=low, maximum=high):
                return Printed(f"{clamp(expression)}({printed[0].text}, {number(low)}, {number(high)})")
            case ex.Conditional():
                condition, then, otherwise = (around(part, _CONDITIONAL + 1) for part in printed)
                return Printed(f"{condition} ? {then} : {otherwise}", _CONDITIONAL)
        return super().write(expression, printed)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """Print a binary operator. A number compared with an unsigned one is unsigned; a condition gets parentheses."""
        if not isinstance(expression, COMPARISONS):
            return super().binary(expression, left, right)
        first, second = expression.left, expression.right
        sides = _compared(first, second, left), _compared(second, first, right)
        return Printed(f" {self.symbols[type(expression)]} ".join(sides), PRECEDENCE[type(expression)])

    def atom(self, expression: ex.Expression) -> str:
        """Return the place of a value, the function of a shared condition, an enumerator, or a number."""
        match expression:
            case engine.VariableReference():
                return f"{'old.' if expression.before else self.state}{self._names.of(expression.variable)}"
            case engine.InputReference():
                return f"{self.inputs}{self._names.of(expression.input)}"
            case engine.ConditionReference():
                return f"{expression.condition.name}(state)"
            case engine.LocationLiteral():
                return self._names.enumerator(expression.location)
            case ex.EnumerationLiteralReference():
                return self._names.enumerator(expression.literal)
        return super().atom(expression)

    def constant(self, kind: ex.Type, value: int) -> str:
        """Return a value of a type."""
        match kind:
            case ex.BooleanType():
                return "true" if value else "false"
            case ex.EnumerationType(enumeration=enumeration):
                return self._names.enumerator(enumeration.literals[value])
            case engine.LocationType(plant=plant):
                return self._names.enumerator(plant.locations[value])
        return number(value)

    def lines(self, condition: ex.Expression) -> list[str]:
        """Return a condition as lines: one operand of a conjunction or disjunction each, with its operator first."""
        if not isinstance(condition, (engine.And, engine.Or)):
            return [self(condition)]
        first, *others = _operands(map(self.printed, condition.operands))
        return [first, *(f"{self.symbols[type(condition)]} {other}" for other in others)]

    def guard(self, guard: engine.Guard) -> list[str]:
        """Return a guard as lines, one part each. Parts added by synthesis are marked."""
        terms = list(guard.terms)
        if not terms:
            return ["true"]
        if len(terms) == 1 and isinstance(terms[0].condition, engine.Or):
            return self.lines(terms[0].condition)
        least = _JUNCTION + 1 if len(terms) > 1 else 0
        lines = [f"{around(self.printed(term.condition), least)}{_mark(term)}" for term in terms]
        return [lines[0], *(f"&& {line}" for line in lines[1:])]

    def effect(self, effect: engine.Effect) -> list[str]:
        """Return the statements of an effect. Values before the event come from `old`, a copy of the state."""
        return [line for step in effect.steps for line in self._step(step)]

    def _step(self, step: engine.Step) -> Sequence[str]:
        if isinstance(step, engine.Assignment):
            return [f"state->{self._names.of(step.variable)} = {self(step.value)};"]
        assert isinstance(step, engine.Switch)
        lines: list[str] = []
        for position, case in enumerate(step.cases):
            opening = "{" if case.condition is None else f"if ({self(case.condition)}) {{"
            lines.append(f"}} else {opening}" if position else opening)
            lines += [f"{_INDENT}{line}" for assignment in case.assignments for line in self._step(assignment)]
        if len(step.cases) > 1 and step.cases[-1].condition is not None:
            lines += ["} else {", f"{_INDENT}/* Elsewhere nothing changes. */"]
        return [*lines, "}"]


def around(printed: Printed, least: int) -> str:
    """Return the text, in parentheses if it binds less tightly than `least`."""
    return printed.text if printed.precedence >= least else f"({printed.text})"


def _operands(printed: Iterable[Printed]) -> list[str]:
    """Return the operands of a conjunction or disjunction."""
    return [around(part, _JUNCTION + 1) for part in printed]


def _compared(side: ex.Expression, other: ex.Expression, printed: Printed) -> str:
    if isinstance(side, ex.IntegerLiteral) and _is_unsigned(other):
        return f"{printed.text}U"
    return printed.tight if isinstance(side, ex.Negation) else around(printed, PRECEDENCE[ex.Addition])


def _is_unsigned(node: ex.Expression) -> bool:
    """Return whether a number is stored without sign, so that C must compare it with an unsigned constant."""
    match node:
        case engine.VariableReference(variable=declared) | engine.InputReference(input=declared):
            return isinstance(declared.type, ex.IntegerType) and not declared.signed
    return False


def _mark(term: engine.Term) -> str:
    if engine.Origin.synthesis not in term.origins:
        return ""
    partly = len(term.origins) > 1
    return f" /* {'partly ' if partly else ''}added by synthesis */"
