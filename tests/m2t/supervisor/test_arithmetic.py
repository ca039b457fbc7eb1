"""Computations over wide ranges, under sanitizers: models that meet the preconditions never overflow."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.engine import Settings
from robosc.m2t.c.preconditions import preconditions
from robosc.model import sct
from robosc.model.places import Place
from tests.m2t.supervisor.driver import build, run
from tests.m2t.supervisor.walk import Walk
from tests.sct_models import edge, model, plant

_RANGES = {
    "a": "0..255 = 255",
    "b": "-128..127 = -128",
    "c": "0..65535 = 65535",
    "d": "-32768..32767 = -32768",
    "e": f"0..{2**32 - 1} = {2**32 - 1}",
    "f": f"{-(2**31)}..{2**31 - 1} = {-(2**31)}",
    "g": f"{-(2**63)}..{2**63 - 1} = {-(2**63 - 1)}",
    "h": "-3..-1",
    "i": f"{2**40}..{2**41}",
}
_leaves = st.one_of(
    st.sampled_from([*_RANGES, "x.n"]), st.integers(-(2**33), 2**33).map(str), st.integers(-3, 3).map(str)
)
_numbers = st.recursive(
    _leaves,
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*"), inner),
        st.builds("(-{})".format, inner),
        st.builds("({} if {} < {} else {})".format, inner, inner, inner, inner),
    ),
    max_leaves=6,
)


def _model(values: list[tuple[str, str]]) -> sct.SupervisoryControlModel:
    events = [f"u_response{number}" for number, _ in enumerate(values)]
    steps = [edge(event, do={name: value}) for event, (name, value) in zip(events, values, strict=True)]
    x = plant("x", {"only": []}, inputs={"n": "-70000..70000"})
    p = plant("p", {"only": steps}, uncontrollable=events, variables=_RANGES)
    made = model([x, p], guards={})
    for number, step in enumerate(made.plants[1].locations[0].edges, 1):
        step.event.inputs.append(made.plants[0].inputs[0])
        step.updates[0].source = Place.parse(f"{number}:1-{number}:2")
    refused = {precondition.span.line for precondition in preconditions(made)}
    for number, step in enumerate(made.plants[1].locations[0].edges, 1):
        if number in refused:
            step.updates.clear()
    return made


@pytest.mark.slow
@settings(max_examples=3, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.sampled_from(list(_RANGES)), _numbers), min_size=60, max_size=60), st.integers(0, 99))
def test_arithmetic(values: list[tuple[str, str]], seed: int) -> None:
    made = _model(values)
    assert sum(len(made_edge.updates) for made_edge in made.plants[1].locations[0].edges) > 30
    walk = Walk(made, Settings(), seed)
    for _ in range(400):
        walk.perform()
    with tempfile.TemporaryDirectory() as folder:
        said = run(build(made, Path(folder)), walk.script)
    assert said == walk.said
