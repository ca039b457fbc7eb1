"""Convert sets of codes to readable expressions and back."""

from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.model.semantics.printing import SctPrinter
from robosc.synthesis.bdd import Diagrams
from robosc.synthesis.decoding import codes, complement, cost, is_one_of
from robosc.synthesis.encoding import BitLayout, Encoding
from tests.sct_models import edge, model, plant
from tests.synthesis.oracle import Oracle, values_of

MODEL = model(
    [
        plant(
            "P",
            {f"l{index}": [edge("c")] for index in range(5)},
            controllable=["c"],
            variables={"number": "-3..4", "colour": "Colour", "flag": "bool"},
        )
    ],
    enumerations={"Colour": ["red", "green", "blue", "black", "white"]},
)
LAYOUT = BitLayout(MODEL)
DOMAINS = {domain.element.name: domain for domain in LAYOUT.state}
CHOICES = st.sampled_from(sorted(DOMAINS)).flatmap(
    lambda name: st.tuples(st.just(DOMAINS[name]), st.sets(st.integers(0, DOMAINS[name].size - 1), min_size=1))
)


def ranges_of(chosen):
    """Draw ascending ranges with gaps between them."""
    ordered = sorted(chosen)
    ends = [ordered[0], *(end for a, b in pairwise(ordered) if b > a + 1 for end in (a, b)), ordered[-1]]
    return list(zip(ends[::2], ends[1::2], strict=True))


@given(CHOICES)
def test_the_expression_is_true_for_the_codes_and_for_no_other(choice):
    domain, chosen = choice
    assume(len(chosen) < domain.size)
    expression = is_one_of(domain, ranges_of(chosen))
    oracle = Oracle(MODEL)
    element = domain.element
    values = element.locations if isinstance(element, sct.Plant) else values_of(element.type)
    for code, value in enumerate(values):
        state = list(oracle.initial)
        state[oracle.places[element]] = value
        assert oracle.value(expression, tuple(state), {}) == (code in chosen), SctPrinter()(expression)
    leaves = (sct.VariableReference, sct.LocationReference)
    assert cost(domain, ranges_of(chosen)) == sum(isinstance(part, leaves) for _, part in tree(expression))


@given(CHOICES)
def test_the_codes_of_a_diagram_are_found_again(choice):
    domain, chosen = choice
    encoding = Encoding(LAYOUT, Diagrams(LAYOUT.levels, 1 << 12))
    diagram = encoding.diagrams.false
    for code in chosen:
        diagram |= encoding.has_code(domain.element, code)
    assert codes(diagram, domain) == ranges_of(chosen)
    assert codes(~diagram, domain) == complement(ranges_of(chosen), domain.size)


@pytest.mark.parametrize(
    ("name", "chosen", "text"),
    [
        ("P", {1}, "P.l1"),
        ("P", {1, 3}, "P.l1 or P.l3"),
        ("P", {0, 1, 2, 4}, "!P.l3"),
        ("number", {0}, "P.number = -3"),
        ("number", {0, 1, 2}, "P.number <= -1"),
        ("number", {1, 2}, "P.number >= -2 and P.number <= -1"),
        ("number", {0, 1, 3, 4, 5, 6, 7}, "P.number != -1"),
        ("number", {0, 6, 7}, "P.number = -3 or P.number >= 3"),
        ("colour", {0, 1}, "P.colour = red or P.colour = green"),
        ("colour", {0, 1, 3}, "P.colour != blue and P.colour != white"),
        ("flag", {0}, "!P.flag"),
    ],
)
def test_sets_of_values_as_text(name, chosen, text):
    expression = is_one_of(DOMAINS[name], ranges_of(chosen))
    assert isinstance(expression, ex.Expression)
    assert SctPrinter()(expression) == text
