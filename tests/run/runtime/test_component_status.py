"""Diagnostics of a node on `/diagnostics`, without middleware; `tests/ros` checks live graphs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import controller_parameters, layer_parameters
from robosc.run.runtime.core.port import Endpoint
from tests.run.runtime.fake import Record, World, supervised

if TYPE_CHECKING:
    from robosc.run.runtime.core.port import ComponentStatus

COURIER = Path(__file__).parents[2] / "m2t" / "cpp" / "courier.rscd"
SCOUT = Path(__file__).parents[2] / "ros" / "faults" / "scout.rscd"


def status(world: World, component: str) -> ComponentStatus:
    return next(reported for reported in world.port.statuses[-1] if reported.component == component)


@pytest.mark.parametrize(
    ("milliseconds", "reports"), [(0, 0), (1, 10), (100, 10), (250, 5), (1000, 1), (86_400_000, 1)]
)
def test_reports_once_in_whole_ticks(tmp_path: Path, milliseconds: int, reports: int) -> None:
    world = World(COURIER, tmp_path / "events.jsonl", diagnostics_ms=milliseconds).start()
    world.wait(1.05)
    assert len(world.port.statuses) == reports


def test_tells_nobody_where_nobody_listens(tmp_path: Path) -> None:
    world = World(COURIER, tmp_path / "events.jsonl")
    world.port.hearing = 0
    world.start().wait(3.0)
    assert world.port.statuses == []


def test_a_configuration_without_it_has_no_parameter() -> None:
    graph = supervised(COURIER)
    for declared in (controller_parameters, layer_parameters):
        names = [parameter.name for parameter in declared(graph, Configuration(diagnostics_ms=0), "")]
        assert "diagnostics_ms" not in names


def test_values_are_texts_as_people_read_them(tmp_path: Path) -> None:
    world = World(COURIER, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    world.port.types = {"ranges": "sequence<float>"}
    world.hear("scan", ranges=[math.nan, 3.0, 3.0, -math.inf], angle_min=1.0)
    world.hear("word", data="\ud800 <b>")
    world.wait(0.15)
    assert status(world, "Scanner").values[:4] == [
        ("state", "looking"),
        ("seen", "far"),
        ("first", "nan"),
        ("before", "-1.5"),
    ]
    assert ("fourth", "-inf") in status(world, "Scanner").values
    assert ("text", "? <b>") in status(world, "Counter").values
    office = dict(status(world, "Office").values)
    assert office["request to target"] == "allowed"
    assert office["request to report"] == "allowed"
    world.hear("count", data=200)
    world.wait(0.1)
    forbidden = [
        "requirement Counter.limited > 100 disables report",
        "requirement report needs Scanner.looking => Counter.limited < 50",
    ]
    assert dict(status(world, "Office").values)["request to report"] == f"forbidden: {'; '.join(forbidden)}"


def test_faults_of_the_graph_are_told_as_long_as_they_last(tmp_path: Path) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    topics = {end.topic: end for end in [*world.graph.subscriptions, *world.graph.publishers]}
    type_name = world.port.type_name
    teleop = Endpoint("/teleop", type_name(topics["/cmd_vel"].interface))
    world.port.others = {
        topics["/scan"]: [Endpoint("/lidar", type_name(topics["/scan"].interface), "it is best effort")],
        topics["/charge"]: [Endpoint("/battery", "std_msgs/String")],
        topics["/bumper"]: [],
        topics["/pulse"]: [Endpoint("", "plc_msgs/Pulse")],
        topics["/cmd_vel"]: [teleop],
    }
    for _ in range(2):
        world.wait(6.0)
        found = {name: status(world, name) for name in ("Lidar", "Battery", "Bumper", "Encoder", "Platform")}
        assert {name: reported.message for name, reported in found.items() if reported.level == "WARN"} == {
            "Lidar": "looking; /scan: /lidar offers a quality of service that does not fit: it is best effort",
            "Battery": "powered; /charge: /battery publishes std_msgs/String, not std_msgs/Int16",
            "Bumper": "untouched; /bumper: nobody publishes it",
            "Platform": "has no states; /cmd_vel: /teleop publishes it, too",
        }
    assert len(world.port.said) == len(set(world.port.said)), "the log has each once"
    world.port.others = {topics["/bumper"]: [Endpoint("/bumper", type_name(topics["/bumper"].interface))]}
    world.wait(2.0)
    assert {reported.level for reported in world.port.statuses[-1]} == {"OK"}


def test_a_server_of_another_type_is_told(tmp_path: Path) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    world.port.served = False
    world.port.servers = [("/switch", "std_srvs/Trigger")]
    lamp = next(client for client in world.graph.serviceClients if client.identifier == "/lamp")
    fault = f"/switch serves std_srvs/Trigger, not {world.port.type_name(lamp.interface)}"
    world.hear("light", data=True)
    world.wait(12.0)
    assert world.port.said.count(f"/lamp: {fault}") == world.port.said.count("/lamp: the server has another type") == 1
    assert not [text for text in world.port.said if text.startswith("/lamp: no server")]
    assert status(world, "Lamp").message == f"dark; /lamp: {fault}; /lamp: the server has another type"
    world.port.servers, world.port.served = [], True
    world.wait(2.0)
    world.port.calls[-1].answered(Record(success=True, message="on"))
    world.wait(0.2)
    assert status(world, "Lamp").level == "OK"


def test_several_servers_are_told_as_long_as_they_last(tmp_path: Path) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    lamp = next(client for client in world.graph.serviceClients if client.identifier == "/lamp")
    kind = world.port.type_name(lamp.interface)
    fault = "/lamp: /rival and /switch serve it: only one answer counts"
    for _ in range(2):
        world.port.servers = [("/switch", kind), ("/rival", kind), ("/stranger", "std_srvs/Trigger")]
        world.wait(2.0)
        assert status(world, "Lamp").message == f"dark; {fault}"
        world.port.servers = []
        world.wait(2.0)
        assert status(world, "Lamp").level == "OK"
    assert world.port.said.count(fault) == 1
    assert not [text for text in world.port.said if "/stranger" in text]


def test_a_failure_beside_several_servers_has_its_own_reason(tmp_path: Path) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    lamp = next(client for client in world.graph.serviceClients if client.identifier == "/lamp")
    world.port.servers = [(name, world.port.type_name(lamp.interface)) for name in ("/a", "/b")]
    world.hear("light", data=True)
    world.wait(12.0)
    assert [text for text in world.port.said if text.startswith("/lamp: no answer")]
    assert "/lamp: the server has another type" not in world.port.said


def test_a_server_that_has_come_back_is_no_second_one_until_ros_must_know(tmp_path: Path) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    lamp = next(client for client in world.graph.serviceClients if client.identifier == "/lamp")
    twice = [("/switch", world.port.type_name(lamp.interface))] * 2
    for servers in (twice, []):
        world.port.servers = servers
        world.wait(22.0)
        assert status(world, "Lamp").level == "OK"
    world.port.servers = twice
    world.wait(30.0)
    assert status(world, "Lamp").message == "dark; /lamp: several nodes /switch serve it: only one answer counts"


def test_commands_wait_for_the_topics_that_are_named(tmp_path: Path) -> None:
    settings = Configuration(wait_for=["charge", "/stop"], on_shutdown=["halt"])
    world = World(SCOUT, tmp_path / "events.jsonl", settings, diagnostics_ms=100).start()
    world.hear("scan", ranges=[1.0, 0.25])
    world.wait(1.0)
    assert world.port.sent == []
    assert status(world, "Battery").message == "powered; /charge was not heard yet"
    assert ("request to move", "held back: it waits for /charge, /stop") in status(world, "Platform").values
    world.hear("stop")
    world.hear("continue")
    world.wait(1.0)
    assert world.port.sent == []
    world.hear("charge", data=50)
    world.wait(0.2)
    assert [topic for topic, _ in world.port.sent][:1] == ["/cmd_vel"]
    assert status(world, "Battery").level == "OK"
    assert world.port.said == [
        "commands wait for /charge, /stop",
        "commands wait no longer: each topic was heard",
    ]
