"""Arithmetic on decision diagrams equals that of expressions, for all values of small signed ranges."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import pytest

from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.operators import BY_CLASS, FUNCTIONS, Operator, TypeRule
from robosc.synthesis import use_encoding
from tests.sct_models import edge, model, plant

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.synthesis.encoding import Encoding

RANGES = {"a": range(-5, 7), "b": range(-3, 5), "p": range(2), "q": range(2)}
#: Divisors: positive constants.
DIVISORS = (1, 2, 3, 5, 16)
MODEL = model(
    [
        plant(
            "machine",
            {"idle": [edge("go")]},
            controllable=["go"],
            variables={"a": "-5..6", "b": "-3..4", "p": "bool", "q": "bool"},
        )
    ]
)
VARIABLES = {variable.name: variable for variable in MODEL.plants[0].variables}
#: The operators that an sct model may have.
ROWS = [
    row for row in (*BY_CLASS.values(), *FUNCTIONS.values()) if row.is_supervised and row.metaclass != engine.Remainder
]


def reference(name: str) -> ex.Expression:
    return sct.VariableReference(variable=VARIABLES[name])


def constant(value: int) -> ex.Expression:
    literal = ex.IntegerLiteral(value=abs(value))
    return ex.UnaryMinus(operand=literal) if value < 0 else literal


def expressions(row: Operator) -> Iterator[ex.Expression]:
    """Return applications of an operator or function to variables and constants of matching types."""
    names = ("p", "q") if row.rule is TypeRule.LOGICAL else ("a", "b")
    if row.metaclass is sct.Quotient:  # the dividend is not negative
        for divisor in DIVISORS:
            left = ex.Addition(left=reference("a"), right=constant(5))
            yield sct.Quotient(left=left, right=constant(divisor))
    elif row.divisors:
        for divisor in DIVISORS:
            yield ex.FunctionCall(function=row.symbol, arguments=[reference("a"), constant(divisor)])
    elif row.metaclass is ex.FunctionCall:
        yield ex.FunctionCall(function=row.symbol, arguments=[reference(name) for name in names[: row.parameters]])
    elif issubclass(row.metaclass, ex.UnaryExpression):
        yield row.metaclass(operand=reference(names[0]))
    else:
        yield row.metaclass(left=reference(names[0]), right=reference(names[1]))
        if row.rule is not TypeRule.LOGICAL:
            yield row.metaclass(left=constant(-2), right=reference("b"))


def assert_equal(expression: ex.Expression) -> None:
    """Check that decision diagrams and the interpreter agree for all values of the variables."""

    def look(encoding: Encoding) -> list[tuple[dict[str, int], object, object]]:
        vector = encoding.vector(expression)
        differing = []
        for values in product(*RANGES.values()):
            given = dict(zip(RANGES, values, strict=True))
            state = encoding.diagrams.all_of(
                encoding.has_code(VARIABLES[name], value - RANGES[name].start) for name, value in given.items()
            )
            *bits, sign = [(state & bit).satisfiable() for bit in vector]
            found = sum(bit << place for place, bit in enumerate(bits)) - (sign << len(bits))
            wanted = evaluate(expression, lambda read, given=given: value_of(read.variable.name, given))
            if found != wanted:
                differing.append((given, found, wanted))
        return differing

    assert use_encoding(MODEL, look) == []


def value_of(name: str, values: dict[str, int]) -> bool | int:
    return bool(values[name]) if name in ("p", "q") else values[name]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.metaclass.__name__}-{row.symbol}")
def test_an_operator(row: Operator) -> None:
    found = list(expressions(row))
    assert found
    for expression in found:
        assert_equal(expression)


def test_operators_in_operators() -> None:
    """The result of one operator is an operand of the next and has more bits than a variable."""

    def negated() -> ex.Expression:
        return ex.UnaryMinus(operand=ex.Multiplication(left=reference("a"), right=reference("b")))

    def chosen() -> ex.Expression:
        sign = ex.LessThan(left=reference("b"), right=constant(0))
        otherwise = ex.Subtraction(left=reference("a"), right=negated())
        return ex.Conditional(condition=sign, then=negated(), otherwise=otherwise)

    for function in ("abs", "min", "max"):
        arguments = [chosen(), reference("a")][: FUNCTIONS[function].parameters]
        assert_equal(ex.FunctionCall(function=function, arguments=arguments))
    assert_equal(ex.FunctionCall(function="mod", arguments=[chosen(), constant(7)]))
