"""Tours, and their player: against the same controller, and against faulty ones."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

import robosc
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.engine import Engine, cache_results
from robosc.language import configuration as config
from robosc.model import expression as ex
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.roles import event_name
from robosc.run.node_tests import trace_player
from robosc.run.node_tests.messages import Field, message
from robosc.run.node_tests.samples import all_incoming
from robosc.run.node_tests.trace_player import Log, Player, TraceError, read_trace
from robosc.run.node_tests.trace_test import trace_test
from robosc.run.runtime.core.node_data import NodeData
from robosc.run.runtime.core.port import GoalOutcome
from tests.searching import matrix_but, slow_but

from .in_process_node import Client, InProcessNode

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.m2t.models import TraceTest
    from robosc.model import rosgraph

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
CPP = ROOT / "tests" / "m2t" / "cpp"
MODELS = {
    "line_follower": ROOT / "examples" / "line_follower" / "line_follower.rscd",
    "maze_solver": ROOT / "examples" / "maze_solver" / "maze_solver.rscd",
    "simple_navigation": ROOT / "examples" / "simple_navigation" / "simple_navigation.rscd",
    "courier": CPP / "courier.rscd",
    "porter": CPP / "porter.rscd",
    "scout": ROOT / "tests" / "ros" / "faults" / "scout.rscd",
    "mission": ROOT / "tests" / "run" / "runtime" / "mission.rscd",
    "kept": ROOT / "tests" / "run" / "runtime" / "kept.rscd",
    "waypoints": ROOT / "tests" / "run" / "runtime" / "waypoints.rscd",
    "keeper": ROOT / "tests" / "ros" / "kept" / "keeper.rscd",
    "crane": ROOT / "tests" / "run" / "simulation" / "crane.rscd",
    "visitor": ROOT / "tests" / "run" / "scenario_tests" / "visitor.rscd",
    "push_ball": ROOT / "examples" / "push_ball" / "push_ball.rscd",
    "sprayer": ROOT / "examples" / "sprayer" / "sprayer.rscd",
    "warehouse_robot": ROOT / "examples" / "warehouse_robot" / "warehouse_robot.rscd",
}
SETTINGS = {
    "porter": CPP / "porter-config.json",
    **{
        name: path.with_name(config.FILE_NAME)
        for name, path in MODELS.items()
        if path.is_relative_to(ROOT / "examples")
    },
}


def robot_of(name: str) -> tuple[rosgraph.RosGraph, config.Configuration]:
    robot = robosc.load(MODELS[name])
    robosc.synthesize(robosc.to_sct(robot))
    configuration = config.read(SETTINGS[name]) if name in SETTINGS else config.Configuration()
    return robosc.to_rosgraph(robot), configuration


@pytest.fixture(scope="session")
def made(planned_once: Callable[..., list[TraceTest]]) -> Callable[[str], TraceTest]:
    """Return the test of a robot. Report tests of the examples share it."""

    @cache
    def planned(name: str) -> TraceTest:
        return planned_once(MODELS[name], *robot_of(name))[1]

    return planned


class Case:
    """A robot and its test. Each case has its own graph, which a test may break."""

    def __init__(self, name: str, test: TraceTest, folder: Path) -> None:
        self.graph, self.configuration = robot_of(name)
        self.test = test
        self.files = self.test.files
        self.connections: dict[str, Any] = json.loads(self.files["connections.json"])
        #: The traces; `trace` is the first one.
        self.traces = [
            [json.loads(line) for line in text.splitlines()]
            for file, text in self.files.items()
            if file.startswith("traces/")
        ]
        self.trace = self.traces[0]
        self._folder = folder

    def play(self) -> None:
        """Play the current traces against the current graph."""
        for trace in self.traces:
            self._play(trace)

    def _play(self, lines: list[dict[str, Any]]) -> None:
        trace, log = self._folder / "trace.jsonl", self._folder / "events.jsonl"
        trace.write_text("".join(f"{json.dumps(line)}\n" for line in lines))
        log.unlink(missing_ok=True)
        node = InProcessNode(self.connections, self.graph, self.configuration, log)
        Player(self.connections, node, Log(str(log))).play(read_trace(str(trace)))


def be_impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten all waiting times: the node without ROS reacts at once."""
    for name, seconds in {"SETTLED": 0.0, "REACTION": 0.0, "ANSWER": 0.0, "PATIENCE": 0.05}.items():
        monkeypatch.setattr(trace_player, name, seconds)


