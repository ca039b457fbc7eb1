"""Start a controller or a layer as a node."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING, TypeVar

from robosc.language.configuration.parameters import controller_parameters, layer_parameters
from robosc.model.semantics.messages import decides_with_data
from robosc.run.runtime.core.controller import Controller
from robosc.run.runtime.core.event_log import default_log
from robosc.run.runtime.core.gate import GatedLayer
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.node import RunningNode, StartError
from robosc.run.runtime.core.settings import SafeMessages, Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager

    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph
    from robosc.run.runtime.core.port import Server

_Handler = TypeVar("_Handler", bound=Controller | Layer)


def run_controller(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    arguments: Sequence[str],
    safe: SafeMessages,
) -> None:
    """Run the controller of a graph whose model has a supervisor, until the user interrupts it.

    `arguments` are those of ROS. Raises StartError if the node can't start.
    """

    def make(node: RunningNode, log: str) -> tuple[Controller, Settings]:
        settings = Settings(node.parameters(controller_parameters(graph, configuration, log)), configuration)
        return Controller(graph, settings, node, node.event_loop, safe), settings

    name = configuration.package_name(graph)
    _run(_node(name, graph, configuration, arguments), name, graph, configuration, make)


def run_layer(
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    arguments: Sequence[str],
    safe: SafeMessages,
) -> None:
    """Run the supervisory layer of a graph whose model has a supervisor, until the user interrupts it.

    Precondition: no two communications of the graph share a topic. Raises StartError if the node can't start.
    """

    def make(node: RunningNode, log: str) -> tuple[Layer, Settings]:
        settings = Settings(node.parameters(layer_parameters(graph, configuration, log)), configuration)
        return Layer(graph, settings, node, node.event_loop, safe), settings

    name = configuration.layer_name(graph)
    _run(_node(name, graph, configuration, arguments), name, graph, configuration, make)


def run_gate(  # noqa: PLR0913, PLR0917 - a node, its models, and its caller
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    arguments: Sequence[str],
    safe: SafeMessages,
    serve: Callable[[RunningNode, GatedLayer], AbstractContextManager[None]],
    node: RunningNode | None = None,
) -> None:
    """Run the supervisory layer of a graph as `run_layer` does, for a program in this process.

    The context of `serve` lasts as long as the node runs. `node` is the node; by default, it is one of ROS 2.
    """

    def make(node: RunningNode, log: str) -> tuple[GatedLayer, Settings]:
        settings = Settings(node.parameters(layer_parameters(graph, configuration, log)), configuration)
        return GatedLayer(graph, settings, node, node.event_loop, safe), settings

    name = configuration.layer_name(graph)
    _run(node or _node(name, graph, configuration, arguments), name, graph, configuration, make, serve)


def _run(  # noqa: PLR0913, PLR0917 - a node, its models, and its handler
    node: RunningNode,
    name: str,
    graph: rosgraph.RosGraph,
    configuration: Configuration,
    make: Callable[[RunningNode, str], tuple[_Handler, Settings]],
    beside: Callable[[RunningNode, _Handler], AbstractContextManager[None]] = lambda *_: nullcontext(),
) -> None:
    try:
        log = default_log(node.full_name, name) if configuration.write_events_to_log else ""
        try:
            handler, settings = make(node, log)
        except OSError as error:
            raise StartError(f"the event log {error.filename} cannot be written: {error.strerror}") from None
        reports = ["state", "definition"] if configuration.publish_state_information else []
        node.open_reports([*reports, "blocked"] if isinstance(handler, Layer) or decides_with_data(graph) else reports)
        if settings.parameters.get("diagnostics_ms"):
            node.open_diagnostics()
        node.connect(handler, settings)
    except StartError:
        node.close()
        raise
    node.info(_started(node.full_name, graph, shows=bool(reports) and node.in_graph))
    with beside(node, handler):
        node.spin(handler)


def _node(name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]) -> RunningNode:
    from robosc.run.runtime.ros2.node import Ros2Node  # noqa: PLC0415  # reports what is missing if there is no ROS

    return Ros2Node(name, graph, configuration, arguments)


def _started(name: str, graph: rosgraph.RosGraph, *, shows: bool) -> str:
    """Return the start message for the user: connections of the node, how to view it, how to stop it."""
    servers: list[Server] = [*graph.serviceServers, *graph.actionServers]
    parts = (
        ("hears", [subscription.topic for subscription in graph.subscriptions]),
        ("sends", [publisher.topic for publisher in graph.publishers]),
        ("calls", [client.identifier for client in graph.serviceClients]),
        ("starts", [client.identifier for client in graph.actionClients]),
        ("serves", [server.identifier for server in servers]),
    )
    connected = "; ".join(f"{verb} {', '.join(dict.fromkeys(names))}" for verb, names in parts if names)
    look = " `robosc view` shows it decide." if shows else ""
    return f"{name} runs{f': {connected}' if connected else ''}.{look} Ctrl-C ends it."
