import re
from keyword import kwlist

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.base.files.resources import locate
from robosc.model import sct
from robosc.model.semantics.naming import (
    ROBOSC_KEYWORDS,
    Names,
    below_layer,
    controller_name,
    escape,
    escape_keyword,
    snake_case,
)

KEYWORDS = [*kwlist, "if__", "_", "x_y"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("LineFollowerController", "line_follower_controller"),
        ("lineFollower", "line_follower"),
        ("HTTPServer", "http_server"),
        ("Robot2Go", "robot2_go"),
        ("already_snake", "already_snake"),
        ("Mixed_Case", "mixed_case"),
        ("AB", "ab"),
        ("_Hidden", "_hidden"),
    ],
)
def test_snake_case(name: str, expected: str) -> None:
    assert snake_case(name) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("LineFollower", "line_follower_controller"),
        ("LineFollowerController", "line_follower_controller"),
        ("Controller", "controller"),
        ("Subcontroller", "subcontroller_controller"),
    ],
)
def test_controller_name(name: str, expected: str) -> None:
    assert controller_name(sct.SupervisoryControlModel(name=name)) == expected


def test_escape_leaves_other_names_alone() -> None:
    assert escape("iffy", KEYWORDS) == "iffy"
    assert escape("trailing_", KEYWORDS) == "trailing_"


@given(st.lists(st.sampled_from(["if", "x_y", "", "plain"]), min_size=2), st.lists(st.integers(0, 5), min_size=2))
def test_escape_is_one_to_one_and_gives_no_keyword(stems: list[str], underscores: list[int]) -> None:
    names = {stem + "_" * count for stem in stems for count in underscores}
    escaped = [escape(name, KEYWORDS) for name in sorted(names)]
    assert len(set(escaped)) == len(names)
    assert not set(escaped) & set(KEYWORDS)


@given(st.lists(st.text("ab_", max_size=4)))
def test_fresh_names_differ(names: list[str]) -> None:
    scope = Names(["a", "b_"])
    given_out = [scope.fresh(name) for name in names]
    assert len(set(given_out)) == len(names)
    assert not set(given_out) & {"a", "b_"}
    assert all(out.startswith(name) for name, out in zip(names, given_out, strict=True))


def test_the_keywords_are_the_grammars() -> None:
    grammar = locate("grammar/robosc.tx").read_text(encoding="utf-8")
    reserved = re.search(r"UnreservedName:\s*/\(\?!\(\?:([a-z|]+)\)", grammar)
    assert reserved
    assert set(reserved[1].split("|")) == ROBOSC_KEYWORDS


def test_a_name_is_written_so_that_it_is_no_keyword() -> None:
    assert escape_keyword("state") == "^state"
    assert escape_keyword("states") == "states"


def test_names_for_the_controller_are_below_the_layers_own() -> None:
    assert below_layer("/lamp/light") == "controller/lamp/light"
    assert below_layer("battery") == "controller/battery"