@pytest.fixture
def case(
    request: pytest.FixtureRequest, made: Callable[[str], TraceTest], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Case:
    be_impatient(monkeypatch)
    name = getattr(request, "param", "line_follower")
    return Case(name, made(name), tmp_path)


#: The sprayer's tours take longest to plan. A run of all tests plans those of the other large robot.
ROBOTS = [
    *slow_but(["line_follower", "porter", "kept", "visitor"], [name for name in MODELS if name != "sprayer"]),
    *matrix_but([], ["sprayer"]),
]
every_model = pytest.mark.parametrize("case", ROBOTS, indirect=True)


@pytest.mark.slow
@every_model
def test_a_controller_follows_its_own_tours(case: Case) -> None:
    case.play()


@pytest.mark.slow
@every_model
def test_a_tour_is_an_event_log(case: Case) -> None:
    validator = Draft202012Validator(json.loads(locate("schemas/event-log.schema.json").read_text()))
    for trace in case.traces:
        for line in trace:
            validator.validate(line)
        times = [line["time"] for line in trace]
        assert times == sorted(times)


@pytest.mark.parametrize("case", ["line_follower", "porter", "visitor"], indirect=True)
def test_tours_see_every_event(case: Case) -> None:
    assert {line["event"] for trace in case.traces for line in trace} == {
        event_name(event)
        for plant in case.graph.model.plants
        for event in plant.events
        if event.name != "c_none"  # a provide statement always has a true case
    }


@pytest.mark.parametrize("case", ["porter", "kept", "line_follower"], indirect=True)
def test_the_same_call_gives_the_same_test(case: Case) -> None:
    """This includes a test that was planned once for ROS 1 and 2, as for all cases."""
    assert trace_test(case.graph, case.configuration, 2) == case.test


@pytest.mark.slow
def test_a_tour_with_other_settings_is_another_one() -> None:
    graph, configuration = robot_of("porter")
    slower = configuration.control_loop.model_copy(update={"period_ms": 350})
    other = configuration.model_copy(update={"control_loop": slower})
    with cache_results():
        first, second = (trace_test(graph, asked, 2).files for asked in (configuration, other))
    assert first != second
    assert second == trace_test(graph, other, 2).files


# Logs of robots


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    slow_but(
        ["line_follower", "courier", "kept"],
        ["line_follower", "maze_solver", "porter", "courier", "scout", "kept", "keeper"],
    ),
    indirect=True,
)
def test_a_log_without_messages_is_played(case: Case) -> None:
    """The data that the node reads suffice to make equivalent messages, also for stored data that it sends."""
    for line in case.trace:
        line.pop("message", None)
    case.play()


@pytest.mark.parametrize("case", ["mission"], indirect=True)
def test_a_tour_brings_data_that_can_not_be_read(case: Case) -> None:
    events = [line["event"] for line in case.trace]
    assert events.count("message_length.u_response") > events.count("message_route.u_response") > 0
    unread = {line["event"] for line in case.trace if line["event"].endswith(".u_error") and "data" in line}
    assert "service_plan.u_error" in unread


def test_what_can_not_be_played_is_said(case: Case) -> None:
    number = next(number for number, line in enumerate(case.trace, 1) if line["event"] == "message_scan.u_response")
    line = case.trace[number - 1]
    del line["message"]
    line["data"]["value"] = "foggy"
    with pytest.raises(TraceError, match=f"line {number} cannot be played: no known message is read as foggy"):
        case.play()


#: Reasons of failed goals, the logged result, and the message to send for it.
GOALS = [
    ("aborted", {"code": 8, "rest": 0, "path": {"1": 0.25, "2": 3}}, {"path": {"0": 0.0, "1": 0.25, "2": 3.0}}),
    ("aborted", {"code": 8, "rest": 0}, None),
    ("unreadable", {"code": 5, "rest": 0}, None),
    ("unreadable", {"code": 5, "rest": 0.5}, {"code": 5, "rest": 0.5}),
]


@pytest.mark.parametrize(("reason", "value", "message"), GOALS)
@pytest.mark.parametrize("case", ["crane"], indirect=True)
def test_an_error_has_its_reason_and_its_result(
    case: Case, reason: str, value: dict[str, Any], message: dict[str, Any] | None
) -> None:
    """The message that a tool notes for the result is optional, as in a log of a robot."""
    failed = case.trace[0] | {"direction": "in", "event": "action_go.u_error"}
    failed["data"] = {"value": value, "reason": reason}
    if message is not None:
        failed["message"] = {"code": 8} | message
    case.traces = [[case.trace[0], failed]]
    case.play()


