"""Expressions of an sct model as Python functions, made once."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.recursion import deep_recursion

#: The value of an expression, given the cells of a state and the inputs: an integer; false and true are 0 and 1.
Function = Callable[[Sequence[int], Sequence[int]], int]

_OPERATORS: Mapping[type[ex.Expression], Callable[[int, int], int]] = {
    ex.Equation: operator.eq,
    ex.Inequation: operator.ne,
    ex.LessThan: operator.lt,
    ex.LessOrEqual: operator.le,
    ex.GreaterThan: operator.gt,
    ex.GreaterOrEqual: operator.ge,
    ex.Addition: operator.add,
    ex.Subtraction: operator.sub,
    ex.Multiplication: operator.mul,
}


class Compiler:
    """Makes functions of expressions over these cells and inputs, each given by its position."""

    def __init__(self, cells: Mapping[sct.Plant | sct.DiscreteVariable, int], inputs: Mapping[sct.Input, int]) -> None:
        self._cells = cells
        self._inputs = inputs

    def __call__(self, expression: ex.Expression) -> Function:
        """The function of an expression. Raises ValueError for what no sct model holds: doubles, strings, division."""
        with deep_recursion():
            return self.function(expression)

    def function(self, expression: ex.Expression) -> Function:
        """The same, by a call that takes none of the C stack."""
        match expression:
            case ex.BinaryExpression():
                return self._binary(expression, self.function(expression.left), self.function(expression.right))
            case ex.Negation():
                inner = self.function(expression.operand)
                return lambda cells, inputs: not inner(cells, inputs)
            case ex.UnaryMinus():
                inner = self.function(expression.operand)
                return lambda cells, inputs: -inner(cells, inputs)
            case ex.Conditional():
                parts = (expression.condition, expression.then, expression.otherwise)
                condition, then, otherwise = [self.function(each) for each in parts]
                return lambda cells, inputs: (then if condition(cells, inputs) else otherwise)(cells, inputs)
        return self._atom(expression)

    def _binary(self, expression: ex.BinaryExpression, left: Function, right: Function) -> Function:
        match expression:
            case ex.Conjunction():
                return lambda cells, inputs: left(cells, inputs) and right(cells, inputs)
            case ex.Disjunction():
                return lambda cells, inputs: left(cells, inputs) or right(cells, inputs)
            case ex.Implication():
                return lambda cells, inputs: not left(cells, inputs) or right(cells, inputs)
        compute = _OPERATORS.get(type(expression))
        if compute is None:
            raise ValueError(f"an sct model holds no {type(expression).__name__}")
        return lambda cells, inputs: compute(left(cells, inputs), right(cells, inputs))

    def _atom(self, expression: ex.Expression) -> Function:
        match expression:
            case ex.BooleanLiteral() | ex.IntegerLiteral():
                return _constant(int(expression.value))
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
