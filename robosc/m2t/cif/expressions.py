"""Expressions of an sct model as text of CIF."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.operators import PRECEDENCE, SYMBOLS
from robosc.semantics.printing import Printed, Printer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.cif.names import AbsoluteNames, CifNames


class CifPrinter(Printer):
    """Prints what `robosc.m2t.cif.arithmetic` made of an expression, as it is read in a plant or outside of all."""

    symbols = {**SYMBOLS, ex.Negation: "not "}  # noqa: RUF012  # ClassVar in the parent

    def __init__(self, names: CifNames | AbsoluteNames, plant: sct.Plant | None) -> None:
        self._names = names
        self._plant = plant

    def inside(self, expression: ex.Expression) -> Sequence[ex.Expression]:
        """Of choices one in the other all at once: CIF writes them as one."""
        if not isinstance(expression, ex.Conditional):
            return super().inside(expression)
        found: list[ex.Expression] = []
        rest: ex.Expression = expression
        while isinstance(rest, ex.Conditional):
            found += [rest.condition, rest.then]
            rest = rest.otherwise
        return [*found, rest]

    def write(self, expression: ex.Expression, given: Sequence[Printed]) -> Printed:
        """`if a: b elif c: d else e end`; the location of some plants is a number, which is compared."""
        if isinstance(expression, ex.Conditional):
            *cases, otherwise = [text for text, _ in given]
            chosen = " elif ".join(f"{asked}: {value}" for asked, value in zip(cases[::2], cases[1::2], strict=True))
            return Printed(f"if {chosen} else {otherwise} end")
        if isinstance(expression, sct.LocationReference) and self._names.number(expression.location.eContainer()):
            return Printed(self.atom(expression), PRECEDENCE[ex.Equation])
        return super().write(expression, given)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """As everywhere, but that CIF has no chains of implications."""
        level = PRECEDENCE[ex.Implication]
        if isinstance(expression, ex.Implication):
            return Printed(f"{self.operand(level, left)} => {self.operand(level, right)}", level)
        return super().binary(expression, left, right)

    def atom(self, expression: ex.Expression) -> str:
        """Names with their plant before them, and literals."""
        match expression:
            case ex.EnumerationLiteralReference():
                return self._names.used(expression.literal, self._plant)
            case sct.LocationReference():
                return self._location(expression.location)
            case sct.VariableReference():
                return self._names.used(expression.variable, self._plant)
            case sct.InputReference():
                return self._names.used(expression.input, self._plant)
        return super().atom(expression)

    def _location(self, location: sct.Location) -> str:
        plant: sct.Plant = location.eContainer()
        number = self._names.number(plant)
        if number is None:
            return self._names.used(location, self._plant)
        owner = "" if plant is self._plant else f"{self._names.declared(plant)}."
        return f"{owner}{number} = {plant.locations.index(location)}"
