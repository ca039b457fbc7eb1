"""Calls of the tools of a gate by a client of the public library; the robot is played without ROS."""

from __future__ import annotations

import asyncio
import json
import threading
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from robosc.tools.gate import gate as gate_module
from robosc.tools.gate.commands import UnknownTypeError, commands, tool_name
from robosc.tools.gate.dry import DryNode
from robosc.tools.gate.shapes import Messages, faults_of
from tests.tools.gate.bench import PORTER, call, connect, gate, models

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from mcp import Client

    from tests.tools.gate.bench import Bench

#: Data with faults, for a tool.
HOSTILE: list[tuple[str, Any, str]] = [
    ("Base_velocity", {"linear": {"x": "fast"}}, "schema"),
    ("Base_velocity", {"linear": {"x": True}}, "schema"),
    ("Base_velocity", {"linear": {"x": None}}, "schema"),
    ("Base_velocity", {"linear": {"x": [0.1]}}, "schema"),
    ("Base_velocity", {"linear": {"x": float("nan")}}, "schema"),
    ("Base_velocity", {"linear": {"x": float("inf")}}, "schema"),
    ("Base_velocity", {"linear": {"x": -(10**400)}}, "schema"),
    ("Base_velocity", {"linear": {"y": 0.1}}, "schema"),
    ("Base_velocity", {"linear": 3}, "schema"),
    ("Base_velocity", {"__class__": {}}, "schema"),
    ("Base_velocity", {"linear": {"x": 0.1}, "stamp": 0}, "schema"),
    ("Base_gear", {"data": 6}, "schema"),
    ("Base_gear", {"data": -1}, "schema"),
    ("Base_gear", {"data": 2.5}, "schema"),
    ("Base_gear", {"data": 10**30}, "schema"),
    ("Base_gear", {"data": float("nan")}, "schema"),
    ("Base_gear", {"data": float("-inf")}, "schema"),
    ("Base_text", {"data": "a\0b"}, "schema"),
    ("Base_text", {"data": "\ud800"}, "schema"),
    ("Base_text", {"data": "x" * 70_000}, "size"),
    ("Base_horn", {"data": 1}, "schema"),
    ("Lamp_light", {"data": 1}, "schema"),
    ("Navigation_go_to", {"pose": {"header": {"frame_id": "map"}}}, "schema"),
    ("Navigation_go_to", {"pose": {"pose": {"position": {"x": 1e400}}}}, "schema"),
    ("why", {"command": "Base_drive"}, "schema"),
    ("why", {}, "schema"),
    ("wait", {"command": "Navigation_go_to", "seconds": 1e9}, "schema"),
    ("state", {"of": "Base"}, "schema"),
    ("cmd_vel", {"linear": {"x": 1.0}}, "unknown"),
    ("../Base_velocity", {}, "unknown"),
    ("", {}, "unknown"),
]


def run(folder: Path, script: Callable[[Client, Bench], Awaitable[None]], **limits: float) -> None:
    """Run a script of a client."""

    async def connected(bench: Bench) -> None:
        async with connect(bench) as client:
            await script(client, bench)

    with gate(folder, **limits) as bench:
        asyncio.run(connected(bench))


def test_each_command_is_a_tool_with_its_data(tmp_path: Path) -> None:
    async def script(client: Client, _: Bench) -> None:
        tools = {tool.name: tool for tool in (await client.list_tools()).tools}
        commands = ["Base_velocity", "Base_gear", "Base_horn", "Base_text", "Lamp_light", "Navigation_go_to"]
        assert list(tools) == [*commands, "state", "why", "wait", "cancel", "release", "robot"]
        reading = [name for name, tool in tools.items() if tool.annotations and tool.annotations.read_only_hint]
        assert reading == ["state", "why", "wait"]
        for tool in tools.values():
            Draft202012Validator.check_schema(tool.input_schema)
        velocity = tools["Base_velocity"]
        linear = velocity.input_schema["properties"]["linear"]["properties"]
        assert linear == {"x": {"type": "number", "description": "In m/s. Positive is forward."}}
        for text in (
            "Drive until the next velocity.",
            "slow near people",
            "limit velocity with",
            "geometry_msgs/Twist",
        ):
            assert text in (velocity.description or "")
        gear = tools["Base_gear"].input_schema["properties"]
        assert gear == {"data": {"type": "integer", "minimum": 0, "maximum": 5}}
        assert tools["Base_horn"].input_schema["properties"] == {}

    run(tmp_path, script)