@pytest.mark.parametrize("reason", ["canceled", "lost", "rejected", "timeout", "unavailable"])
@pytest.mark.parametrize("case", ["crane"], indirect=True)
def test_a_reason_that_no_server_brings_about(case: Case, reason: str) -> None:
    failed = {"direction": "in", "event": "action_go.u_error", "data": {"value": {"code": 0}, "reason": reason}}
    case.traces = [[case.trace[0], case.trace[0] | failed]]
    with pytest.raises(TraceError, match=f"line 2 cannot be played: no test server lets /go fail because {reason}"):
        case.play()


@pytest.mark.parametrize("reason", ["failed", "unavailable", "unreadable", "timeout"])
@pytest.mark.parametrize("case", ["crane"], indirect=True)
def test_a_call_fails_for_its_reason(case: Case, reason: str) -> None:
    """This includes servers that cannot fail a call at once, as in ROS 2; `unreadable` needs an answer."""
    trace = next(lines for lines in case.traces if "service_lift.c_trigger" in [line["event"] for line in lines])
    before = [line["event"] for line in trace].index("service_lift.c_trigger")
    failed = trace[before] | {"direction": "in", "event": "service_lift.u_error", "data": {"reason": reason}}
    case.traces = [[*trace[: before + 1], failed]]
    if reason == "timeout":
        case.play()
        return
    fault = f"line {before + 2} cannot be played: no test server lets /lift fail because {reason}"
    with pytest.raises(TraceError, match=fault):
        case.play()


@pytest.mark.parametrize(
    "message", [{"no_such_field": 1}, {"ranges": 10**400}, {"ranges": "x"}], ids=lambda message: str(message)[:80]
)
def test_a_message_that_can_not_be_sent_is_said(case: Case, message: dict[str, Any]) -> None:
    number = next(number for number, line in enumerate(case.trace, 1) if line["event"] == "message_scan.u_response")
    case.trace[number - 1]["message"] = message
    with pytest.raises(TraceError, match=f"line {number}: "):
        case.play()


def test_a_stopped_node_ends_a_trace(case: Case) -> None:
    case.trace[20:] = [case.trace[0] | {"direction": "outside"}, {"nonsense": 1}]
    case.play()


def test_a_log_of_a_layer_is_refused(case: Case) -> None:
    case.trace[3]["direction"] = "blocked"
    with pytest.raises(TraceError, match="line 4 comes from a supervisory layer"):
        case.play()


def test_a_trace_of_another_robot_is_refused(case: Case) -> None:
    next(line for line in case.trace if line["direction"] == "in")["event"] = "message_other.u_response"
    with pytest.raises(TraceError, match=r"knows no message_other.u_response"):
        case.play()


@pytest.mark.slow
@pytest.mark.parametrize("case", ["maze_solver"], indirect=True)
def test_half_a_message_is_refused(case: Case) -> None:
    del case.trace[next(n for n, line in enumerate(case.trace) if line["event"] == "message_scan_right.u_response")]
    with pytest.raises(TraceError, match=r"one message causes message_scan_front.u_response, message_scan_right"):
        case.play()


@pytest.mark.slow
def test_the_log_of_a_drive_is_played(case: Case, tmp_path: Path) -> None:
    """Its messages come before the first tick, or at the same time as others."""
    log = tmp_path / "drive.jsonl"
    command = [sys.executable, ROOT / "examples" / "simulator", "--scenario", "line_follower", "--until", "9"]
    subprocess.run([*command, "--log", log], check=False, capture_output=True)  # the run ends before the goal
    case.trace = [json.loads(line) for line in log.read_text().splitlines()]
    assert [line["direction"] for line in case.trace[:3]] == ["internal", "internal", "in"]
    assert {"message_halt.c_trigger", "message_move.c_trigger"} <= {line["event"] for line in case.trace}
    case.play()


# Faulty nodes


def requirements() -> list[str]:
    names = {}
    for name in ("line_follower", "porter"):
        text = MODELS[name].read_text(encoding="utf-8")
        names[name] = re.findall(r"^  requirement (\w+) needs", text, re.MULTILINE)
    return [f"{name}:{fields}" for name, found in names.items() for fields in found]


