"""The independent rules object to faulty commands of the line follower."""

from __future__ import annotations

from typing import Any

import pytest

from tests.ros.line_follower_rules import HALT, MOVE, commands_in, late_moves, violations


def told(topic: str, value: Any = None) -> dict[str, Any]:
    data = {} if value is None else {"data": {"value": value}}
    return {"time": 1.0, "direction": "in", "event": f"message_{topic}.u_response", **data}


def sent(event: str, linear: float, angular: float) -> dict[str, Any]:
    return {"time": 1.0, "direction": "out", "event": event, "data": {"value": velocity(linear, angular)}}


def missed(component: str) -> dict[str, Any]:
    return {"time": 1.0, "direction": "internal", "event": f"component_{component}.u_after1"}


def velocity(linear: float, angular: float) -> dict[str, Any]:
    return {"linear": {"x": linear}, "angular": {"z": angular}}


PRESSED, RELEASED, CONTINUE = told("pressed", True), told("pressed", False), told("continue")
GOING = [RELEASED, CONTINUE]
READY = [*GOING, told("correction", 25.0), told("scan", "clear")]
GO = sent(MOVE, 0.2, -0.25)
REST = sent(HALT, 0.0, 0.0)


def test_accepts_what_the_requirements_allow() -> None:
    log = [REST, *READY, GO, PRESSED, REST, RELEASED, REST, CONTINUE, GO, told("no_line"), REST]
    assert violations(log) == []
    assert commands_in(log) == [(0.0, 0.0), (0.2, -0.25), (0.0, 0.0), (0.0, 0.0), (0.2, -0.25), (0.0, 0.0)]


@pytest.mark.parametrize(
    "log",
    [
        pytest.param([GO], id="before anything was heard"),
        pytest.param([*GOING, told("correction", 25.0), GO], id="without a scan"),
        pytest.param([*READY[2:], GO], id="before it is set going"),
        pytest.param([*READY, told("scan", "obstructed"), GO], id="with an obstacle"),
        pytest.param([*READY, PRESSED, GO], id="stopped"),
        pytest.param([*READY, PRESSED, told("scan", "clear"), GO], id="still stopped"),
        pytest.param([*READY, PRESSED, CONTINUE, GO], id="continue while the button is pressed"),
        pytest.param([*READY, PRESSED, RELEASED, GO], id="released, and no continue"),
        *(
            pytest.param([*READY, missed(name), GO], id=f"{name} waits in vain")
            for name in ("EmergencyStop", "Lidar", "LineDetector")
        ),
        pytest.param([*READY, told("no_line"), GO], id="without a line"),
        pytest.param([*READY, told("correction", 30.0), GO], id="with an old correction"),
        pytest.param([*READY, REST], id="halt without a reason"),
    ],
)
def test_objects(log: list[dict[str, Any]]) -> None:
    assert len(violations(log)) == 1


def test_objects_to_moves_long_after_they_were_forbidden() -> None:
    record = [
        {"time": 1.0, "topic": "/emergency_stop", "data": {"data": False}},
        {"time": 1.0, "topic": "/continue", "data": {}},
        {"time": 1.0, "topic": "/correction", "data": 3.0},
        {"time": 1.0, "topic": "/scan", "data": None},
        {"time": 2.0, "topic": "/cmd_vel", "data": velocity(0.2, 0.1)},
        {"time": 3.0, "topic": "/scan", "data": 0.4},
        {"time": 3.2, "topic": "/cmd_vel", "data": velocity(0.2, 0.1)},
        {"time": 4.0, "topic": "/cmd_vel", "data": velocity(0.0, 0.0)},
    ]
    assert late_moves(record, 0.5, front=0.5) == []
    record[-1]["data"] = velocity(0.2, 0.1)
    assert len(late_moves(record, 0.5, front=0.5)) == 1
