"""A client of MCP writes a guard with the tools of `robosc mcp`, and drives a simulated robot over ROS 2 through it."""

from __future__ import annotations

import asyncio
import json
import os
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcp import Client, StdioServerParameters

from tests.ros.processes import PATIENCE
from tests.ros.workspaces import middleware
from tests.tools.gate.bench import CONFIGURATION, call

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.ros.running import Runner

HERE = Path(__file__).parent
#: A guard with mistakes: no marked state, and an integer in place of a double.
DRAFT = """robot Porter {
  component Person {
    outgoing message seen with identifier: "/person", type: boolean

    behaviour {
      initial state away {
        on response from seen if value goto near
      }

      state near {
        on response from seen if !value goto away
      }
    }
  }

  component Base {
    constant fastest: double = 1

    incoming message velocity with identifier: "/cmd_vel", type: geometry_msgs/Twist

    limit velocity with { linear: { x: max(-fastest, min(value.linear.x, fastest)) } }
  }

  component Lamp {
    service light with identifier: "/light", request: std_srvs/SetBool, response: std_srvs/SetBool
  }

  component Navigation {
    action go_to with identifier: "/go_to", request: nav2_msgs/NavigateToPose, response: none, feedback: none
  }

  requirement slow: velocity needs Person.away or value.linear.x <= 0.5
  requirement go_to needs Person.away
}
"""


async def write_guard(folder: Path) -> Path:
    """Write a guard: mend the draft by the findings of the tools, and verify it."""
    path = folder / "porter.rscd"
    arguments = ["-m", "robosc", "mcp", str(folder)]
    async with Client(StdioServerParameters(command=sys.executable, args=arguments, env=dict(os.environ))) as client:

        async def use(tool: str, **arguments: Any) -> dict[str, Any]:
            result = await client.call_tool(tool, {"path": path.name, **arguments})
            answer: dict[str, Any] = result.structured_content
            return answer

        checked = await use("check", text=DRAFT)
        assert {finding["rule"] for finding in checked["findings"]} == {"marked-state", "type"}
        fixed = await use("fix", text=DRAFT)
        (finding, _) = fixed["findings"]
        (edit,) = finding["alternatives"][0]["edits"]
        lines = fixed["result"]["text"].splitlines(keepends=True)
        line, column = edit["line"] - 1, edit["column"] - 1
        lines[line] = lines[line][:column] + edit["text"] + lines[line][edit["end_column"] - 1 :]
        path.write_text("".join(lines), encoding="utf-8")
        assert await use("check") == {"exit_status": 0, "error": None, "findings": [], "result": {}}
        explained = await use("explain", event="go_to", state="Person=near")
        assert [note["text"] for note in explained["result"]["requirements"]] == ["requirement go_to needs Person.away"]
        verified = await use("verify")
        assert (verified["exit_status"], verified["error"]) == (0, None)
    return path


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
    """Drive to the person, against the requirements, and away again."""
    end = time.monotonic() + PATIENCE
    while "warning" in await call(client, "Base_velocity", linear={"x": 0.0}):
        assert time.monotonic() < end, "the robot is not connected"
        await asyncio.sleep(0.2)
    home, there = ({"pose": {"pose": {"position": {"x": x}}}} for x in (0.0, 100.0))
    assert (await call(client, "Base_velocity", linear={"x": 0.75}))["verdict"] == "sent"
    state = await until(client, is_near)
    assert not state["commands"]["Navigation_go_to"]["allowed"]
    for data in ({"linear": {"x": 0.75}}, {"linear": {"x": 7.0}}):
        refused = await call(client, "Base_velocity", **data)
        assert (refused["verdict"], refused["reason"]) == ("refused", "requirement")
        assert "Person.away or value.linear.x <= 0.5" in refused["possible"][0]
    assert (await call(client, "Navigation_go_to", **home))["reason"] == "requirement"
    assert (await call(client, "Base_velocity", linear={"x": "fast"}))["reason"] == "schema"
    assert (await call(client, "Base_velocity", linear={"x": -7.0}))["verdict"] == "limited"
    await until(client, lambda state: not is_near(state))
    assert (await call(client, "Lamp_light", data=True))["response"] == {"success": True, "message": ""}
    assert (await call(client, "Navigation_go_to", **home))["verdict"] == "accepted"
    ended = await call(client, "wait", command="Navigation_go_to", seconds=60.0)
    assert ended["status"] == "succeeded"
    # On the way, the robot comes near the person: the layer cancels the goal.
    assert (await call(client, "Navigation_go_to", **there))["verdict"] == "accepted"
    ended = await call(client, "wait", command="Navigation_go_to", seconds=60.0)
    assert ended["status"] == "canceled"


def test_a_client_writes_a_guard_and_drives_a_robot_through_it(run_ros2: Runner, tmp_path: Path) -> None:
    async def script(client: Client) -> None:
        async with client:
            await drive(client)

    folder, guard = tmp_path / "run", asyncio.run(write_guard(tmp_path))
    with porter(run_ros2, folder, guard, "--config", str(CONFIGURATION)) as (client, received):
        asyncio.run(script(client))
        end = time.monotonic() + PATIENCE
        while (commands := read_lines(received))[-2:] != [["canceled", True], ["velocity", 0.0]]:
            assert time.monotonic() < end, commands
            time.sleep(0.05)
    # The first refusal stops the robot, and so does the end of the session.
    expected = [*(["velocity", x] for x in (0.75, 0.0, -1.0)), ["light", True], ["go_to", 0.0], ["go_to", 100.0]]
    assert commands[commands.index(["velocity", 0.75]) :] == [*expected, ["canceled", True], ["velocity", 0.0]]
    log = read_lines(folder / "calls.jsonl")
    verdicts = [entry["verdict"] for entry in log if entry["tool"] not in ("state", "wait")]
    others = [*["refused"] * 4, "limited", "answered", "accepted", "accepted", "released"]
    assert verdicts[verdicts.index("refused") :] == others
    assert set(verdicts[: verdicts.index("refused")]) == {"sent"}
