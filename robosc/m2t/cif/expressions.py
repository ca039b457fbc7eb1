"""Prints expressions of an sct model as CIF."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.operators import COMPARISONS, PRECEDENCE, SYMBOLS
from robosc.model.semantics.printing import Printed, Printer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.cif.names import AbsoluteNames, CifNames

#: Marks a space in the text of a declaration at which its line may break.
BREAK = "\n"


class CifPrinter(Printer):
    """Prints a lowered expression inside a plant or outside of all, with a BREAK where a line may break."""

    symbols = {**SYMBOLS, ex.Negation: "not "}  # noqa: RUF012  # ClassVar in the parent

    def __init__(self, names: CifNames | AbsoluteNames, plant: sct.Plant | None) -> None:
        self._names = names
        self._plant = plant

    def inside(self, expression: ex.Expression) -> Sequence[ex.Expression]:
        """Return the parts of nested conditionals together: CIF has one form for a chain."""
        if not isinstance(expression, ex.Conditional):
            return super().inside(expression)
        parts: list[ex.Expression] = []
        rest: ex.Expression = expression
        while isinstance(rest, ex.Conditional):
            parts += [rest.condition, rest.then]
            rest = rest.otherwise
        return [*parts, rest]

    def write(self, expression: ex.Expression, printed: Sequence[Printed]) -> Printed:
        """Print an expression; a conditional becomes `if a: b elif c: d else e end`."""
        if isinstance(expression, ex.Conditional):
            *cases, otherwise = [text for text, _ in printed]
            branches = (f"{condition}: {value}" for condition, value in zip(cases[::2], cases[1::2], strict=True))
            return Printed(f"if {f'{BREAK}elif '.join(branches)}{BREAK}else {otherwise} end")
        return super().write(expression, printed)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """Print a binary operator. CIF does not chain implications."""
        level = PRECEDENCE[ex.Implication]
        if isinstance(expression, ex.Implication):
            return Printed(self.between(ex.Implication, self.operand(level, left), self.operand(level, right)), level)
        return super().binary(expression, left, right)

    def between(self, kind: type[ex.BinaryExpression], left: str, right: str) -> str:
        """Return an operator after a BREAK, except for comparisons."""
        return (
            super().between(kind, left, right) if kind in COMPARISONS else f"{left}{BREAK}{self.symbols[kind]} {right}"
        )

    def call(self, expression: ex.FunctionCall, printed_operands: Sequence[Printed]) -> Printed:
        """Print a function call; `mod` is an operator of CIF."""
        if expression.function != "mod":
            return super().call(expression, printed_operands)
        level = PRECEDENCE[ex.Multiplication]
        left, right = (self.operand(level, operand) for operand in printed_operands)
        return Printed(f"{left} mod {right}", level)

    def atom(self, expression: ex.Expression) -> str:
        """Return a name, qualified by its plant, or a literal."""
        match expression:
            case ex.EnumerationLiteralReference():
                return self._names.used_name(expression.literal, self._plant)
            case sct.LocationReference():
                return self._names.used_name(expression.location, self._plant)
            case sct.VariableReference():
                return self._names.used_name(expression.variable, self._plant)
            case sct.InputReference():
                return self._names.used_name(expression.input, self._plant)
        return super().atom(expression)
