"""Tracking a robot by its node's reports leads to the state of the node's engine."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.engine import Engine
from robosc.model import sct
from robosc.model.semantics.edges import edges_by_event, origin
from robosc.model.semantics.roles import event_name
from robosc.run.simulation import Simulation
from robosc.run.simulation.tracker import ReportError, Tracker
from tests.searching import examples

ROOT = Path(__file__).parents[3]
MODELS = [
    ROOT / "examples" / "line_follower" / "line_follower.rscd",
    ROOT / "examples" / "simple_navigation" / "simple_navigation.rscd",
    ROOT / "tests" / "m2t" / "cpp" / "courier.rscd",
    ROOT / "tests" / "ros" / "times" / "patience.rscd",
]


@cache
def loaded(path: Path) -> tuple[sct.SupervisoryControlModel, Any]:
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return model, robosc.to_rosgraph(robot)


def reported(engine: Engine, events: list[str], time: float = 0.0) -> dict[str, Any]:
    """Return the report of a node on `~/state`."""
    components = {
        plant.origin or plant.name: {
            "state": plant.locations[engine.location(plant)].name,
            "variables": {variable.name: engine.value(variable) for variable in plant.variables},
        }
        for plant in engine.model.plants
        if plant.kind == sct.PlantKind.behaviour
    }
    return {"robot": engine.model.name, "time": time, "components": components, "transitions": events}


@pytest.mark.slow
@settings(max_examples=examples(30), deadline=None)
@given(st.sampled_from(MODELS), st.integers(0, 2**32), st.lists(st.integers(1, 6), min_size=1, max_size=12))
def test_it_is_where_the_engine_is(path: Path, seed: int, sizes: list[int]) -> None:
    model, graph = loaded(path)
    simulation, random = Simulation(model, graph), Random(seed)
    tracker = Tracker(Engine(model))
    by_event = {event_name(event): plants for event, plants in edges_by_event(model.plants).items()}
    for size in sizes:
        before = tracker.engine.state
        happened = [simulation.random_step(random) for _ in range(size)]
        events = [step.event for step in happened if step is not None]
        told = list(tracker.report(reported(simulation.engine, events)))
        assert [moment.event for moment in told] == events
        assert dict(tracker.engine.state) == dict(simulation.engine.state)
        # Each transition leads from the state before it to the state after it.
        for moment in told:
            for edge in moment.edges:
                plant = next(plant for plant, edges in by_event[moment.event or ""].items() if edge in edges)
                left = origin(edge)
                assert left is None or before.get(plant.name, left.name) == left.name
                assert edge.target is None or moment.state.get(plant.name, edge.target.name) == edge.target.name
            before = moment.state


def test_who_comes_late_knows_the_components_and_learns_the_rest() -> None:
    model, graph = loaded(MODELS[1])
    simulation, tracker, random = Simulation(model, graph), Tracker(Engine(model)), Random(3)
    for _ in range(40):
        simulation.random_step(random)
    for _ in range(60):
        happened = simulation.random_step(random)
        assert happened is not None
        list(tracker.report(reported(simulation.engine, [happened.event])))
    assert dict(tracker.engine.state) == dict(simulation.engine.state)


def test_a_node_that_starts_again_is_as_in_the_beginning() -> None:
    model, graph = loaded(MODELS[2])
    simulation, tracker, random = Simulation(model, graph), Tracker(Engine(model)), Random(1)
    first = dict(tracker.engine.state)
    for _ in range(10):
        happened = simulation.random_step(random)
        assert happened is not None
        list(tracker.report(reported(simulation.engine, [happened.event], 100.0)))
    assert dict(tracker.engine.state) != first
    tracker.begin()
    (told,) = tracker.report(reported(tracker.engine, [], 2.0))
    assert (told.event, dict(told.state)) == (None, first)


GATE = reported(Engine(loaded(MODELS[0])[0]), [])
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"robot": "Other"}, "the robot `Other`, the model is `LineFollower`"),
        ({"transitions": ["no.event"]}, "no event `no.event`"),
        ({"transitions": None}, "`transitions` is not a list"),
        ({"time": "now"}, "`time`"),
        ({"time": float("inf")}, "`time`"),
        ({"components": {}}, "has no state of `LineDetector`"),
        ({"components": {**GATE["components"], "Lidar": {"state": "none", "variables": {}}}}, "Lidar"),
    ],
)
def test_a_report_that_is_none_of_the_model_is_named(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ReportError, match=said):
        Tracker(Engine(loaded(MODELS[0])[0])).report({**GATE, **change})


@pytest.mark.slow
@given(st.dictionaries(st.sampled_from([*GATE, "other"]), JSON), JSON)
def test_whatever_is_told_changes_nothing_or_is_a_state(change: dict[str, Any], whole: Any) -> None:
    tracker = Tracker(Engine(loaded(MODELS[0])[0]))
    before = tracker.engine.state
    for report in ({**GATE, **change}, whole):
        try:
            list(tracker.report(report))
        except ReportError:
            assert tracker.engine.state == before
