"""Print expressions of sct models for readers, and copy them."""

import pytest
from hypothesis import given

from robosc.model.reflection import tree
from robosc.model.semantics.printing import SctPrinter
from robosc.model.semantics.walks import copy_tree
from tests.random_sct import sct_models
from tests.sct_models import edge, model, needs, plant


def condition(text):
    made = model(
        [plant("P", {"a": [edge("c")], "b": []}, controllable=["c"], variables={"n": "-3..3", "f": "bool", "k": "K"})],
        [needs("c", text)],
        {"K": ["red", "green"]},
    )
    return made.requirements[0].condition


@pytest.mark.parametrize(
    ("python", "text"),
    [
        ("P.a and not P.f", "P.a and !P.f"),
        ("not (P.a or P.b)", "!(P.a or P.b)"),
        ("P.a and (P.b or P.f)", "P.a and (P.b or P.f)"),
        ("implies(P.a, P.b)", "P.a => P.b"),
        ("P.n - (P.n - 1) * -2 >= -3", "P.n - (P.n - 1) * -2 >= -3"),
        ("P.k == red", "P.k = red"),
        ("P.k != green", "P.k != green"),
        ("(P.n if P.f else 0) < 2", "(if P.f then P.n else 0) < 2"),
        ("true", "true"),
    ],
)
def test_text(python, text):
    assert SctPrinter()(condition(python)) == text


def test_what_no_sct_model_holds_has_no_text():
    with pytest.raises(TypeError, match="DoubleLiteral"):
        SctPrinter()(condition("1.5 > P.n"))


@pytest.mark.slow
@given(sct_models())
def test_a_copy_reads_the_same_and_shares_nothing(made):
    text = SctPrinter()
    for requirement in made.requirements:
        copy = copy_tree(requirement.condition)
        assert text(copy) == text(requirement.condition)
        assert not {id(element) for _, element in tree(copy)} & {
            id(element) for _, element in tree(requirement.condition)
        }
        assert copy.eContainer() is None
        assert requirement.condition.eContainer() is requirement
