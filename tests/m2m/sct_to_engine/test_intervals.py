"""Intervals known before the robot runs contain the actual values."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.m2m.sct_to_engine import lowering
from robosc.m2m.sct_to_engine.terms import Terms
from robosc.m2t.c.expressions import number, type_name
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.reflection import tree
from robosc.model.semantics.domains import Interval, Width, storage, working_width
from tests.m2m.sct_to_engine import oracle
from tests.random_sct import sct_models
from tests.sct_models import edge, model, plant
from tests.searching import examples


@pytest.mark.slow
@settings(max_examples=examples(30), deadline=None, suppress_health_check=list(HealthCheck))
@given(sct_models(), st.randoms(use_true_random=False))
def test_values_stay_in_their_interval_and_depend_on_what_is_read_only(made, random) -> None:
    lower = lowering(made)
    expressions = [
        element
        for _, element in tree(made)
        if isinstance(element, ex.Expression) and not isinstance(element.eContainer(), sct.DiscreteVariable)
    ]
    variables = [variable for owner in made.plants for variable in owner.variables]
    inputs = [declared for owner in made.plants for declared in owner.inputs]
    seen: dict[object, object] = {}
    for _ in range(8):
        state: oracle.State = {owner: random.choice(list(owner.locations)) for owner in made.plants}
        state |= {variable: _drawn(variable.type, random) for variable in variables}
        given = {declared: _drawn(declared.type, random) for declared in inputs}
        for expression in expressions:
            term, value = lower(expression), oracle.value(expression, state, given)
            assert term.values.low <= _number(value) <= term.values.high
            read = term.reads()
            cells = tuple((state | given)[_origin(declared)] for declared in read)
            assert seen.setdefault((expression, cells), value) == value


def _origin(declared: engine.Declaration) -> object:
    if isinstance(declared, engine.Input):
        return declared.input
    return declared.variable or declared.plant


def _drawn(kind: ex.Type, random) -> object:
    match kind:
        case ex.BooleanType():
            return random.random() < 0.5
        case ex.EnumerationType():
            return random.choice(list(kind.enumeration.literals))
    return random.randint(kind.minimum, kind.maximum)


def _number(value: object) -> int:
    if isinstance(value, ex.EnumerationLiteral):
        return list(value.eContainer().literals).index(value)
    return int(value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("n >= 0", 1),
        ("n > 9", 0),
        ("n < 3 and n > 5", 0),
        ("n < 7 or n > 5", 1),
        ("here and there", 0),
        ("here or there", None),
        ("here or there or far", 1),
        ("not here and not there and not far", 0),
        ("implies(here, not there)", 1),
        ("implies(here, there)", None),
        ("n == n", 1),
        ("n + 1 != 1 + n", 0),
        ("(n if b else n) < n", 0),
        ("b and (n < 3 and (b or n > 5))", None),
        ("q.only", 1),
        ("b == true", None),
        ("b != (b and true)", 0),
        ("(b or b) != b", 0),
        ("n > 2 or n > 2 or b", None),
        ("n > 2 and not (n > 5 or (here and there))", None),
        ("here and not (there or (n > 5 and n < 3))", None),
    ],
)
def test_what_is_decided(text: str, value: int | None) -> None:
    p = plant(
        "p",
        {"here": [edge("u_response", when=text)], "there": [], "far": []},
        uncontrollable=["u_response"],
        variables={"n": "0..9", "b": "bool"},
    )
    made = model([p, plant("q", {"only": []})])
    assert lowering(made)(made.plants[0].locations[0].edges[0].guard).constant == value


def test_a_choice_of_two_literals_is_never_a_third() -> None:
    terms = Terms()
    owner = ex.Enumeration(name="e", literals=[ex.EnumerationLiteral(name=name) for name in ("e0", "e1", "e2")])
    first, second, third = (terms.constant(owner, position) for position in range(3))
    condition = terms.reference(engine.StateVariable(name="b", type=ex.BooleanType(), maximum=1))
    choice = terms.operation(ex.Conditional, condition, first, second)
    assert terms.operation(ex.Inequation, choice, third) is terms.true
    assert terms.operation(ex.Inequation, choice, second).constant is None


@pytest.mark.parametrize(
    ("low", "high", "width"),
    [
        (0, 255, (8, False)),
        (-1, 127, (8, True)),
        (-1, 128, (16, True)),
        (0, 256, (16, True)),
        (0, 65535, (16, False)),
        (-32769, 0, (32, True)),
        (0, 2**32 - 1, (32, False)),
        (-1, 2**32 - 1, (64, True)),
        (-(2**63), 2**63 - 1, (64, True)),
    ],
)
def test_the_smallest_storage(low: int, high: int, width: tuple[int, bool]) -> None:
    assert storage(Interval(low, high)) == width
    name = f"{'' if width[1] else 'u'}int{width[0]}_t"
    assert type_name(ex.IntegerType(minimum=low, maximum=high)) == name


def test_no_storage_is_wider_than_64_bits() -> None:
    with pytest.raises(OverflowError):
        storage(Interval(0, 2**63))
    assert working_width(Interval(0, 2**63)) == Width(128, signed=True)
    assert number(-(2**63)) == "(-9223372036854775807 - 1)"


@pytest.mark.parametrize("last", [2**31, 2**32, 2**62, 2**63 - 2, 2**63 - 1])
def test_as_many_values_as_64_bits_have(last) -> None:
    """`len` of a range is limited to 2^63 - 1 values."""
    p = plant(
        "p",
        {"here": [edge("u_response", when="n > 3 and n < 5")]},
        uncontrollable=["u_response"],
        variables={"n": f"-1..{last}"},
    )
    made = model([p])
    assert lowering(made)(made.plants[0].locations[0].edges[0].guard).values == Interval(0, 1)