def test_a_message_is_sent_limited_or_refused(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        assert await call(client, "Base_velocity", linear={"x": 0.75}) == {"verdict": "sent"}
        limited = await call(client, "Base_velocity", linear={"x": 7}, angular={"z": 0.5})
        assert limited["verdict"] == "limited"
        assert (limited["sent"]["linear"]["x"], limited["sent"]["angular"]["z"]) == (1.0, 0.5)
        assert [data["linear"]["x"] for _, data in bench.received()] == [0.75, 1.0]
        await call(client, "robot", event="Person.seen", data={"data": True})
        refused = await call(client, "Base_velocity", linear={"x": 0.75})
        text = 'requirement slow "slow near people": velocity needs Person.away or value.linear.x <= 0.5'
        assert (refused["verdict"], refused["reason"], refused["because"]) == ("refused", "requirement", [text])
        assert refused["possible"] == [f"Send data that fulfills: {text}"]
        # The robot stops, and slow commands pass.
        assert [data["linear"]["x"] for _, data in bench.received()] == [0.75, 1.0, 0.0]
        assert await call(client, "Base_velocity", linear={"x": 0.25}) == {"verdict": "sent"}

    run(tmp_path, script)


def test_a_gate_that_has_stopped_sends_nothing(tmp_path: Path) -> None:
    """It waits for the end of goals that it cancels, and nothing would stop a later command."""

    async def script(client: Client, bench: Bench) -> None:
        await call(client, "Base_velocity", linear={"x": 0.75})
        await bench.gate._on_node(bench.layer.stop)
        stopped = bench.received()
        assert stopped[-1][1]["linear"]["x"] == 0.0
        for tool in ("Base_velocity", "Base_horn", "Lamp_light", "Navigation_go_to"):
            late = await call(client, tool)
            assert (late["verdict"], late["because"]) == ("failed", ["the gate is ending"])
        assert bench.received() == stopped

    run(tmp_path, script)


def test_a_message_that_nobody_receives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def script(client: Client, bench: Bench) -> None:
        monkeypatch.setattr(bench.node, "receivers", lambda _: 0)
        answer = await call(client, "Base_velocity", linear={"x": 7})
        assert (answer["verdict"], answer["warning"]) == ("limited", "no node is subscribed to /cmd_vel")
        assert bench.calls()[-1]["warning"] == answer["warning"]

    run(tmp_path, script)


def test_a_service_answers_or_is_refused(tmp_path: Path) -> None:
    async def script(client: Client, _: Bench) -> None:
        await call(client, "robot", event="Lamp.light.response", data={"success": True, "message": "on"})
        answered = await call(client, "Lamp_light", data=True)
        assert answered == {"verdict": "answered", "response": {"success": True, "message": "on"}}
        await call(client, "robot", event="Lamp.light.response", data={"success": False})
        await call(client, "Lamp_light", data=False)
        await call(client, "robot", event="Person.seen", data={"data": True})
        refused = await call(client, "Lamp_light", data=True)
        assert (refused["verdict"], refused["reason"]) == ("refused", "requirement")
        assert "response from `Person.seen`" in refused["possible"][-1]

    run(tmp_path, script)


def test_a_goal_is_accepted_and_ends(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        goal = {"pose": {"pose": {"position": {"x": 2.0}}}}
        assert (await call(client, "wait", command="Navigation_go_to"))["status"] == "none"
        assert await call(client, "Navigation_go_to", **goal) == {"verdict": "accepted"}
        received = bench.received()[-1][1]["pose"]
        assert received["pose"]["position"] == {"x": 2.0, "y": 0.0, "z": 0.0}
        assert (received["header"]["frame_id"], received["header"]["stamp"]["sec"] > 0) == ("map", True)
        assert (await call(client, "Navigation_go_to", **goal))["reason"] == "busy"
        await call(client, "robot", event="Navigation.go_to.feedback", data={"distance_remaining": 1.5})
        running = await call(client, "wait", command="Navigation_go_to", seconds=0.01)
        assert (running["status"], running["feedback"]["distance_remaining"]) == ("executing", 1.5)
        waiting = asyncio.create_task(call(client, "wait", command="Navigation_go_to", seconds=30))
        await call(client, "robot", event="Navigation.go_to.succeeded")
        assert (await waiting)["status"] == "succeeded"
        assert (await call(client, "state"))["goals"]["Navigation_go_to"]["status"] == "succeeded"
        assert (await call(client, "robot", event="Navigation.go_to.aborted"))["because"] == ["no goal runs"]

    run(tmp_path, script)


def test_a_goal_can_be_canceled(tmp_path: Path) -> None:
    async def script(client: Client, _: Bench) -> None:
        assert (await call(client, "cancel", command="Navigation_go_to"))["verdict"] == "refused"
        await call(client, "Navigation_go_to")
        assert (await call(client, "Base_gear", data=1))["because"] == ["requirement gear needs Navigation.resting"]
        assert await call(client, "cancel", command="Navigation_go_to") == {"verdict": "canceling"}
        assert (await call(client, "wait", command="Navigation_go_to", seconds=30))["status"] == "canceled"
        assert await call(client, "Base_gear", data=1) == {"verdict": "sent"}

    run(tmp_path, script)


def test_the_layer_cancels_a_goal_whose_requirement_falls(tmp_path: Path) -> None:
    async def script(client: Client, _: Bench) -> None:
        await call(client, "Navigation_go_to")
        await call(client, "robot", event="Person.seen", data={"data": True})
        assert (await call(client, "wait", command="Navigation_go_to", seconds=30))["status"] == "canceled"

    run(tmp_path, script)


def test_why_explains_and_sends_nothing(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        assert await call(client, "why", command="Navigation_go_to") == {"verdict": "explained", "allowed": True}
        await call(client, "robot", event="Person.seen", data={"data": True})
        before = bench.state()
        fast = await call(client, "why", command="Base_velocity", data={"linear": {"x": 0.75}})
        assert (fast["allowed"], fast["reason"]) == (False, "requirement")
        assert (await call(client, "why", command="Base_velocity", data={"linear": {"x": 0.25}}))["allowed"]
        assert (await call(client, "why", command="Base_velocity"))["allowed"], "with some data"
        assert (await call(client, "why", command="Base_gear", data={"data": 6}))["reason"] == "schema"
        goal = await call(client, "why", command="Navigation_go_to")
        assert goal["because"] == ["requirement go_to needs Person.away"]
        assert goal["possible"][0].startswith("At once: `Person` goes from `near` to `away`")
        assert bench.state() == before
        assert bench.received() == []

    run(tmp_path, script)


def test_a_refusal_does_not_wait_for_a_long_explanation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    go_on = threading.Event()
    explore = gate_module.explore

    def slow(*arguments: Any) -> Any:
        assert go_on.wait(60)
        return explore(*arguments)

    async def script(client: Client, _: Bench) -> None:
        await call(client, "robot", event="Person.seen", data={"data": True})
        monkeypatch.setattr(gate_module, "explore", slow)
        monkeypatch.setattr(gate_module, "_LONG_PATIENCE", 60)
        because = ["requirement go_to needs Person.away"]
        refused = {"verdict": "refused", "reason": "requirement", "because": because}
        assert await call(client, "Navigation_go_to") == refused
        light = await call(client, "Lamp_light")
        assert "possible" not in light, "the explanation of another command is under way"
        waiting = asyncio.create_task(call(client, "why", command="Navigation_go_to"))
        await call(client, "state")
        go_on.set()
        assert (await waiting)["possible"][0].startswith("At once: `Person` goes")
        assert (await call(client, "Navigation_go_to"))["possible"][0].startswith("At once: `Person` goes")

    run(tmp_path, script)


def test_state_shows_components_and_commands(tmp_path: Path) -> None:
    async def script(client: Client, _: Bench) -> None:
        assert (await call(client, "state"))["writer"] is None
        await call(client, "Base_horn")
        await call(client, "robot", event="Person.seen", data={"data": True})
        state = await call(client, "state")
        assert state["components"]["Person"] == {"state": "near", "variables": {}}
        assert state["commands"]["Base_horn"] == {"allowed": True}
        assert state["commands"]["Navigation_go_to"]["because"] == ["requirement go_to needs Person.away"]
        assert (state["writer"], state["violated"], state["graph"]) == ("you", [], [])

    run(tmp_path, script)


def test_hostile_calls_change_nothing_and_are_logged(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        await call(client, "robot", event="Person.seen", data={"data": True})
        before = bench.state()
        for tool, data, reason in HOSTILE:
            # Not by the client: its JSON cannot carry all of this.
            answer = await bench.gate.call("stdio", tool, data)
            assert (answer["verdict"], answer.get("reason")) == ("refused", reason), (tool, data)
        assert bench.state() == before
        assert bench.received() == []
        logged = bench.calls()[1:]
        assert [(entry["tool"], entry["verdict"], entry["reason"]) for entry in logged] == [
            (tool, "refused", reason) for tool, _, reason in HOSTILE
        ]
        assert all(entry["because"] and entry["client"] == "stdio" and entry["time"] > 0 for entry in logged)
        assert max(len(json.dumps(entry)) for entry in logged) < 5000
        assert (await call(client, "Base_horn"))["verdict"] == "sent"

    run(tmp_path, script)


def test_the_schema_accepts_what_the_gate_accepts(tmp_path: Path) -> None:
    with gate(tmp_path) as bench:
        shapes = {tool.name: tool.shape for tool in bench.gate.tools.values()}
    values = [0, 5, 6, -1, 2.0, 2.5, 10**30, True, None, "", "state", [], [0.5], {}, {"x": 0.5}, {"x": "a"}, {"y": 1}]
    for tool, shape in shapes.items():
        validator = Draft202012Validator(shape.schema)
        for name in [*shape.fields, "other"]:
            for value in values:
                data = {**dict.fromkeys(shape.required, "Navigation_go_to"), name: value}
                assert validator.is_valid(data) == (not faults_of(shape, data)), (tool, data)


def test_a_flood_is_refused_and_logged(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        bench.gate._rates.clock = lambda: 0.0
        answers = await asyncio.gather(*(call(client, "Base_gear", data=number % 6) for number in range(1000)))
        verdicts = [answer["verdict"] for answer in answers]
        assert (verdicts.count("sent"), verdicts.count("refused")) == (20, 980)
        assert {answer.get("reason") for answer in answers} == {None, "rate"}
        assert len(bench.received()) == 20
        assert len(bench.calls()) == 1000
        assert [(await call(client, "Base_horn"))["verdict"] for _ in range(40)].count("sent") == 20, "another tool"
        assert [(await call(client, "Base_text"))["verdict"] for _ in range(40)].count("sent") == 10, "in total"
        bench.gate._rates.clock = lambda: 0.5
        assert [(await call(client, "Base_gear"))["verdict"] for _ in range(40)].count("sent") == 10

    run(tmp_path, script, rate=20, total=50)


def test_a_silent_writer_stops_and_loses_its_role(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        now = [0.0]
        bench.gate._writer.clock = lambda: now[0]
        await call(client, "Base_velocity", linear={"x": 0.75})
        await call(client, "Navigation_go_to")
        assert (await bench.gate.call("other", "Base_horn", {}))["reason"] == "writer"
        now[0] = 100
        await bench.gate.expire()  # its goal runs
        assert (await call(client, "state"))["goals"]["Navigation_go_to"]["status"] == "executing"
        await call(client, "robot", event="Navigation.go_to.succeeded")
        now[0] = 159
        await bench.gate.expire()
        assert (await bench.gate.call("other", "Base_horn", {}))["reason"] == "writer"
        now[0] = 161
        await bench.gate.expire()
        assert bench.received()[-1] == ("Base.velocity", bench.received()[-1][1])
        assert bench.received()[-1][1]["linear"]["x"] == 0.0
        assert (await bench.gate.call("other", "Base_horn", {}))["verdict"] == "sent"
        assert (await call(client, "Base_horn"))["reason"] == "writer"
        assert [entry for entry in bench.calls() if entry["verdict"] == "released"]

    run(tmp_path, script)


def test_a_writer_keeps_its_role_during_a_call(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        now = [0.0]
        bench.gate._writer.clock = lambda: now[0]
        calling = asyncio.create_task(bench.gate.call("slow", "Lamp_light", {"data": True}))
        while bench.gate._writer.holder is None:
            await asyncio.sleep(0)
        now[0] = 100
        await bench.gate.expire()
        assert (await call(client, "Base_horn"))["reason"] == "writer"
        assert (await calling)["verdict"] in {"answered", "failed"}
        now[0] = 200
        assert (await call(client, "Base_horn"))["verdict"] == "sent"

    run(tmp_path, script)


def test_a_call_whose_session_has_ended_sends_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def script(client: Client, bench: Bench) -> None:  # noqa: ARG001
        monkeypatch.setattr(bench.gate, "expire", lambda: bench.gate.leave("gone"))
        assert (await bench.gate.call("gone", "Base_horn", {}))["because"] == ["the session of the client has ended"]
        assert bench.received() == []

    run(tmp_path, script)


def test_release_stops_what_the_writer_has_started(tmp_path: Path) -> None:
    async def script(client: Client, bench: Bench) -> None:
        await call(client, "Base_velocity", linear={"x": 0.75})
        await call(client, "Navigation_go_to")
        assert await call(client, "release") == {"verdict": "released"}
        assert (await call(client, "wait", command="Navigation_go_to", seconds=30))["status"] == "canceled"
        assert [data["linear"]["x"] for name, data in bench.received() if name == "Base.velocity"] == [0.75, 0.0]
        await call(client, "release")
        assert [name for name, _ in bench.received()].count("Base.velocity") == 2

    run(tmp_path, script)


def test_a_fault_of_the_gate_reaches_the_client_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def script(client: Client, bench: Bench) -> None:
        monkeypatch.setattr(bench.node, "publish", lambda *_: 1 / 0)
        failed = await call(client, "Base_horn")
        assert (failed["verdict"], failed["reason"]) == ("failed", "internal")
        monkeypatch.undo()
        assert (await call(client, "Base_horn"))["verdict"] == "sent"

    run(tmp_path, script)


def test_names_of_tools_are_unlike() -> None:
    used: set[str] = set()
    names = [tool_name(name, used) for name in ("A.b_c", "A_b.c", "Base[2].go", "é", "x" * 80, "x" * 90)]
    assert names == ["A_b_c", "A_b_c_2", "Base_2__go", "_", "x" * 64, "x" * 62 + "_2"]


def test_commands_need_known_types(tmp_path: Path) -> None:
    text = PORTER.read_text(encoding="utf-8").replace("SetBool from std_srvs", "SetLamp from lamp_srvs")
    (tmp_path / "porter.rscd").write_text(text, encoding="utf-8")
    with pytest.raises(UnknownTypeError, match=r"Lamp\.light: lamp_srvs/SetLamp is unknown in ROS 2"):
        commands(models(tmp_path / "porter.rscd"))


def test_the_elements_of_an_array_have_their_own_data(tmp_path: Path) -> None:
    """Nothing of one element or call is in another one. A byte of ROS 2 has no sign."""
    robot = tmp_path / "fence.rscd"
    robot.write_text("""robot Fence {
  component Base {
    incoming message fence with identifier: "/fence", type: geometry_msgs/Polygon
    incoming message bytes with identifier: "/bytes", type: std_msgs/ByteMultiArray
  }
}
""")
    known = models(robot)
    assert known.rosgraph is not None
    assert known.ros_types is not None
    fence, octets = commands(known)
    messages = Messages(DryNode("fence", known.rosgraph, known.ros_types, str))

    def sent(*points: dict[str, float]) -> Any:
        data = fence.shape.converted({"points": list(points)})
        message = messages.plain(messages.create(fence.element.interface, fence.section, data))
        return [(point["x"], point["y"]) for point in message["points"]]

    assert sent({"x": 1.0}, {"y": 2.0}) == [(1.0, 0.0), (0.0, 2.0)]
    assert sent({}) == [(0.0, 0.0)]
    assert faults_of(octets.shape, {"data": [0, 255]}) == []
    assert faults_of(octets.shape, {"data": [-1]}) == ["data[0] is not between 0 and 255"]
    message = messages.create(octets.element.interface, octets.section, {"data": [0, 255]})
    assert messages.plain(message)["data"] == [0, 255]
