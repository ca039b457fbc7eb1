"""Clients of the controller in simulations: by hand, by script, in the control loop, and at random."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

import pytest

import robosc
from robosc.analysis.supervise import supervise
from robosc.base.ros_types import RosTypes
from robosc.run.simulation import LoopSimulation, Simulation, read_script
from robosc.run.simulation.session import Session

MODEL = Path(__file__).parents[1] / "scenario_tests" / "visitor.rscd"
NEAR, FAR = ({"pose": {"pose": {"position": {"x": x}}}} for x in (0.5, 1.0))
#: Lines of a script, and whether their events happen.
LINES = [
    (f"request from visit with {json.dumps(NEAR)}", False),
    ("cancel from visit", False),
    (f"request from visit with {json.dumps(FAR)}", True),
    (f"request from visit with {json.dumps(FAR)}", False),
    ("request from light with true", True),
    ('request from light with {"data": false}', False),
    ("cancel from visit", True),
    ("cancel from visit", False),
]


@pytest.fixture(scope="module")
def graph() -> robosc.RosGraph:
    graph = robosc.to_rosgraph(robosc.load(str(MODEL)))
    supervise(graph.model)
    return graph


def script(graph: robosc.RosGraph, lines: list[str]) -> list[tuple[str, dict]]:
    text = "\n".join(lines)
    steps, findings = read_script("a.script", text, Simulation(graph.model, graph).engine.events, (), graph.model)
    assert findings == []
    return [(step.event, dict(step.data)) for step in steps]


def test_a_script_has_clients(graph: robosc.RosGraph) -> None:
    simulation = Simulation(graph.model, graph, RosTypes())
    for (event, data), (line, happens) in zip(script(graph, [line for line, _ in LINES]), LINES, strict=True):
        answer = simulation.perform(event, data).answer()
        assert (answer["accepted"], answer["by"]) == (happens, None if happens else "plant"), line
    rest = ["response to light", "error to visit", "canceled to visit"]
    answers = [simulation.perform(*step).answer()["accepted"] for step in script(graph, rest)]
    assert answers == [True, False, True]
    assert simulation.engine.state["component_Base"] == "home"


def test_the_control_loop_answers_them(graph: robosc.RosGraph) -> None:
    loop = LoopSimulation(graph.model, graph, types=RosTypes())
    answers = [loop.step(event, data) for event, data in script(graph, [line for line, _ in LINES])]
    assert [answer["accepted"] for answer in answers] == [happens for _, happens in LINES]
    assert loop.step("tick", {})["happened"] == ["action_visit.c_canceled", "service_light.c_response"]


def test_the_session_says_why(graph: robosc.RosGraph) -> None:
    session = Session(Simulation(graph.model, graph, RosTypes()), seed=1)
    answers = [session.do(line).splitlines()[0] for line, _ in LINES]
    assert answers == [
        "action_visit.u_request: the controller rejects the goal",
        "action_visit.u_cancel: no goal is open that a client can cancel",
        "action_visit.u_request",
        "action_visit.u_request: the controller rejects the goal",
        "service_light.u_request",
        "service_light.u_request: it waits: another request is open",
        "action_visit.u_cancel",
        "action_visit.u_cancel: no goal is open that a client can cancel",
    ]


def test_random_goals_are_accepted_ones(graph: robosc.RosGraph) -> None:
    simulation, random = Simulation(graph.model, graph, RosTypes()), Random(1)
    happened = [simulation.random_step(random) for _ in range(300)]
    assert all(step is not None and step.accepted for step in happened)
    served = {event for event in simulation.engine.events if event.startswith(("action_visit", "service_light"))}
    assert served <= {step.event for step in happened if step is not None}
