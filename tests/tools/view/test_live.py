"""A running robot on its page, by the reports of its node."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.model.semantics.definition import definition_text
from robosc.run.simulation import Simulation
from robosc.run.simulation.simulation import whole_state
from robosc.tools.view import Live
from tests.searching import examples

from .robots import GATE, Viewer, wholes

ROBOT = robosc.load(text=GATE)
MODEL, GRAPH = robosc.to_sct(ROBOT), robosc.to_rosgraph(ROBOT)
robosc.synthesize(MODEL)
OPEN, CLOSE, CAR = "message_open.c_trigger", "message_close.c_trigger", "message_car.u_response"


class Node:
    """A gate, and the reports of its node."""

    def __init__(self) -> None:
        self.simulation = Simulation(MODEL, GRAPH)
        self.time = 1_700_000_000.0
        self.pending: list[str] = []

    def perform(self, event: str, **data: Any) -> None:
        if self.simulation.perform(event, data).accepted:
            self.pending.append(event)

    def report(self) -> str:
        state = whole_state(self.simulation.engine)
        barrier = {"state": state["component_Barrier"], "variables": {"cars": state["Barrier.cars"]}}
        told = {"robot": "Gate", "time": self.time, "components": {"Barrier": barrier}, "transitions": self.pending}
        self.time, self.pending = self.time + 0.1, []
        return json.dumps(told)


def live(kept: int = 1000) -> Live:
    return Live(Simulation(MODEL, GRAPH), GRAPH, "/gate_controller", kept)


STEPS = st.lists(
    st.one_of(
        st.tuples(st.sampled_from([OPEN, CLOSE]), st.just({})),
        st.builds(lambda value: (CAR, {"value": value}), st.booleans()),
        st.just(("report", {})),
    ),
    max_size=60,
)


@pytest.mark.slow
@settings(max_examples=examples(40))
@given(STEPS, st.integers(2, 12))
def test_the_last_moment_is_what_the_engine_says(steps: list[tuple[str, Any]], kept: int) -> None:
    """This holds for early and late viewers, and for any number of stored moments."""

    async def look() -> None:
        node, shown = Node(), live(kept)
        early, happened = Viewer(shown), 0
        shown.receive_definition(definition_text(GRAPH))
        for event, data in steps:
            if event != "report":
                node.perform(event, **data)
                continue
            happened += max(1, len(node.pending))
            shown.receive_report(node.report())
            assert shown.length == happened
            assert len(shown.moments) <= kept
            late = Viewer(shown)
            for viewer in (early, late):
                await viewer.read_all()
            engine = node.simulation.engine
            for known in (shown.moments, early.moments, late.moments):
                whole = wholes(known)[-1]
                assert whole["state"] == whole_state(engine)
                assert set(whole["enabled"]) == set(node.simulation.enabled)
                assert {event: verdict is None for event, verdict in whole["commands"].items()} == {
                    event: engine.enabled(event) for event in (OPEN, CLOSE)
                }

    asyncio.run(look())


def test_times_run_while_events_tell_of_them() -> None:
    node, shown = Node(), live()
    node.perform(OPEN)
    shown.receive_report(node.report())
    node.perform(CAR, value=True)
    shown.receive_report(node.report())
    assert [moment["time"] for moment in shown.moments] == [0.0, 0.1]
    assert [moment["timers"] for moment in shown.moments] == [
        {"component_Barrier.u_after1": 2000},
        {"component_Barrier.u_after1": 1900},
    ]


def test_it_says_whom_it_waits_for() -> None:
    node, shown = Node(), live()
    assert shown.status == "Waiting for /gate_controller."
    shown.heard(1)
    shown.receive_report(node.report())
    assert shown.status == ""
    shown.heard(0)
    assert shown.status == "Waiting for /gate_controller to come back."
    shown.heard(2)
    assert "2 nodes" in shown.status


def test_a_node_of_another_model_is_named() -> None:
    node, shown = Node(), live()
    shown.heard(1)
    shown.receive_definition(definition_text(GRAPH).replace("opened", "ajar"))
    assert "another version of the model" in shown.status
    shown.receive_definition(definition_text(GRAPH))
    assert shown.status == ""
    shown.receive_report(node.report().replace("closed", "ajar"))
    assert "ajar" in shown.status
    assert shown.moments == []
    shown.receive_report(node.report())
    assert (shown.status, len(shown.moments)) == ("", 1)


@pytest.mark.slow
@given(st.text() | st.sampled_from(["null", "[", '{"time": 1e999}', "[" * 10_000, '{"robot": "\\ud800"}']))
def test_what_is_no_report_changes_nothing(text: str) -> None:
    shown = live()
    shown.receive_report(text)
    shown.receive_definition(text)
    assert shown.moments == []
    assert shown.status != "Waiting for /gate_controller."
