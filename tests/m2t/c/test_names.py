from keyword import iskeyword

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.m2t.c.names import KEYWORDS, CNames
from robosc.model import sct
from tests.m2t.supervisor import corners
from tests.sct_models import model, plant
from tests.searching import examples

_words = st.sampled_from(["a", "b", "a_b", "b_a", "a_b_a", "int", "event", "name", "state", "bool", "class", "_", "b_"])


def _all(names: CNames, made: sct.SupervisoryControlModel) -> tuple[list[str], list[str], list[str]]:
    """Return the names at file level, of the state's members and of the inputs' members."""
    enumerators = [
        names.enumerator(element) for owner in made.plants for element in (*owner.events, *owner.locations)
    ] + [names.enumerator(literal) for owner in made.enumerations for literal in owner.literals]
    functions = [names.lookup(element) for element in (*made.plants, *made.enumerations)]
    members = [names.member(element) for owner in made.plants for element in (owner, *owner.variables)]
    return enumerators + functions, members, [names.member(input_) for owner in made.plants for input_ in owner.inputs]


@settings(max_examples=examples(30))
@given(
    st.lists(_words, unique=True, min_size=1, max_size=5),
    st.lists(_words, unique=True, max_size=4),
    st.lists(_words, unique=True, min_size=1, max_size=4),
)
def test_names_are_one_to_one_and_no_keywords(plants: list[str], inner: list[str], locations: list[str]) -> None:
    made = model(
        [
            plant(
                plant_name,
                {location: [] for location in locations},
                controllable=inner,
                variables=dict.fromkeys(inner, "bool"),
                inputs=dict.fromkeys(inner, "bool"),
            )
            for plant_name in plants
        ],
        enumerations={plant_name: [f"l{number}" for number in range(2)] for plant_name in plants},
        name="A",
    )
    names = CNames(made)
    for scope in _all(names, made):
        assert len(set(scope)) == len(scope)
        assert not set(scope) & KEYWORDS
        assert all(identifier.isascii() and identifier.isidentifier() for identifier in scope)
    own = {f"a_{word}" for word in ("event", "state", "init", "perform", "event_name", "supervisor")}
    assert not set(_all(names, made)[0]) & own


def test_names_are_what_the_model_says_where_nothing_clashes() -> None:
    made = corners.swap()
    names = CNames(made)
    a = made.plants[0]
    assert names.prefix == "swap"
    assert names.macro == "SWAP"
    assert names.enumerator(a.events[0]) == "swap_a_u_response"
    assert names.enumerator(a.locations[1]) == "swap_a_y"
    assert [names.member(element) for element in (a, a.variables[0])] == ["a", "a_v"]
    assert names.lookup(a) == "swap_location_name_a"


@pytest.mark.parametrize(
    ("robot", "prefix"),
    [("LineFollower", "line_follower"), ("_Hidden_", "hidden"), ("__", "robot"), ("2go", "robot_2go"), ("Ü", "u00fc")],
)
def test_the_prefix_is_an_identifier(robot: str, prefix: str) -> None:
    assert CNames(model([plant("p", {"x": []})], name=robot)).prefix == prefix
    assert not iskeyword(prefix)
