"""Values of expressions where Python's own arithmetic would differ or fail."""

import math
from typing import Any

import pytest

from robosc.model import expression as ex
from robosc.model.semantics.evaluation import evaluate


def integer(value: int) -> ex.Expression:
    return ex.IntegerLiteral(value=value)


def huge() -> ex.Expression:
    """Return an integer beyond the range of double."""
    product: ex.Expression = integer(10**18)
    for _ in range(20):
        product = ex.Multiplication(left=product, right=integer(10**18))
    return product


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (ex.Division(left=huge(), right=integer(2)), math.inf),
        (ex.Division(left=ex.UnaryMinus(operand=huge()), right=integer(2)), -math.inf),
        (ex.Multiplication(left=ex.DoubleLiteral(value=0.5), right=huge()), math.inf),
        (ex.Addition(left=huge(), right=ex.DoubleLiteral(value=0.5)), math.inf),
        (ex.DoubleConversion(operand=huge()), math.inf),
        (ex.LessThan(left=ex.DoubleLiteral(value=0.5), right=huge()), True),
        (ex.Addition(left=integer(1), right=ex.DoubleLiteral(value=0.5)), 1.5),
        (ex.Division(left=integer(1), right=integer(2)), 0.5),
    ],
)
def test_integers_become_doubles(expression: ex.Expression, expected: Any) -> None:
    assert evaluate(expression, lambda value: value) == expected
