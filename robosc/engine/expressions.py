"""Expressions of an sct model as Python functions, made once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.evaluation import Program
from robosc.semantics.operators import operator_of
from robosc.semantics.walks import parts

#: The value of an expression, given the cells of a state and the inputs: an integer; false and true are 0 and 1.
Function = Callable[[Sequence[int], Sequence[int]], int]


class Compiler:
    """Makes functions of expressions over these cells and inputs, each given by its position."""

    def __init__(self, cells: Mapping[sct.Plant | sct.DiscreteVariable, int], inputs: Mapping[sct.Input, int]) -> None:
        self._cells = cells
        self._inputs = inputs

    def __call__(self, expression: ex.Expression) -> Function:
        """The function of an expression. Raises ValueError for what no sct model holds: doubles, strings, division."""
        for part in parts(expression):
            row = operator_of(part)
            if isinstance(part, (ex.DoubleLiteral, ex.StringLiteral)) or (row is not None and row.interval is None):
                raise ValueError(f"an sct model holds no {type(part).__name__}")
        return Program[int](expression, self._atom)

    def _atom(self, expression: ex.Expression) -> Function:
        match expression:
            case ex.EnumerationLiteralReference():
                return _constant(expression.literal.eContainer().literals.index(expression.literal))
            case sct.VariableReference():
                position = self._cells[expression.variable]
                return lambda cells, _: cells[position]
            case sct.InputReference():
                position = self._inputs[expression.input]
                return lambda _, inputs: inputs[position]
            case sct.LocationReference():
                return self._location(expression.location)
        raise ValueError(f"an sct model holds no {type(expression).__name__}")

    def _location(self, location: sct.Location) -> Function:
        plant: sct.Plant = location.eContainer()
        if plant not in self._cells:
            return _constant(1)  # The only location.
        position, value = self._cells[plant], plant.locations.index(location)
        return lambda cells, _: cells[position] == value


def _constant(value: int) -> Function:
    return lambda _cells, _inputs: value
