"""ROS 1 packages: catkin, launch files in XML, callback queues."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from robosc.m2t.ros.values import BuildValues
from robosc.model import rosgraph

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.ros.node import GeneratedNode
    from robosc.m2t.ros.packages import UsedPackages

#: Topics of an action. ROS 1 remaps these, not the action's own name.
_ACTION = ("goal", "cancel", "status", "feedback", "result")


@dataclass(frozen=True)
class Ros1Values(BuildValues):
    """Values of a ROS 1 package: `names` are those that its launch file remaps."""

    names: Sequence[tuple[str, str, str, Sequence[str]]]


class Ros1:
    """ROS 1, as a `robosc.m2t.ros.packages.Middleware`."""

    version: ClassVar[int] = 1
    launch_file: ClassVar[str] = ".launch"
    test_files: ClassVar[Mapping[str, str]] = {
        "Dockerfile": "Dockerfile.j2",
        "test/play_trace.py": "play_trace.py.j2",
        "test/play_trace.test": "play_trace.test.j2",
    }

    def header(self, interface: rosgraph.Interface) -> str:
        """Return the header of a type: `std_srvs/SetBool.h`, or `nav2_msgs/NavigateToPoseAction.h` of an action."""
        action = "Action" if interface.kind == rosgraph.InterfaceKind.action else ""
        return f"{interface.package}/{interface.type}{action}.h"

    def controller(
        self,
        node: GeneratedNode,
        configuration: Configuration,  # noqa: ARG002
        used: UsedPackages,
        *,
        tests: bool,
    ) -> Ros1Values:
        """Return the template values of a controller; see `Middleware`."""
        libraries = {"rosconsole", "roscpp", "xmlrpcpp", *(["actionlib"] if node.actions else [])}
        if any(server.is_action for server in node.servers):
            libraries |= {"actionlib", "actionlib_msgs"}
        built = sorted({*libraries, *used.types})
        tested = ["rosgraph_msgs", "rospy", "rostest"] if tests else []
        return Ros1Values(
            headers=self._headers(node, used.reports),
            build_tool="catkin",
            dependencies=built,
            package_depends=[("build_", built), ("exec_", built), ("test_", tested)],
            names=list(_names(node)),
        )

    def _headers(self, node: GeneratedNode, reports: Sequence[rosgraph.Interface]) -> list[str]:
        return sorted({self.header(interface) for interface in [*node.interfaces, *reports]} | {"ros/ros.h"})


def _names(node: GeneratedNode) -> Iterator[tuple[str, str, str, list[str]]]:
    """Return the names that a launch file remaps, each once: kind, word, name, and suffixes of the topics."""
    topics = {topic.topic: topic.word for topic in node.subscriptions}
    topics |= {topic.topic: topic.word for topic in node.publishers}
    for topic, word in topics.items():
        yield "topic", word, topic, [""]
    for end in (*node.services, *(server for server in node.servers if not server.is_action)):
        yield "service", end.word, end.name, [""]
    for end in (*node.actions, *(server for server in node.servers if server.is_action)):
        yield "action", end.word, end.name, [f"/{part}" for part in _ACTION]
