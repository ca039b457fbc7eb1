"""Graphs of nodes: read from files, and made of the endpoints that ROS names."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import jsonschema
import pytest

from robosc.base.diagnostics import ModelError
from robosc.base.files.resources import locate
from robosc.base.node_graph import NodeGraph, node_graph, reading

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SEND, FEEDBACK = "/go/_action/send_goal", "/go/_action/feedback"
TYPE = "nav2_msgs/action/NavigateToPose"


def test_the_parts_of_an_action_are_one_action() -> None:
    graph = node_graph(
        ["/quiet"],
        [
            ("/server", "service_servers", SEND, f"{TYPE}_SendGoal"),
            ("/server", "service_servers", "/go/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
            ("/server", "publishers", FEEDBACK, f"{TYPE}_FeedbackMessage"),
            ("/client", "service_clients", SEND, f"{TYPE}_SendGoal"),
            ("/client", "subscribers", FEEDBACK, f"{TYPE}_FeedbackMessage"),
        ],
    )
    client, quiet, server = graph.nodes
    assert client.sent("action") == {"/go": ["nav2_msgs/NavigateToPose"]}
    assert server.taken("action") == {"/go": ["nav2_msgs/NavigateToPose"]}
    assert [node.sent("service") or node.taken("service") for node in graph.nodes] == [{}, {}, {}]
    assert [node.sent("topic") or node.taken("topic") for node in graph.nodes] == [{}, {}, {}]
    assert quiet.name == "/quiet"


def test_nodes_of_one_name_are_one_node_and_the_order_does_not_matter() -> None:
    endpoints = [
        ("/base", "subscribers", "/b", "std_msgs/msg/Bool"),
        ("/base", "subscribers", "/a", "std_msgs/String"),
        ("/base", "subscribers", "/a", "std_msgs/msg/Bool"),
    ]
    graph = node_graph(["/base", "/base"], endpoints)
    assert graph == node_graph(["/base"], reversed(endpoints))
    assert [dict(node.subscribers) for node in graph.nodes] == [
        {"/a": ["std_msgs/Bool", "std_msgs/String"], "/b": ["std_msgs/Bool"]}
    ]
    assert graph.as_json() == node_graph(["/base"], reversed(endpoints)).as_json()


def test_a_written_graph_is_read_again(tmp_path: Path) -> None:
    graph = node_graph(["/x"], [("/left/base", "service_servers", "/left/reset", "std_srvs/srv/Empty")])
    file = tmp_path / "graph.json"
    file.write_text(graph.as_json())
    assert reading.read(str(file)) == graph


@pytest.mark.parametrize(
    ("pattern", "names"),
    [
        ("/arm/*", ["/arm/driver"]),
        ("base", ["/base"]),
        ("*/driver", ["/arm/driver"]),
        ("/ba", []),
        ("*", ["/arm/driver", "/base"]),
    ],
)
def test_patterns_of_names(pattern: str, names: list[str]) -> None:
    assert [node.name for node in node_graph(["/base", "/arm/driver"], []).named([pattern])] == names


FAULTS = {
    "[]": ["1:1 the file must be an object"],
    '{"nodes": [],}': ["1:14 not JSON: Expecting property name enclosed in double quotes"],
    '{"nodes": [], "nodes": []}': ['1:15 the key "nodes" occurs twice'],
    '{"nodes": [{"publishers": {}}]}': ['1:12 the key "nodes.0.name" is missing'],
    '{"nodes": [{"name": "base", "subscriber": {}}]}': [
        '1:13 "nodes.0.name" must be a full name, such as /cmd_vel',
        '1:29 unknown key "nodes.0.subscriber"',
    ],
    '{"nodes": [{"name": "/b", "publishers": {"x": ["y"], "/z": "a/B"}}]}': [
        '1:42 "nodes.0.publishers.x" must be a full name, such as /cmd_vel',
        '1:48 "nodes.0.publishers.x.0" must be a type, such as geometry_msgs/Twist',
        '1:54 "nodes.0.publishers./z" must be an array',
    ],
    '{"nodes": [{"name": "/b", "subscribers": {"/z": []}}]}': [
        '1:43 "nodes.0.subscribers./z" must have a type',
    ],
}


@pytest.mark.parametrize("text", FAULTS, ids=range(len(FAULTS)))
def test_all_faults_are_found_at_their_places(tmp_path: Path, text: str) -> None:
    file = tmp_path / "graph.json"
    file.write_text(text)
    with pytest.raises(ModelError) as error:
        reading.read(str(file))
    found = [f"{each.span.line}:{each.span.column} {each.message}" for each in error.value.diagnostics]
    assert found == FAULTS[text]
    assert {each.rule for each in error.value.diagnostics} == {reading.RULE}


def test_the_page_of_the_rule_is_right(tmp_path: Path) -> None:
    page = locate(f"docs/rules/{reading.RULE}.md").read_text()
    wrong, right = (part.split("```")[0] for part in page.split("```json\n")[1:])
    file = tmp_path / "graph.json"
    file.write_text(right)
    assert isinstance(reading.read(str(file)), NodeGraph)
    file.write_text(wrong)
    with pytest.raises(ModelError) as error:
        reading.read(str(file))
    assert len(error.value.diagnostics) == 2


def test_the_shipped_schema_is_up_to_date_and_agrees(golden: Callable[[Path, str], None]) -> None:
    shipped = locate("schemas/node-graph.schema.json")
    golden(shipped, reading.schema())
    validator = jsonschema.Draft202012Validator(json.loads(shipped.read_text()))
    validator.check_schema(validator.schema)
    graph = node_graph(["/x"], [("/x", "action_servers", "/go", TYPE)])
    assert list(validator.iter_errors(json.loads(graph.as_json()))) == []
    assert list(validator.iter_errors({"nodes": [{"name": "x"}]}))
