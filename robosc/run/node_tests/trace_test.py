"""Test of one node: the traces to play, their player, and the start parameters of the node."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.wording import words
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.language.configuration.names import configured_names
from robosc.m2t.models import TraceTest
from robosc.model import sct
from robosc.model.semantics.printing import SctPrinter
from robosc.model.semantics.roles import event_name
from robosc.run.node_tests.tour import tour_of
from robosc.run.runtime.core.event_log import nest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from os import PathLike

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.m2t.targets import Target
    from robosc.model import rosgraph
    from robosc.run.node_tests.coverage import Goal
    from robosc.run.node_tests.samples import IncomingKind
    from robosc.run.runtime.core.port import Client, Server


def trace_test_of(
    target: Target, models: Models, configuration: Configuration, interface_paths: Sequence[str] = ()
) -> TraceTest | None:
    """Return the test for the package of a target; None if the target has none.

    Precondition: the models have a supervisor, and the ROS graph if the target needs it. `interface_paths` are folders
    in which ROS types are looked up, as `robosc.base.ros_types` does.
    """
    if target.tested_ros is None:
        return None
    assert models.rosgraph is not None
    return trace_test(models.rosgraph, configuration, target.tested_ros, interface_paths)


def trace_test(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    version: int,
    interface_paths: Iterable[str | PathLike[str]] = (),
) -> TraceTest:
    """Return the test of the controller of a graph whose model has a supervisor, for ROS 1 or 2 (`version`).

    ROS types are looked up as `check` does. For an unknown type, numbers are tried that all types of its kind hold. The
    same call returns the same test.
    """
    distribution = RosTypes(interface_paths).distribution(version)
    tour = tour_of(graph, configuration, distribution)
    started = tour.parameters
    files = player_files(graph, configuration, started, tour.incoming)
    for number, lines in enumerate(tour.traces, 1):
        files[f"traces/tour_{number}.jsonl"] = "".join(f"{line}\n" for line in lines)
    return TraceTest(started, files, str(tour.coverage), [describe_goal(goal) for goal in tour.coverage.missed])


def player_files(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    started: Mapping[str, bool | int],
    incoming: Mapping[sct.Event, IncomingKind],
) -> dict[str, str]:
    """Return the player's files with its description of a node started with these parameters: file to text."""
    with configured_names(graph, configuration):
        connected = json.dumps(_connections(graph, configuration, started, incoming), indent=1) + "\n"
    player = locate("run/node_tests/trace_player.py").read_text(encoding="utf-8")
    return {"connections.json": connected, "trace_player.py": player}


def describe_goal(goal: Goal) -> str:
    """Return a goal in words: `the guard of the request to move is false`."""
    if isinstance(goal.of, sct.Event):
        alone = f" for `{SctPrinter()(goal.cause)}` alone" if goal.cause is not None else ""
        return f"the guard of the {words(goal.of)} is {str(goal.value).lower()}{alone}"
    line = f" (line {goal.of.source.span.line})" if goal.of.source else ""
    return f"the transition on the {words(goal.of.event)}{line} is {'' if goal.value else 'not '}taken"


def _connections(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    started: Mapping[str, bool | int],
    incoming: Mapping[sct.Event, IncomingKind],
) -> dict[str, Any]:
    """Return the player's description of the node."""
    return {
        "node": configuration.package_name(graph),
        "managed": configuration.lifecycle is not None,
        "period": started["period_ms"] / 1000,
        "timed": any(event.timer is not None for plant in graph.model.plants for event in plant.events),
        "subscriptions": [
            {
                "topic": topic.topic,
                "type": _type(topic.interface),
                **describe_incoming(incoming[topic.receptions[0].event]),
            }
            for topic in graph.subscriptions
        ],
        "publishers": [
            {
                "topic": publisher.topic,
                "type": _type(publisher.interface),
                "best_effort": _is_best_effort(publisher.topic, configuration),
                "events": [event_name(sending.event) for sending in publisher.sendings],
            }
            for publisher in graph.publishers
        ],
        "services": [
            {
                **_client(service, started),
                "timeout": started["service_timeout_ms"] / 1000,
                "response": describe_incoming(incoming[service.response.event]),
            }
            for service in graph.serviceClients
        ],
        "actions": [
            {
                **_client(action, started),
                "cancel": event_name(action.cancel),
                "failure": describe_incoming(incoming[action.error.event]),
                "canceled": describe_incoming(incoming[action.canceled.event]),
                "feedback": describe_incoming(incoming[action.feedback.event]),
                "response": describe_incoming(incoming[action.response.event]),
            }
            for action in graph.actionClients
        ],
        "serviceServers": [
            {**_server(service, incoming), "response": _event(service.response)} for service in graph.serviceServers
        ],
        "actionServers": [
            {
                **_server(action, incoming),
                "cancel": None if action.cancel is None else event_name(action.cancel),
                "feedback": _event(action.feedback),
                "response": _event(action.response),
                "error": _event(action.error),
                "canceled": _event(action.canceled),
            }
            for action in graph.actionServers
        ],
    }


def _client(client: Client, started: Mapping[str, bool | int]) -> dict[str, Any]:
    return {
        "name": client.identifier,
        "type": _type(client.interface),
        "trigger": event_name(client.request.event),
        "error": event_name(client.error.event),
        "reset": event_name(client.reset),
        "retry": started["retry_ms"] / 1000,
    }


def _server(server: Server, incoming: Mapping[sct.Event, IncomingKind]) -> dict[str, Any]:
    return {
        "name": server.identifier,
        "type": _type(server.interface),
        "request": describe_incoming(incoming[server.request.event]),
    }


def _event(sending: rosgraph.Sending | None) -> str | None:
    return None if sending is None else event_name(sending.event)


def describe_incoming(kind: IncomingKind) -> dict[str, Any]:
    """Return the player's description of one kind of incoming data."""
    return {
        "events": [
            {
                "event": event,
                **({"unreadable": True} if event in kind.unreadable else {}),
                "reads": [{"path": list(logged.path), "converted": logged.conversion is not None} for logged in shown],
            }
            for event, shown in kind.events
        ],
        "samples": [
            {"literals": list(literals), "message": nest(samples[0])}
            for literals, samples in kind.samples.items()
            if literals
        ],
    }


def _type(interface: rosgraph.Interface) -> str:
    return f"{interface.package}/{interface.type}"


def _is_best_effort(topic: str, configuration: Configuration) -> bool:
    chosen = configuration.qos.get(topic.removeprefix("/"))
    return chosen is not None and chosen.reliability == "best_effort"
