"""Data in scripts that a node could not read: its event does not happen."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import Session
from robosc.run.simulation.unreadable import past_end
from robosc.tools.cli import main

MISSION = Path(__file__).parents[2] / "run" / "runtime" / "mission.rscd"
ROUTE = "message_route.u_response"


def play(*lines: str, loop: bool = False) -> list[dict[str, Any]]:
    options = ["--script", "-", *(["--loop"] if loop else [])]
    done = CliRunner().invoke(main, ["simulate", str(MISSION), *options], input="\n".join(lines))
    assert done.exit_code == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def poses(*tags: int) -> str:
    return json.dumps({"value": {"poses": [{"x": 1.0, "tags": [5] * count} for count in tags]}})


def test_an_event_whose_data_is_too_short_does_not_happen() -> None:
    answers = play(
        "message_record.u_response",
        f"{ROUTE} {poses(2)}",
        f"{ROUTE} {poses(1, 1, 1)}",
        f"{ROUTE} {poses(2, 0, 0)}",
    )
    assert [answer["by"] for answer in answers] == [None, "data", "data", None]
    assert [answer["state"]["component_Recorder"] for answer in answers] == ["empty", "empty", "empty", "filled"]


def test_only_what_the_present_state_reads_has_to_be_there() -> None:
    assert [answer["by"] for answer in play("message_toggle.u_response", f"{ROUTE} {poses()}")] == [None, None]


def test_of_what_is_left_out_nothing_is_known() -> None:
    texts = ("", '{"value": {"name": "only"}}', '{"value": {"poses": {"2": {"x": 1.0}}}}')
    assert [answer["accepted"] for answer in play(*(f"{ROUTE} {text}" for text in texts))] == [True, True, True]
    assert play('%s {"value": {"poses": {"1": {"x": 1.0}}}}' % ROUTE)[0]["by"] == "data"  # noqa: UP031


def test_the_loop_takes_an_answer_that_is_too_short_for_an_error() -> None:
    *_, answer = play("tick", 'service_plan.u_response {"value": {"cost": 1.0, "stops": []}}', loop=True)
    assert (answer["accepted"], answer["by"]) == (False, "data")
    assert answer["happened"][0] == "service_plan.u_error"
    *_, answer = play("tick", f"{ROUTE} {poses()}", loop=True)
    assert (answer["by"], answer["happened"]) == ("data", [])


def test_by_hand_it_is_said_why() -> None:
    robot = robosc.load(MISSION)
    robosc.synthesize(robosc.to_sct(robot))
    graph = robosc.to_rosgraph(robot)
    session = Session(Simulation(graph.model, graph), seed=0)
    told = session.do(f"{ROUTE} {poses()}")
    assert told == f"{ROUTE}: there is no element 2 in an array of 0, so it counts as not received"
    session.do("service_plan.c_trigger")
    told = session.do('service_plan.u_response {"value": {"cost": 1.0, "stops": []}}')
    assert told.endswith("so it counts as service_plan.u_error")


def _read(*path: str | int, kind: ex.Type | None = None) -> rosgraph.WireAccess:
    steps = [
        rosgraph.IndexStep(index=step) if isinstance(step, int) else rosgraph.FieldStep(name=step) for step in path
    ]
    return rosgraph.WireAccess(steps=steps, type=kind or ex.DoubleType())


@pytest.mark.parametrize(
    ("operator", "few", "lacks"),
    [(ex.Conjunction, 1, False), (ex.Conjunction, 3, True), (ex.Disjunction, 1, True), (ex.Implication, 1, False)],
)
def test_operators_read_no_further_than_needed(operator: type[ex.BinaryExpression], few: int, lacks: bool) -> None:
    many = ex.GreaterThan(left=_read("count", kind=ex.IntegerType()), right=ex.IntegerLiteral(value=2))
    element = ex.GreaterThan(left=_read("ranges", 2), right=ex.DoubleLiteral(value=0.5))
    fault = past_end([operator(left=many, right=element)], {"count": few, "ranges": [1.0]})
    assert (fault is not None) is lacks
    # If it is unknown whether the data is readable, no fault is reported.
    assert past_end([operator(left=many, right=element)], {"ranges": [1.0]}) is None
