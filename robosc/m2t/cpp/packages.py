"""What the packages of both kinds of nodes have in common: names, dependencies, files, the engine."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.configuration import NO_STOP, NO_STOP_ON_SILENCE
from robosc.m2t.c import engine
from robosc.m2t.cpp.rendering import fold, node_environment
from robosc.semantics.definition import definition_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.configuration import Configuration
    from robosc.m2t.cpp.node import Node
    from robosc.metamodel import rosgraph

#: Types of geometry_msgs that hold numbers only: no header, no quaternion.
_PLAIN = frozenset(["Accel", "Inertia", "Point", "Point32", "Polygon", "Twist", "Vector3", "Wrench"])


def message_packages(node: Node, configuration: Configuration) -> set[str]:
    """The packages of the types that the node uses, its reports on itself included."""
    reports = {"std_msgs"} if configuration.publish_state_information else set()
    return {each.package for each in node.interfaces} | reports


def has_defaults(interface: rosgraph.Interface) -> bool:
    """Whether a message of this type may hold a header or a quaternion, which the node then sets."""
    if interface.package == "std_msgs":
        return interface.type == "Header"
    if interface.package == "std_srvs":
        return False
    return interface.package != "geometry_msgs" or interface.type not in _PLAIN


@dataclass(frozen=True)
class Target:
    """One kind of ROS: where its templates are, and the ending of its launch files."""

    package: str
    launch_file: str
    #: What its node includes beside the headers of all nodes, each from a template of its name.
    headers: tuple[str, ...] = ()
    #: Files beside those of all targets: path, with `{name}` for the package's name, to template.
    files: Mapping[str, str] = field(default_factory=dict)
    #: Where templates lie that it shares with others, beside those of all nodes.
    shared: tuple[str, ...] = ()


def package(
    target: Target, graph: rosgraph.RosGraph, node: Node, configuration: Configuration, values: Mapping[str, Any]
) -> dict[str, str]:
    """The files of a package by their path in it; `values` is what only this target's templates read."""
    name = configuration.package_name(graph)
    sent = [each.interface for each in node.publishers] + [each.interface for each in node.clients]
    optional = {
        "action_client.hpp": node.actions,
        "countdown.hpp": node.clients or node.subscriptions,
        "defaults.hpp": any(has_defaults(each) for each in sent),
        "definition.hpp": configuration.publish_state_information,
        "service_client.hpp": node.services,
        "watchdog.hpp": node.subscriptions,
    }
    headers = ["data.hpp", "event_log.hpp", "fields.hpp", "json.hpp", "parameters.hpp", *target.headers]
    headers += [header for header, is_used in optional.items() if is_used]
    files = {
        "package.xml": "package.xml.j2",
        "CMakeLists.txt": "CMakeLists.txt.j2",
        f"launch/{name}{target.launch_file}": "launch.j2",
        **{f"include/{name}/{each}": f"{each}.j2" for each in headers},
        f"src/{name}_node.cpp": "node.cpp.j2",
        **{path.format(name=name): template for path, template in target.files.items()},
    }
    values = {
        **values,
        "node": node,
        "package": name,
        "about": configuration.package,
        "description": configuration.package.description or f"The supervisory controller of {graph.name}.",
        "own_headers": sorted(headers),
        "period_ms": configuration.control_loop.period_ms,
        "settings": configuration,
        "no_stop": _no_stop(node, configuration),
        "watchdog_ms": lambda topic: configuration.watchdog_ms.get(topic.removeprefix("/"), 0),
        "publishes_state": configuration.publish_state_information,
        "writes_log": configuration.write_events_to_log,
        "definition": definition_text(graph),
        "has_defaults": has_defaults,
        "frame": lambda topic: configuration.frame_id.get(topic.removeprefix("/"), ""),
    }
    templates = node_environment(target.package, *target.shared)
    texts = {path: templates.get_template(template).render(values) for path, template in files.items()}
    texts[f"src/{name}_node.cpp"] = fold(texts[f"src/{name}_node.cpp"])
    supervisor = engine.generate(graph.model, configuration.control_loop)
    return texts | {f"src/{file}": text for file, text in supervisor.items()}


def _no_stop(node: Node, configuration: Configuration) -> list[tuple[str, str]]:
    """What the node says at its start, under which condition, where nothing would stop its robot."""
    if node.shutdown or not node.publishers:
        return []
    silence = [("watchdog_stops_", NO_STOP_ON_SILENCE)] if node.subscriptions else []
    if configuration.says_how_to_stop:
        return silence
    return [*silence, ("!watchdog_stops_" if silence else "", NO_STOP)]
