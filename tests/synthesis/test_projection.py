"""Projections of sets of states onto a few elements."""

from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.synthesis import projection
from robosc.synthesis.bdd import Diagrams
from robosc.synthesis.encoding import BitLayout, Encoding
from robosc.synthesis.fixpoint import reachable
from robosc.synthesis.projection import Projection
from robosc.synthesis.relation import event_relations
from tests.random_sct import sct_models
from tests.searching import examples


@pytest.mark.slow
@given(sct_models(), st.data(), st.sampled_from([1, 64]))
@settings(max_examples=examples(25), deadline=None)
def test_it_says_of_the_elements_what_the_states_do(model, data, widest):
    layout = BitLayout(model)
    encoding = Encoding(layout, Diagrams(layout.levels, 1 << 16))
    steps = [relation.plant_step for relation in event_relations(model, encoding) if relation.plant_step is not None]
    states = reachable(encoding.diagrams, steps, encoding.initial, encoding.diagrams.true)
    elements = data.draw(st.lists(st.sampled_from(list(layout.domains)), unique=True))
    with patch.object(projection, "_WIDEST", widest):
        seen = Projection(states, encoding).onto(elements)
        factor, domains = Projection(states, encoding).factor(elements)
    assert not (states & ~seen).satisfiable()
    others = [domain for domain in layout.state if domain.element not in elements]
    cube = encoding.diagrams.cube(level for other in others for level in other.levels)
    assert seen.exists(cube) == states.exists(cube)
    inside = {domain.element for domain in domains}
    assert {element for element in elements if element in encoding.initial_codes} <= inside | {
        domain.element for domain in layout.state if not domain.levels
    }
    rest = states.exists(encoding.diagrams.cube(level for domain in domains for level in domain.levels))
    assert factor & rest == states
