"""Expressions of an sct model as text of CIF."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.printing import PRECEDENCE, ExpressionPrinter

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.m2t.cif.names import CifNames


class CifPrinter(ExpressionPrinter):
    """Prints what `robosc.m2t.cif.arithmetic` made of an expression, as it is read in a plant or outside of all."""

    symbols: ClassVar[Mapping[type[ex.Expression], str]] = {
        ex.Implication: "=>",
        ex.Disjunction: "or",
        ex.Conjunction: "and",
        ex.Equation: "=",
        ex.Inequation: "!=",
        ex.LessThan: "<",
        ex.LessOrEqual: "<=",
        ex.GreaterThan: ">",
        ex.GreaterOrEqual: ">=",
        ex.Addition: "+",
        ex.Subtraction: "-",
        ex.Negation: "not ",
    }

    def __init__(self, names: CifNames, plant: sct.Plant | None) -> None:
        self._names = names
        self._plant = plant

    def binary(self, expression: ex.BinaryExpression) -> str:
        """As everywhere, but that CIF has no chains of implications."""
        if isinstance(expression, ex.Implication):
            sides = (self.operand(expression, side, chain=False) for side in (expression.left, expression.right))
            return " => ".join(sides)
        return super().binary(expression)

    def atom(self, expression: ex.Expression) -> str:
        """Names with their plant before them, literals, and `if a: b elif c: d else e end`."""
        match expression:
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.IntegerLiteral():
                return str(expression.value)
            case ex.EnumerationLiteralReference():
                return self._names.used(expression.literal, self._plant)
            case sct.LocationReference():
                return self._location(expression.location)
            case sct.VariableReference():
                return self._names.used(expression.variable, self._plant)
            case sct.InputReference():
                return self._names.used(expression.input, self._plant)
            case ex.Conditional():
                return self._choice(expression)
        return super().atom(expression)

    def precedence(self, expression: ex.Expression) -> int:
        """As everywhere, but that the location of some plants is a number, which is compared."""
        if isinstance(expression, sct.LocationReference) and self._names.number(expression.location.eContainer()):
            return PRECEDENCE[ex.Equation]
        return super().precedence(expression)

    def _location(self, location: sct.Location) -> str:
        plant: sct.Plant = location.eContainer()
        number = self._names.number(plant)
        if number is None:
            return self._names.used(location, self._plant)
        owner = "" if plant is self._plant else f"{self._names.declared(plant)}."
        return f"{owner}{number} = {plant.locations.index(location)}"

    def _choice(self, expression: ex.Conditional) -> str:
        word, text = "if", ""
        rest: ex.Expression = expression
        while isinstance(rest, ex.Conditional):
            text += f"{word} {self.text(rest.condition)}: {self.text(rest.then)} "
            word, rest = "elif", rest.otherwise
        return f"{text}else {self.text(rest)} end"
