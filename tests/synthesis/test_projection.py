"""Sets of states, seen from a few elements."""

from unittest.mock import patch

from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.synthesis import projection
from robosc.synthesis.bdd import Diagrams
from robosc.synthesis.encoding import Encoding, Layout
from robosc.synthesis.fixpoint import reachable
from robosc.synthesis.projection import Projection
from robosc.synthesis.relation import event_relations
from tests.random_sct import sct_models


@given(sct_models(), st.data(), st.sampled_from([1, 64]))
@settings(max_examples=50, deadline=None)
def test_it_says_of_the_elements_what_the_states_do(model, data, widest):
    layout = Layout(model)
    encoding = Encoding(layout, Diagrams(layout.levels, 1 << 16))
    steps = [each.plant_step for each in event_relations(model, encoding) if each.plant_step is not None]
    states = reachable(encoding.diagrams, steps, encoding.initial, encoding.diagrams.true)
    elements = data.draw(st.lists(st.sampled_from(list(layout.domains)), unique=True))
    with patch.object(projection, "_WIDEST", widest):
        seen = Projection(states, encoding).onto(elements)
        factor, domains = Projection(states, encoding).factor(elements)
    assert not (states & ~seen).satisfiable()
    others = [each for each in layout.state if each.element not in elements]
    cube = encoding.diagrams.cube(level for each in others for level in each.levels)
    assert seen.exists(cube) == states.exists(cube)
    inside = {each.element for each in domains}
    assert {each for each in elements if each in encoding.initial_codes} <= inside | {
        each.element for each in layout.state if not each.levels
    }
    rest = states.exists(encoding.diagrams.cube(level for each in domains for level in each.levels))
    assert factor & rest == states
