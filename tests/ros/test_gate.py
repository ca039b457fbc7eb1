"""A client of MCP drives a small simulated robot over ROS 2 through `robosc gate`."""

from __future__ import annotations

import asyncio
import json
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcp import Client, StdioServerParameters

from tests.ros.processes import PATIENCE
from tests.ros.workspaces import middleware
from tests.tools.gate.bench import CONFIGURATION, PORTER, call

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.ros.running import Runner

HERE = Path(__file__).parent


@contextmanager
def porter(run_ros2: Runner, folder: Path, model: Path, *options: str) -> Iterator[tuple[Client, Path]]:
    """Run the porter; yield a client of its gate, and the file with the commands that the porter receives."""
    received = folder / "received.jsonl"
    with middleware(run_ros2, folder) as processes:
        processes.start("porter", [run_ros2.ros.python, HERE / "porter_robot.py", received])
        arguments = ["-m", "robosc", "gate", str(model), "--log", str(folder / "calls.jsonl"), *options]
        parameters = StdioServerParameters(
            command=run_ros2.ros.python, args=arguments, env=processes.environment, cwd=folder
        )
        yield Client(parameters, read_timeout_seconds=PATIENCE), received


def read_lines(path: Path) -> list[Any]:
    """Return the lines of a file of JSON lines."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


async def until(client: Client, condition: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Return the state of the robot as soon as it fulfills a condition."""
    end = time.monotonic() + PATIENCE
    while not condition(state := await call(client, "state")):
        assert time.monotonic() < end, state
        await asyncio.sleep(0.2)
    return state


def is_near(state: dict[str, Any]) -> bool:
    """Return whether the gate knows that a person is near."""
    return bool(state["components"]["Person"]["state"] == "near")


async def drive(client: Client) -> None:
    """Drive to the person, past the requirements, and away again."""
    goal = {"pose": {"pose": {"position": {"x": 0.0}}}}
    assert (await call(client, "Base_velocity", linear={"x": 0.75}))["verdict"] == "sent"
    state = await until(client, is_near)
    assert not state["commands"]["Navigation_go_to"]["allowed"]
    refused = await call(client, "Base_velocity", linear={"x": 0.75})
    assert (refused["verdict"], refused["reason"]) == ("refused", "requirement")
    assert (await call(client, "Navigation_go_to", **goal))["reason"] == "requirement"
    assert (await call(client, "Base_velocity", linear={"x": float(7)}))["reason"] == "requirement", "1.0, limited"
    assert (await call(client, "Base_gear", data=9))["reason"] == "schema"
    assert (await call(client, "Base_velocity", linear={"x": -7.0}))["verdict"] == "limited"
    await until(client, lambda state: not is_near(state))
    assert (await call(client, "Lamp_light", data=True))["response"] == {"success": True, "message": ""}
    assert (await call(client, "Navigation_go_to", **goal))["verdict"] == "accepted"
    ended = await call(client, "wait", command="Navigation_go_to", seconds=60.0)
    assert ended["status"] == "succeeded"
    assert 0 <= ended["feedback"]["distance_remaining"] < 0.2
    # To the person: the requirement falls on the way, and the layer cancels the goal.
    there = {"pose": {"pose": {"position": {"x": 1.0}}}}
    assert (await call(client, "Navigation_go_to", **there))["verdict"] == "accepted"
    ended = await call(client, "wait", command="Navigation_go_to", seconds=60.0)
    assert ended["status"] == "canceled"


def test_a_client_drives_a_robot_through_the_gate(run_ros2: Runner, tmp_path: Path) -> None:
    async def script(client: Client) -> None:
        async with client:
            await drive(client)

    folder = tmp_path / "run"
    with porter(run_ros2, folder, PORTER, "--config", str(CONFIGURATION)) as (client, received):
        asyncio.run(script(client))
        end = time.monotonic() + PATIENCE
        while len(commands := read_lines(received)) < 8 and time.monotonic() < end:
            time.sleep(0.05)
    # The first refusal stops the robot, and so does the end of the session.
    driven = [["velocity", 0.75], ["velocity", 0.0], ["velocity", -1.0]]
    assert commands[:3] == driven
    assert commands[3:7] == [["light", True], ["go_to", 0.0], ["go_to", 1.0], ["canceled", True]]
    assert commands[7:] == [["velocity", 0.0]]
    log = read_lines(folder / "calls.jsonl")
    verdicts = [entry["verdict"] for entry in log if entry["tool"] not in ("state", "wait")]
    assert verdicts == ["sent", *["refused"] * 4, "limited", "answered", "accepted", "accepted", "released"]
