"""Starts a controller or a layer as a node."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, TypeVar

from robosc.runtime.core.controller import Controller
from robosc.runtime.core.layer import Layer
from robosc.runtime.core.reports import default_log
from robosc.runtime.core.settings import SafeMessages, Settings, controller_parameters, layer_parameters
from robosc.runtime.core.starting import StartError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.configuration import Configuration
    from robosc.metamodel import rosgraph
    from robosc.runtime.ros1.node import Ros1Port
    from robosc.runtime.ros2.node import Ros2Port

_Acting = TypeVar("_Acting", Controller, Layer)


def run_controller(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    version: int,
    arguments: Sequence[str],
    safe: SafeMessages,
) -> None:
    """Runs the controller of a graph whose model has a supervisor, until the user interrupts it.

    `version` is that of ROS, `arguments` are its own.
    Raises StartError where it can't start.
    """
    name = configuration.package_name(graph)
    port = _port(version, name, graph, configuration, arguments)
    try:
        log = default_log(port.full_name, name) if configuration.write_events_to_log else ""
        settings = Settings(port.parameters(controller_parameters(graph, configuration, log)), configuration)
        controller = _opened(lambda: Controller(graph, settings, port, port.agenda, safe))
        port.open_reports(["state", "definition"] if configuration.publish_state_information else [])
        port.connect(controller)
    except StartError:
        port.close()
        raise
    port.info(_running(port.full_name, graph))
    port.spin(controller)


def run_layer(graph: rosgraph.RosGraph, configuration: Configuration, version: int, arguments: Sequence[str]) -> None:
    """Runs the supervisory layer of a graph whose model has a supervisor, until the user interrupts it.

    No two communications of the graph are on one topic. Raises StartError where it can't start.
    """
    name = configuration.layer_name(graph)
    if version == 1:
        import_module("robosc.runtime.ros1.node")  # finds rospy
        from robosc.runtime.ros1.layer import Ros1Layer as Node  # noqa: PLC0415  # only one of the two is there
    else:
        from robosc.runtime.ros2.layer import Ros2Layer as Node  # type: ignore[assignment]  # noqa: PLC0415
    port = Node(name, graph, configuration, arguments)
    try:
        log = default_log(port.full_name, name) if configuration.write_events_to_log else ""
        settings = Settings(port.parameters(layer_parameters(graph, configuration, log)), configuration)
        layer = _opened(lambda: Layer(graph, settings, port, port.agenda))
        reports = ["state", "definition"] if configuration.publish_state_information else []
        port.open_reports([*reports, "blocked"])
        port.connect(layer, settings)
    except StartError:
        port.close()
        raise
    port.info(_running(port.full_name, graph))
    port.spin(layer)


def _running(name: str, graph: rosgraph.RosGraph) -> str:
    """What a person who has started a node wants to know: that it runs, what it is connected to, how it ends."""
    parts = (
        ("hears", [subscription.topic for subscription in graph.subscriptions]),
        ("sends", [publisher.topic for publisher in graph.publishers]),
        ("calls", [*(client.identifier for client in graph.serviceClients)]),
        ("starts", [*(client.identifier for client in graph.actionClients)]),
    )
    said = "; ".join(f"{verb} {', '.join(names)}" for verb, names in parts if names)
    return f"{name} runs{f': {said}' if said else ''}. Ctrl-C ends it."


def _opened(make: Callable[[], _Acting]) -> _Acting:
    try:
        return make()
    except OSError as error:
        raise StartError(f"the event log {error.filename} can't be written: {error.strerror}") from None


def _port(
    version: int, name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]
) -> Ros1Port | Ros2Port:
    if version == 1:
        from robosc.runtime.ros1.node import Ros1Port  # noqa: PLC0415  # only one of the two is there

        return Ros1Port(name, graph, configuration, arguments)
    from robosc.runtime.ros2.node import Ros2Port  # noqa: PLC0415

    return Ros2Port(name, graph, configuration, arguments)
