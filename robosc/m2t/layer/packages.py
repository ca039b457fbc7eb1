"""The package of a layer: names, dependencies, files, the engine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.m2t.c import engine
from robosc.m2t.cpp.rendering import fold, node_environment
from robosc.m2t.layer.node import LayerNode
from robosc.semantics.definition import definition_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models


@dataclass(frozen=True)
class Target:
    """One kind of ROS: where its templates are, and the ending of its launch files."""

    package: str
    launch_file: str
    #: Headers of its own, each with what of a `LayerNode` it is there for; empty: always.
    headers: Mapping[str, str]
    #: Where templates lie that it shares with others, beside those of all layers.
    shared: tuple[str, ...] = ()


def package(
    target: Target, models: Models, configuration: Configuration, values: Callable[[LayerNode], Mapping[str, Any]]
) -> dict[str, str]:
    """The files of a package by their path in it; `values` is what only this target's templates read."""
    graph = models.rosgraph
    assert graph is not None
    layer = LayerNode(graph)
    name = configuration.layer_name(graph)
    used = {
        "action_proxy.hpp": layer.actions,
        "blocked.hpp": layer.passages,
        "data.hpp": True,
        "definition.hpp": configuration.publish_state_information,
        "event_log.hpp": True,
        "json.hpp": True,
        "message_relay.hpp": layer.inward or layer.outward,
        "parameters.hpp": True,
        "service_proxy.hpp": layer.services,
        **{header: not what or getattr(layer, what) for header, what in target.headers.items()},
    }
    headers = sorted(header for header, is_used in used.items() if is_used)
    files = {
        "package.xml": "package.xml.j2",
        "CMakeLists.txt": "CMakeLists.txt.j2",
        f"launch/{name}{target.launch_file}": "launch.j2",
        **{f"include/{name}/{each}": f"{each}.j2" for each in headers},
        f"src/{name}_node.cpp": "node.cpp.j2",
    }
    prepared = {
        **values(layer),
        "layer": layer,
        "node": layer.node,
        "package": name,
        "about": configuration.package,
        "description": configuration.package.description or f"The supervisory layer of {graph.name}.",
        "own_headers": headers,
        "period_ms": configuration.control_loop.period_ms,
        "service_timeout_ms": configuration.services.timeout_ms,
        "action_timeout_ms": configuration.actions.timeout_ms,
        "publishes_state": configuration.publish_state_information,
        "writes_log": configuration.write_events_to_log,
        "controller": configuration.supervisor.controller,
        "definition": definition_text(graph),
    }
    templates = node_environment(target.package, *target.shared, "robosc.m2t.layer")
    texts = {path: templates.get_template(template).render(prepared) for path, template in files.items()}
    source = f"src/{name}_node.cpp"
    texts[source] = fold(texts[source])
    supervisor = engine.generate(graph.model, configuration.control_loop)
    return texts | {f"src/{file}": text for file, text in supervisor.items()}


def type_packages(layer: LayerNode, configuration: Configuration) -> set[str]:
    """The packages of the types that the layer uses, its reports included."""
    reports = {"std_msgs"} if layer.passages or configuration.publish_state_information else set()
    return {each.package for each in layer.node.interfaces} | reports


def controller_package(configuration: Configuration) -> set[str]:
    """The package of the existing controller, where the configuration names one."""
    controller = configuration.supervisor.controller
    return {each.package_name for each in (controller.run, controller.launch) if each}
