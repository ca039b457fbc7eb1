"""The transformation uses only features of CIF and does not change its input model."""

from collections.abc import Iterator

import pytest
from hypothesis import given, settings

from robosc.base.cache import cache_results
from robosc.m2m.sct_to_cif import transform
from robosc.m2m.sct_to_cif.lower_arithmetic import Lowering
from robosc.model import expression as ex
from robosc.model import sct, xmi
from robosc.model.reflection import tree
from robosc.model.semantics.walks import parts
from robosc.synthesis import synthesize
from tests.random_sct import sct_models
from tests.sct_models import edge, model, needs, plant
from tests.searching import examples

LACKING = (ex.Multiplication, ex.Division, ex.Subtraction, ex.UnaryMinus, ex.FunctionCall)


def expressions(made: sct.SupervisoryControlModel) -> Iterator[ex.Expression]:
    """Return the outermost expressions; for an assigned subtraction, its two operands."""
    for _, element in tree(made):
        if isinstance(element, ex.Expression) and not isinstance(element.eContainer(), ex.Expression):
            assigned = isinstance(element.eContainer(), sct.Update) and isinstance(element, ex.Subtraction)
            yield from (element.left, element.right) if assigned else (element,)


@pytest.mark.slow
@settings(max_examples=examples(40), deadline=None)
@given(given=sct_models(requirements=True))
def test_only_what_cif_has_is_left(given: sct.SupervisoryControlModel) -> None:
    given.supervisor = synthesize(given).supervisor
    before = xmi.to_texts({"given": given})
    made = transform(given).model
    assert xmi.to_texts({"given": given}) == before
    xmi.to_texts({"made": made})  # It has no references to other models.
    for _, element in tree(made):
        assert not isinstance(element, ex.IntegerType) or element.minimum >= 0
    for expression in expressions(made):
        for part in parts(expression):
            assert not isinstance(part, LACKING)
            assert not isinstance(part, ex.IntegerLiteral) or part.value >= 0


def test_a_variable_takes_the_place_of_locations_where_data_is_chosen() -> None:
    chosen = [edge("c_d1", "d1"), edge("c_never", "d2", when="False"), edge("c_none", "none")]
    given = model(
        [
            plant("sent", {"ready": [edge("c_trigger")]}, kind="message", controllable=["c_trigger"]),
            plant(
                "data",
                dict.fromkeys(["none", "d1", "d2"], ()),
                everywhere=chosen,
                controllable=[step.event for step in chosen],
                kind="data",
                marked=["none", "d1", "d2"],
            ),
        ],
        [needs("sent.c_trigger", "data.d2")],
    )
    made, originals = transform(given)
    sent, data = made.plants
    [variable], [location] = data.variables, data.locations
    assert (variable.type.minimum, variable.type.maximum, variable.initial.value) == (0, 2, 0)
    assert (location.name, location.initial, location.marked) == ("", True, True)
    assert [event.name for event in data.events] == ["c_d1", "c_none"]
    assert [[update.value.value for update in step.updates] for step in data.edges] == [[1], [0]]
    condition = made.requirements[0].condition
    assert isinstance(condition, ex.Equation)
    assert (condition.left.variable, condition.right.value) == (variable, 2)
    assert variable not in originals
    assert originals[data.events[0]] is given.plants[1].events[0]
    assert sent.locations[0].name == ""


def test_a_model_is_lowered_once() -> None:
    given = model([plant("p", {"l": [edge("e")]}, controllable=["e"])])
    with cache_results():
        assert transform(given) is transform(given)


def test_a_function_without_a_lowering_has_an_error_of_its_own() -> None:
    root = ex.FunctionCall(function="sqrt", arguments=[ex.IntegerLiteral(value=4)])
    below = ex.LessThan(left=root, right=ex.IntegerLiteral(value=3))
    with pytest.raises(ValueError, match="no lowering for `sqrt`"):
        Lowering({}, {}).condition(below)
