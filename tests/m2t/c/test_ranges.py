"""What is known about values before the robot runs, against what they are."""

from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.engine.expressions import Compiler
from robosc.m2t.c.nodes import All, Not, Some, children_of
from robosc.m2t.c.ranges import Ranges
from robosc.m2t.c.types import number, storage
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import Interval, domain
from robosc.semantics.edges import edges_from
from tests.random_sct import sct_models
from tests.sct_models import edge, model, plant


def _expressions(made: sct.SupervisoryControlModel) -> Iterator[ex.Expression]:
    roots = [each.condition for each in made.requirements]
    for owner in made.plants:
        for location in owner.locations:
            for each in edges_from(location):
                roots += [each.guard] if each.guard is not None else []
                roots += [update.value for update in each.updates]
    while roots:
        yield (expression := roots.pop())
        roots += children_of(expression)


@pytest.mark.slow
@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(sct_models(), st.randoms(use_true_random=False))
def test_values_stay_in_their_interval_and_depend_on_their_cells_only(made, random) -> None:
    plants = list(made.plants)
    cells = [*plants, *(each for owner in plants for each in owner.variables)]
    inputs = [each for owner in plants for each in owner.inputs]
    position = {each: at for at, each in enumerate(cells)}
    compiled = Compiler(position, {each: at for at, each in enumerate(inputs)})
    domains = {
        each: Interval(0, len(each.locations) - 1) if isinstance(each, sct.Plant) else domain(each.type)
        for each in (*cells, *inputs)
    }
    ranges = Ranges()
    for expression in _expressions(made):
        function, values, read = compiled(expression), ranges(expression), ranges.cells(expression)
        seen: dict[tuple[int, ...], int] = {}
        for _ in range(8):
            drawn = {each: random.randint(*domains[each]) for each in (*cells, *inputs)}
            value = int(function([drawn[each] for each in cells], [drawn[each] for each in inputs]))
            assert values.low <= value <= values.high
            key = tuple(drawn[each] for each in drawn if each in read)
            assert seen.setdefault(key, value) == value


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
    assert Ranges()(made.plants[0].locations[0].edges[0].guard).single == value


def test_put_together_conditions_are_decided_too() -> None:
    made = model([plant("p", {"here": [], "there": []})])
    here, there = (sct.LocationReference(location=each) for each in made.plants[0].locations)
    ranges = Ranges()
    assert ranges(All([])).single == 1
    assert ranges(Some([])).single == 0
    assert ranges(All([here, there])).single == 0
    assert ranges(Some([Not(here), Not(there)])).single == 1
    assert ranges(All([here, Some([there, here])])).single is None


@pytest.mark.parametrize(
    ("low", "high", "name"),
    [
        (0, 255, "uint8_t"),
        (-1, 127, "int8_t"),
        (-1, 128, "int16_t"),
        (0, 256, "int16_t"),
        (0, 65535, "uint16_t"),
        (-32769, 0, "int32_t"),
        (0, 2**32 - 1, "uint32_t"),
        (-1, 2**32 - 1, "int64_t"),
        (-(2**63), 2**63 - 1, "int64_t"),
    ],
)
def test_the_smallest_type(low: int, high: int, name: str) -> None:
    assert storage(Interval(low, high)) == name


def test_no_type_is_wider_than_64_bits() -> None:
    with pytest.raises(OverflowError):
        storage(Interval(0, 2**63))
    assert number(-(2**63)) == "(-9223372036854775807 - 1)"


@pytest.mark.parametrize("last", [2**31, 2**32, 2**62, 2**63 - 2, 2**63 - 1])
def test_as_many_values_as_64_bits_have(last) -> None:
    """`len` of a range ends at 2^63 - 1 values."""
    kind = ex.IntegerType(minimum=-1, maximum=last)
    variable = sct.DiscreteVariable(name="v", type=kind, initial=ex.IntegerLiteral(value=0))

    def compared(operator: type[ex.BinaryExpression], value: int) -> ex.Expression:
        return operator(left=sct.VariableReference(variable=variable), right=ex.IntegerLiteral(value=value))

    node = All([compared(ex.GreaterThan, 3), compared(ex.LessThan, 5)])
    assert Ranges()(node) == Interval(0, 1)