@pytest.mark.parametrize("fault", requirements())
def test_a_dropped_requirement_is_noticed(
    fault: str, made: Callable[[str], TraceTest], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, event = fault.split(":")
    be_impatient(monkeypatch)
    case = Case(name, made(name), tmp_path)
    assert case.graph.model.supervisor is not None
    guards = [
        guard
        for guard in case.graph.model.supervisor.guards
        if event_name(guard.event).endswith(f"_{event}.c_trigger") and guard.requirement is not None
    ]
    assert len(guards) == 1
    guards[0].requirement = None
    with pytest.raises(TraceError, match=r"but the node did|has sent something"):
        case.play()


def test_wrong_data_is_noticed(case: Case) -> None:
    move = next(sending for sending in case.graph.publishers[0].sendings if sending.name == "move")
    speed = move.alternatives[0].fields[0].value
    assert isinstance(speed, ex.DoubleLiteral)
    speed.value = 0.25
    with pytest.raises(TraceError, match=r"has out message_move.c_trigger .*0\.2.* but the node sent .*0\.25"):
        case.play()


@pytest.mark.slow
def test_data_that_changes_on_its_way_is_noticed(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    put = case.connections["publishers"][0]
    whole = InProcessNode.connect

    def connect(node: InProcessNode) -> None:
        whole(node)
        node.sent[put["topic"]].put = lambda _: None  # type: ignore[method-assign]

    monkeypatch.setattr(InProcessNode, "connect", connect)
    with pytest.raises(TraceError, match=r"the node logs out message_halt.c_trigger .* but no message arrives"):
        case.play()


@pytest.mark.parametrize("case", ["visitor"], indirect=True)
def test_another_answer_than_the_log_has_is_noticed(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    put = Client.end
    monkeypatch.setattr(Client, "end", lambda client, _, result: put(client, GoalOutcome.ABORTED, result))
    with pytest.raises(TraceError, match=r"action_visit.c_(response|canceled), but the goal ends as aborted"):
        case.play()
    monkeypatch.setattr(Client, "end", lambda *_: None)
    with pytest.raises(TraceError, match=r"the node logs out action_visit\.c_\w+, but no message arrives"):
        case.play()
    monkeypatch.setattr(Client, "end", put)
    monkeypatch.setattr(Client, "feed_back", put_other)
    with pytest.raises(TraceError, match=r"number_of_recoveries arrives as 7"):
        case.play()


def put_other(client: Client, feedback: Any) -> None:
    """Pass other feedback to the player."""
    feedback.number_of_recoveries = 7
    assert client.feedback is not None
    client.feedback.put(feedback)


def test_a_node_that_forgets_is_noticed(case: Case) -> None:
    lidar = next(plant for plant in case.graph.model.plants if plant.origin == "Lidar" and plant.variables)
    for location in lidar.locations:
        for edge in edges_from(location):
            edge.updates.clear()
    with pytest.raises(TraceError, match=r"does not follow the trace|but the node did"):
        case.play()


# Sent data


@every_model
def test_samples_mean_what_they_say(case: Case) -> None:
    data = NodeData(case.graph, Engine(case.graph.model))
    known = all_incoming(case.graph, RosTypes().distributions[0])
    for kind in {id(kind): kind for kind in known.values()}.values():
        for literals, found in kind.samples.items():
            for values in found:
                made = kind.message(values)
                for read, literal in zip(kind.conversions, literals, strict=True):
                    argument = made
                    for step in read.path:
                        argument = getattr(argument, step)
                    assert read.conversion is not None
                    assert data.convert(read.conversion, argument).name == literal


@pytest.mark.slow
@pytest.mark.parametrize("case", ["maze_solver"], indirect=True)
def test_all_literals_that_can_meet_are_found(case: Case) -> None:
    (scan,) = [topic for topic in case.connections["subscriptions"] if topic["topic"] == "/scan"]
    assert len({tuple(sample["literals"]) for sample in scan["samples"]}) == 3 * 2 * 2


# The files


def test_the_player_runs_where_ros_1_does() -> None:
    """The player needs only Python 3.8 and its standard library."""
    text = locate("run/node_tests/trace_player.py").read_text(encoding="utf-8")
    tree = ast.parse(text, feature_version=(3, 8))
    names = {
        statement.names[0].name if isinstance(statement, ast.Import) else str(statement.module)
        for statement in tree.body
        if isinstance(statement, (ast.Import, ast.ImportFrom))
    }
    assert not any(name.startswith("robosc") for name in names)


def test_a_message_has_no_array_without_end() -> None:
    fields = {
        ("ranges", "2147483647"): Field(ex.DoubleType(), "float32"),
        ("ranges", "1"): Field(ex.DoubleType(), None),
    }
    made = message(fields, {("ranges", "2147483647"): 1.5, ("ranges", "1"): 0.5})
    assert made.ranges == [0.0, 0.5]
