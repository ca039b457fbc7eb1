"""A tabulated comparison holds exactly where the comparison of doubles does."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.m2m.tabulation import TooLargeError, tabulate
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cone_of_influence import LARGEST_TABLE
from robosc.model.semantics.evaluation import evaluate

VARIABLES = [sct.DiscreteVariable(name=name) for name in ("x", "y")]
COMPARISONS = [ex.Equation, ex.Inequation, ex.LessThan, ex.LessOrEqual, ex.GreaterThan, ex.GreaterOrEqual]


def reference(index):
    return sct.VariableReference(variable=VARIABLES[index])


def operands():
    leaves = st.one_of(
        st.sampled_from([0, 1]).map(reference),
        st.integers(0, 4).map(lambda value: ex.IntegerLiteral(value=value)),
        st.sampled_from([0.0, 0.5, 2.5]).map(lambda value: ex.DoubleLiteral(value=value)),
    )
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            inner.map(lambda operand: ex.UnaryMinus(operand=operand)),
            st.tuples(st.sampled_from([ex.Addition, ex.Subtraction, ex.Multiplication, ex.Division]), inner, inner).map(
                lambda parts: parts[0](left=parts[1], right=parts[2])
            ),
        ),
        max_leaves=6,
    )


@given(st.sampled_from(COMPARISONS), operands(), operands(), st.integers(-3, 0), st.integers(0, 3))
def test_equal_for_every_value(kind, left, right, low, high):
    comparison = kind(left=left, right=right)
    whole = range(low, high + 1)
    for variable in VARIABLES:
        variable.type = ex.IntegerType(minimum=low, maximum=high)
    table = tabulate(comparison)
    for values in product(whole, whole):
        valuation = dict(zip(VARIABLES, values, strict=True))
        read = lambda referred: valuation[referred.variable]  # noqa: B023, E731 - used at once
        assert evaluate(table, read) == evaluate(comparison, read)


def test_too_many_valuations_are_refused():
    VARIABLES[0].type = ex.IntegerType(minimum=0, maximum=LARGEST_TABLE)
    comparison = ex.GreaterThan(left=reference(0), right=ex.DoubleLiteral(value=0.5))
    with pytest.raises(TooLargeError):
        tabulate(comparison)
