"""The controller as a ROS 1 package: a node with its build and launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.cpp.node import Node
from robosc.m2t.cpp.packages import Target, message_packages, package
from robosc.m2t.cpp.preconditions import preconditions
from robosc.m2t.roscpp import header

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models, TraceTest

__all__ = ["generate", "preconditions"]

#: The topics of an action: what ROS 1 re-maps is these, not the action's own name.
_ACTION = ["/goal", "/cancel", "/status", "/feedback", "/result"]

_FILES = {"config/{name}.yaml": "parameters.yaml.j2"}
_TEST_FILES = {
    "Dockerfile": "Dockerfile.j2",
    "test/play_trace.py": "play_trace.py.j2",
    "test/play_trace.test": "play_trace.test.j2",
}


def generate(models: Models, configuration: Configuration, tests: TraceTest | None = None) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""
    graph = models.rosgraph
    assert graph is not None
    node = Node(graph, configuration.on_shutdown, configuration.on_withheld)
    headers = {header(each) for each in node.interfaces} | {"ros/callback_queue.h", "ros/ros.h"}
    if configuration.publish_state_information:
        headers.add("std_msgs/String.h")
    own = ("interruption.hpp", "wiring.hpp", *(["event_queue.hpp"] if node.clients else []))
    target = Target("robosc.m2t.ros1", ".launch", own, _FILES | (_TEST_FILES if tests else {}), ("robosc.m2t.roscpp",))
    libraries = {"rosconsole", "roscpp", "xmlrpcpp"} | ({"actionlib"} if node.actions else set())
    values = {
        "headers": sorted(headers),
        "dependencies": sorted(libraries | message_packages(node, configuration)),
        "names": list(_names(node)),
        "tests": tests,
    }
    files = package(target, graph, node, configuration, values)
    return files | ({f"test/{path}": text for path, text in tests.files.items()} if tests else {})


def _names(node: Node) -> Iterator[tuple[str, str, str, list[str]]]:
    """What a launch file re-maps, each name once: its kind, a word for it, the name, the ends of what it stands for."""
    topics = {each.topic: each.word for each in node.subscriptions}
    topics |= {each.topic: each.word for each in node.publishers}
    for topic, word in topics.items():
        yield "topic", word, topic, [""]
    for service in node.services:
        yield "service", service.word, service.name, [""]
    for action in node.actions:
        yield "action", action.word, action.name, _ACTION
