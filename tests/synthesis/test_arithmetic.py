"""Arithmetic on vectors of decision diagrams equals integer arithmetic."""

import operator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.synthesis import arithmetic
from robosc.synthesis.bdd import Diagrams

NUMBERS = st.integers(-300, 300)


def diagrams():
    return Diagrams(1, 1 << 12)


@given(NUMBERS, NUMBERS)
@pytest.mark.parametrize(
    ("vectors", "integers"),
    [
        (arithmetic.add, operator.add),
        (arithmetic.subtract, operator.sub),
        (arithmetic.multiply, operator.mul),
    ],
)
def test_operations(vectors, integers, left, right):
    space = diagrams()
    result = vectors(arithmetic.constant(space, left), arithmetic.constant(space, right))
    assert arithmetic.value_of(result) == integers(left, right)


@given(NUMBERS)
def test_negation(number):
    assert arithmetic.value_of(arithmetic.negate(arithmetic.constant(diagrams(), number))) == -number


@given(NUMBERS, NUMBERS)
def test_comparisons(left, right):
    space = diagrams()
    vectors = arithmetic.constant(space, left), arithmetic.constant(space, right)
    assert arithmetic.less(*vectors).valid() == (left < right)
    assert arithmetic.equal(*vectors).valid() == (left == right)


@given(NUMBERS, NUMBERS)
def test_choice(then, otherwise):
    space = diagrams()
    condition = space.variable(0)
    chosen = arithmetic.choose(condition, arithmetic.constant(space, then), arithmetic.constant(space, otherwise))
    same = arithmetic.equal(chosen, arithmetic.constant(space, then))
    assert same == (space.true if then == otherwise else condition)
    assert arithmetic.value_of(chosen) == (then if then == otherwise else None)
