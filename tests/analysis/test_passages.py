"""Passages to a robot: through its layer, and around it."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

import robosc
from robosc.analysis.passages import Outcome, Passages, passages
from robosc.base.files.resources import locate
from robosc.base.node_graph import Endpoint, node_graph

USHER = Path(__file__).parents[1] / "m2t" / "layer" / "usher.rscd"
GRAPH = robosc.to_rosgraph(robosc.load(USHER))
SPEED, GO, LIGHT = "std_msgs/msg/Float32", "nav2_msgs/action/NavigateToPose", "std_srvs/srv/SetBool"
ROBOT: list[Endpoint] = [
    ("/base", "subscribers", "/speed", SPEED),
    ("/base", "subscribers", "/label", "std_msgs/msg/String"),
    ("/base", "service_servers", "/lamp/light", LIGHT),
    ("/base", "service_servers", "/base/set_parameters", "rcl_interfaces/srv/SetParameters"),
    ("/base", "subscribers", "/clock", "rosgraph_msgs/msg/Clock"),
    ("/navigator", "action_servers", "/go_to", GO),
]
LAYER: list[Endpoint] = [
    ("/usher_layer", "publishers", "/speed", SPEED),
    ("/usher_layer", "publishers", "/label", "std_msgs/msg/String"),
    ("/usher_layer", "service_clients", "/lamp/light", LIGHT),
    ("/usher_layer", "action_clients", "/go_to", GO),
    ("/usher_layer", "subscribers", "/usher_layer/controller/speed", SPEED),
]


def look(*more: Endpoint, robot: list[str] | None = None, exceptions: list[str] | None = None) -> Passages:
    nodes = node_graph([], [*ROBOT, *LAYER, *more])
    return passages(GRAPH, nodes, "usher_layer", robot or [], exceptions or [])


def found(answer: Passages) -> dict[str, Outcome]:
    return {passage.name: passage.outcome for passage in answer.passages}


def evidence(answer: Passages, name: str) -> str:
    (text,) = (passage.evidence for passage in answer.passages if passage.name == name)
    return text


def test_a_robot_that_only_the_layer_commands_is_complete() -> None:
    answer = look(("/driver", "publishers", "/usher_layer/controller/speed", SPEED))
    assert answer.is_complete
    assert set(found(answer).values()) == {Outcome.PASSES}
    assert [passage.name for passage in answer.passages] == ["/label", "/speed", "/lamp/light", "/go_to"]
    assert answer.robot == ["/base", "/navigator"]
    assert evidence(answer, "/speed") == "from /driver to /base"
    assert evidence(answer, "/go_to") == "from no node yet to /navigator"


@pytest.mark.parametrize(
    ("endpoint", "words"),
    [
        (("/teleop", "publishers", "/speed", SPEED), "/teleop publishes it"),
        (("/panel", "service_clients", "/lamp/light", LIGHT), "/panel calls it"),
        (("/planner", "action_clients", "/go_to", GO), "/planner sends goals"),
        (("/planner", "service_clients", "/go_to/_action/send_goal", f"{GO}_SendGoal"), "/planner sends goals"),
        (("/base", "publishers", "/speed", SPEED), "/base publishes it"),
    ],
)
def test_a_node_that_sends_a_command_goes_around(endpoint: Endpoint, words: str) -> None:
    answer = look(endpoint)
    assert not answer.is_complete
    name = endpoint[2].removesuffix("/_action/send_goal")
    assert {each for each, outcome in found(answer).items() if outcome is Outcome.AROUND} == {name}
    assert evidence(answer, name) == words


def test_what_the_model_does_not_have_is_a_hole_also_without_a_sender() -> None:
    horn, reset = ("/base", "subscribers", "/horn", "std_msgs/msg/Bool"), ("/base", "service_servers", "/reset", LIGHT)
    answer = look(horn, reset)
    assert found(answer)["/horn"] is found(answer)["/reset"] is Outcome.MISSING
    assert evidence(answer, "/horn") == "no node uses it yet; taken by /base"
    used = look(horn, ("/panel", "publishers", "/horn", "std_msgs/msg/Bool"))
    assert evidence(used, "/horn") == "/panel publishes it; taken by /base"
    assert not used.is_complete
    assert look(horn, reset, exceptions=["/horn", "res*"]).is_complete


def test_what_the_robot_sends_itself_and_sensor_data_are_no_holes() -> None:
    answer = look(
        ("/base", "subscribers", "/wheels", SPEED),
        ("/navigator", "publishers", "/wheels", SPEED),
        ("/navigator", "subscribers", "/imu", "sensor_msgs/msg/Imu"),
        ("/base", "subscribers", "/scan", "sensor_msgs/msg/LaserScan"),  # the layer reads it, too
    )
    assert answer.is_complete
    assert (found(answer)["/wheels"], found(answer)["/imu"]) == (Outcome.INTERNAL, Outcome.SENSOR)
    assert found(answer)["/scan"] is Outcome.SENSOR
    joy = look(("/base", "subscribers", "/joy", "sensor_msgs/msg/Joy"))
    assert found(joy)["/joy"] is Outcome.MISSING


def test_a_topic_that_robot_and_layer_hear_is_listed() -> None:
    heard = GRAPH.subscriptions[0].topic
    answer = look(("/base", "subscribers", heard, SPEED), ("/teleop", "publishers", heard, SPEED))
    assert found(answer)[heard] is Outcome.HEARD
    assert evidence(answer, heard) == "from /teleop to /base"


def test_hidden_names_are_holes() -> None:
    """ROS hides them only from lists; an action has five hidden names of its own."""
    hidden: list[Endpoint] = [
        ("/base", "subscribers", "/_fast/speed", SPEED),
        ("/base", "service_servers", "/go_to/_action/boost", LIGHT),
    ]
    usual: list[Endpoint] = [
        ("/base", "service_servers", "/go_to/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
        ("/base", "subscribers", "/go_to/_action/feedback", f"{GO}_FeedbackMessage"),
    ]
    answer = look(*hidden, *usual)
    missing = {name for name, outcome in found(answer).items() if outcome is Outcome.MISSING}
    assert missing == {"/_fast/speed", "/go_to/_action/boost"}


def test_the_robot_is_named_or_it_is_what_takes_a_command() -> None:
    arm: Endpoint = ("/arm", "subscribers", "/joints", SPEED)
    assert "/joints" not in found(look(arm))
    assert found(look(arm, robot=["/arm", "/base"]))["/joints"] is Outcome.MISSING
    assert look(arm, robot=["*"]).robot == ["/arm", "/base", "/navigator"]


def test_other_types_and_commands_that_reach_nothing() -> None:
    nodes = node_graph([], [*ROBOT[:1], ("/base", "subscribers", "/label", "std_msgs/msg/Int8"), *LAYER[:3]])
    answer = passages(GRAPH, nodes, "usher_layer")
    assert found(answer) == {
        "/label": Outcome.OTHER_TYPE,
        "/speed": Outcome.PASSES,
        "/lamp/light": Outcome.NOT_TAKEN,
        "/go_to": Outcome.NOT_SENT,
    }
    assert evidence(answer, "/label") == "the layer sends std_msgs/String; /base: std_msgs/Int8"
    without = passages(GRAPH, node_graph([], ROBOT), "usher_layer")
    assert set(found(without).values()) == {Outcome.NOT_SENT}
    assert without.layers == []


def test_relative_names_are_those_of_the_namespace_of_the_layer() -> None:
    moved = [
        (f"/left{node}", part, "/left/label", kind) for node, part, name, kind in [*ROBOT, *LAYER] if name == "/label"
    ]
    answer = passages(GRAPH, node_graph([], moved), "usher_layer")
    assert answer.layers == ["/left/usher_layer"]
    assert found(answer)["/left/label"] is Outcome.PASSES


def test_the_json_fits_its_schema_and_is_the_same_for_each_order() -> None:
    more: Endpoint = ("/teleop", "publishers", "/speed", SPEED)
    text = look(more).as_json("Usher")
    schema = json.loads(locate("schemas/guard.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(json.loads(text))
    outcomes = schema["properties"]["passages"]["items"]["properties"]["outcome"]["enum"]
    assert outcomes == [outcome.name.lower() for outcome in Outcome]
    nodes = node_graph([], [more, *reversed(LAYER), *reversed(ROBOT)])
    assert passages(GRAPH, nodes, "usher_layer").as_json("Usher") == text
