"""Packages of controllers and supervisory layers: names, dependencies, files, the engine."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Protocol

from robosc.base.files.resources import locate
from robosc.language.configuration import (
    ABSOLUTE_NAMES,
    LICENSE_TEXTS,
    NO_STOP,
    NO_STOP_ON_SILENCE,
    NO_STOP_ON_VIOLATION,
    REPORTS_VIOLATIONS,
)
from robosc.language.configuration.parameters import controller_parameters, layer_parameters
from robosc.m2t.c import engine
from robosc.m2t.c.names import KEYWORDS
from robosc.m2t.ros import preconditions, typed_state
from robosc.m2t.ros.gates import gates
from robosc.m2t.ros.layer import LayerNode
from robosc.m2t.ros.names import CppNames
from robosc.m2t.ros.node import GeneratedNode, Variable
from robosc.m2t.ros.rendering import fold, node_environment
from robosc.m2t.ros.statuses import statuses
from robosc.m2t.ros.values import NodeValues
from robosc.model import rosgraph
from robosc.model.semantics.definition import definition_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence, Set

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.configuration import Configuration
    from robosc.language.configuration.parameters import Parameter
    from robosc.m2t.models import Models, TraceTest
    from robosc.m2t.ros.statuses import Status
    from robosc.m2t.ros.values import BuildValues
    from robosc.model.engine import EngineModel

#: Files of a stand-alone package: path to template.
_PACKAGE = {name: f"{name}.j2" for name in ("package.xml", "CMakeLists.txt", "README.md", "CHANGELOG.rst")}
#: Types of geometry_msgs that contain only numbers: no header, no quaternion.
_PLAIN = frozenset(["Accel", "Inertia", "Point", "Point32", "Polygon", "Twist", "Vector3", "Wrench"])
_INCLUDED = re.compile(r'^#include "(robosc[^"]*)"$', re.MULTILINE)

#: Headers in `include`, each with the features of a node that need it (empty: always). `{ros}` is the ROS version.
_HEADERS = {
    "robosc/absolute_names": {"absolute"},
    "robosc/block_reasons": {"gates"},
    "robosc/component_status": {"statuses"},
    "robosc/data": set(),
    "robosc/event_log": set(),
    "robosc/fields": {"composes"},
    "robosc/json": set(),
    "robosc/message_headers": {"composes", "defaults"},
    "robosc/throttle": {"blocks"},
    "robosc/violations": {"assumptions"},
    "robosc/transitions": {"state"},
    "robosc/unheard": {"controller", "awaits"},
    "robosc/watchdog": {"controller", "subscriptions"},
    "robosc_ros{ros}/alarm": {"timed"},
    "robosc_ros{ros}/action_client": {"controller", "actions"},
    "robosc_ros{ros}/action_proxy": {"layer", "actions"},
    "robosc_ros{ros}/bond": {"controller", "bond", "ros2"},
    "robosc_ros{ros}/action_server": {"controller", "served_actions"},
    "robosc_ros{ros}/arrivals": {"controller", "ros2", "subscriptions", "timed"},
    "robosc_ros{ros}/countdown": {"controller", "waits"},
    "robosc_ros{ros}/finite": {"composes", "hands_on"},
    "robosc_ros{ros}/controller_node": {"controller"},
    "robosc_ros{ros}/graph_monitor": {"layer", "ros2"},
    "robosc_ros{ros}/guarded_node": {"layer", "ros2"},
    "robosc_ros{ros}/managed_node": {"controller", "managed", "ros2"},
    "robosc_ros{ros}/message_relay": {"layer", "topics"},
    "robosc_ros{ros}/parameters": set(),
    "robosc_ros{ros}/report": {"reports"},
    "robosc_ros{ros}/run_controller": {"controller", "ros1"},
    "robosc_ros{ros}/service_client": {"controller", "services"},
    "robosc_ros{ros}/service_proxy": {"layer", "services"},
    "robosc_ros{ros}/service_server": {"controller", "served_services"},
    "robosc_ros{ros}/shutdown_hook": {"layer", "actions", "ros2"},
    "robosc_ros{ros}/unit_quaternions": {"quaternions", "ros1"},
}

_MESSAGE = rosgraph.InterfaceKind.message
#: Types of reports: JSON, and statuses of components.
_TEXT = rosgraph.Interface(package="std_msgs", type="String", kind=_MESSAGE)
_STATUSES = rosgraph.Interface(package="diagnostic_msgs", type="DiagnosticArray", kind=_MESSAGE)
_HEARTBEATS = rosgraph.Interface(package="bond", type="Status", kind=_MESSAGE)


@dataclass(frozen=True)
class UsedPackages:
    """Packages of the types that a node uses, and the types of its reports."""

    types: Set[str]
    reports: Sequence[rosgraph.Interface]


class Middleware(Protocol):
    """Differences between ROS 1 and ROS 2. A folder of its name beside this file has its templates."""

    #: ROS version: 1 or 2.
    version: ClassVar[int]
    #: Suffix of launch files.
    launch_file: ClassVar[str]
    #: Files that `--with-tests` adds to a controller: path to template.
    test_files: ClassVar[Mapping[str, str]]

    def spelled(self, interface: rosgraph.Interface) -> str:
        """Return the name of a type as the tools of this ROS version print it."""

    def controller(
        self, node: GeneratedNode, configuration: Configuration, used: UsedPackages, *, tests: bool
    ) -> BuildValues:
        """Return the template values of a controller that depend on the ROS version."""


@dataclass(frozen=True)
class RosTarget:
    """A target that is a ROS package: a controller or a layer, for one ROS version."""

    kind: Literal["controller", "layer"]
    ros: Middleware
    #: Function that returns the template values of a layer that depend on the ROS version.
    layer: Callable[[LayerNode, Configuration, UsedPackages], BuildValues] | None = None

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """Return errors that make such a node impossible, and warnings on settings without effect."""
        return preconditions.preconditions(models, configuration, self.kind, self.ros.version)

    def generate(
        self,
        models: Models,
        configuration: Configuration,
        tests: TraceTest | None = None,
        into: str | None = None,
    ) -> dict[str, str]:
        """Return the files of the package by their path in it. Precondition: `preconditions` reports no error.

        `into` names a package of the user that includes the node through `fragment.cmake`.
        """
        graph = models.rosgraph
        assert graph is not None
        executed = models.engine
        if self.kind == "layer":
            node, name = (
                GeneratedNode(graph, executed, on_blocked=configuration.on_blocked),
                configuration.layer_name(graph),
            )
        else:
            node = GeneratedNode(graph, executed, configuration.on_shutdown, configuration.on_withheld)
            name = configuration.package_name(graph)
        return self._files(graph, executed, name, configuration, node, tests, into)

    def interfaces(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Return the package with the type of the robot's state, if the configuration needs one: text by path.

        The package is beside the node's package. Each path starts with its name.
        """
        graph = models.rosgraph
        assert graph is not None
        if not configuration.typed_state:
            return {}
        package = configuration.interfaces_name(graph)
        values = {
            "ros": self.ros.version,
            "robot": graph.name,
            "package": package,
            "about": configuration.package,
            "has_license": bool(_license(configuration)),
            "message": typed_state.MESSAGE,
            "fields": typed_state.fields(graph, CppNames(graph)),
        }
        templates = node_environment(f"robosc.m2t.ros.ros{self.ros.version}")
        files = {
            "package.xml": "interfaces_package.xml.j2",
            "CMakeLists.txt": "interfaces_CMakeLists.txt.j2",
            f"msg/{typed_state.MESSAGE}.msg": "State.msg.j2",
            **_license(configuration),
        }
        return {f"{package}/{path}": templates.get_template(name).render(values) for path, name in files.items()}

    def _files(  # noqa: PLR0913, PLR0917
        self,
        graph: rosgraph.RosGraph,
        executed: EngineModel,
        name: str,
        configuration: Configuration,
        node: GeneratedNode,
        tests: TraceTest | None,
        into: str | None,
    ) -> dict[str, str]:
        kind, ros = self.kind, self.ros
        commands = gates(graph, node, executed)
        if not configuration.diagnostics_ms and kind != "layer":
            commands = {sending: gate for sending, gate in commands.items() if sending.inputs}
        layer = LayerNode(graph, node, commands.values(), executed) if kind == "layer" else None
        reported_statuses = statuses(graph, node, commands) if configuration.diagnostics_ms else []
        included = self._included(node, layer, reported_statuses, configuration)
        source, definition = f"src/{name}_node.cpp", f"include/{name}/definition.hpp"
        # Users rarely set a layer's parameters, except for the model's own.
        has_file = kind == "controller" or bool(node.parameters)
        declared = (layer_parameters if layer else controller_parameters)(graph, configuration, "")
        library = _library(declared, configuration) if ros.version == 2 else {}
        files = {
            **({"fragment.cmake": "fragment.cmake.j2"} if into else _PACKAGE | _license(configuration)),
            f"launch/{name}{ros.launch_file}": f"{kind}_launch.j2",
            source: f"{kind}_node.cpp.j2",
            **({f"config/{name}.yaml": "parameters.yaml.j2"} if has_file else {}),
            **({f"src/{name}_parameters.yaml": "library.yaml.j2"} if library else {}),
            **({definition: "definition.hpp.j2"} if configuration.publish_state_information else {}),
            **(_test_files(ros, name, into) if tests else {}),
        }
        stops_on_violation = configuration.stops_on_violation(graph.model)
        reports_blocked = bool(layer.gates if layer else node.decided)
        texts_told = configuration.publish_state_information or reports_blocked
        typed = typed_state.fields(graph, CppNames(graph)) if configuration.typed_state else []
        kind_of_state = rosgraph.Interface(
            package=configuration.interfaces_name(graph), type=typed_state.MESSAGE, kind=_MESSAGE
        )
        reports = [
            *([_TEXT] if texts_told else []),
            *([_STATUSES] if reported_statuses else []),
            *([kind_of_state] if configuration.typed_state else []),
        ]
        types = {interface.package for interface in [*node.interfaces, *reports]}
        used = UsedPackages({package for package in types if package != into}, reports)
        own = [definition.removeprefix("include/")] if configuration.publish_state_information else []
        text = f"The {'supervisory controller' if kind == 'controller' else 'supervisory layer'} of {graph.name}."
        values = NodeValues(
            kind=kind,
            node=node,
            layer=layer,
            tests=tests,
            package=name,
            ros_package=into or name,
            has_own_types=into in types,
            player=_player(name, into),
            about=configuration.package,
            has_license=bool(_license(configuration)),
            described_reports=_described(
                reports_blocked,
                reported_statuses,
                kind_of_state,
                configuration,
                has_bond=configuration.has_bond and ros.version == 2 and not layer,
            ),
            spelled=ros.spelled,
            description=configuration.package.description or text,
            included=sorted([*own, *(f"{header}.hpp" for header in included)]),
            settings=configuration,
            parameters={parameter.name: parameter for parameter in declared},
            has_parameters_file=has_file,
            library=library,
            # The launch file of a layer has an argument for its log.
            parameter_groups=_groups(
                parameter
                for parameter in declared
                if kind == "controller" or parameter.name != "event_log" or configuration.write_events_to_log
            ),
            publishes_state=configuration.publish_state_information,
            statuses=reported_statuses,
            typed_fields=typed,
            typed=kind_of_state if configuration.typed_state else None,
            remembers=bool(node.may_withhold and (reported_statuses or node.instead)),
            gates=list(commands.values()),
            reports_blocked=reports_blocked,
            writes_log=configuration.write_events_to_log,
            definition=definition_text(graph),
            no_stop=_no_stop(node, configuration, stops_on_violation=stops_on_violation),
            reports_violations=REPORTS_VIOLATIONS if node.assumed and not stops_on_violation else "",
            stops_on_violation=stops_on_violation,
            awaited=_awaited(node, configuration) if kind == "controller" else [],
            turned=_turned(node) if ros.version == 1 else [],
            has_defaults=has_defaults,
            absolute_warning=ABSOLUTE_NAMES,
            frame=lambda topic: configuration.frame_id.get(topic.removeprefix("/"), ""),
        )
        if layer and self.layer:
            build = self.layer(layer, configuration, used)
        else:
            build = ros.controller(node, configuration, used, tests=tests is not None)
        templates = node_environment(f"robosc.m2t.ros.ros{ros.version}")
        texts = {
            path: templates.get_template(template).render(**vars(values), **vars(build))
            for path, template in files.items()
        }
        texts[source] = fold(texts[source])
        texts |= {f"include/{header}.hpp": text for header, text in shipped_headers(included).items()}
        supervisor = engine.generate(executed, configuration.control_loop)
        # The header of the engine is public in a place where other code finds it.
        places = {".h": f"include/{name}" if into else "src", ".c": "src"}
        texts |= {f"{places[file[-2:]]}/{file}": text for file, text in supervisor.items()}
        return texts | ({f"test/{path}": text for path, text in tests.files.items()} if tests else {})

    def _included(
        self,
        node: GeneratedNode,
        layer: LayerNode | None,
        reported_statuses: Sequence[Status],
        configuration: Configuration,
    ) -> list[str]:
        """Return the headers in `include` that the node includes, without suffix."""
        if self.kind == "controller":
            sent = [owner.interface for owner, _ in node.sent]
        else:
            sent = [last.publisher.interface for last in node.on_blocked]
        composes = self.kind == "controller" or node.on_blocked or node.limited or node.decided
        blocks = layer.gates if layer else node.decided
        defaults = any(has_defaults(interface) for interface in sent)
        present = {
            self.kind: True,
            f"ros{self.ros.version}": True,
            "absolute": configuration.warns_of_absolute_names and any(node.absolute),
            "actions": node.actions,
            "assumptions": node.assumed,
            "awaits": _awaited(node, configuration),
            "blocks": blocks,
            "bond": configuration.has_bond,
            "composes": composes,
            "defaults": defaults,
            "gates": blocks or any(status.commands for status in reported_statuses),
            "hands_on": node.hands_on,
            "managed": configuration.lifecycle,
            "quaternions": (composes and defaults) or _turned(node),
            "reports": configuration.publish_state_information or reported_statuses or blocks,
            "served_actions": any(server.is_action for server in node.servers),
            "served_services": any(not server.is_action for server in node.servers),
            "services": node.services,
            "state": configuration.publish_state_information,
            "statuses": reported_statuses,
            "subscriptions": node.subscriptions,
            "timed": node.at,
            "topics": node.subscriptions or node.publishers,
            "waits": node.clients or node.subscriptions,
        }
        features = {feature for feature, is_there in present.items() if is_there}
        return [name.format(ros=self.ros.version) for name, needed in _HEADERS.items() if needed <= features]


def _license(configuration: Configuration) -> dict[str, str]:
    """Return the path and the template of the license's text, if RoboSC has it."""
    name = configuration.package.license
    return {"LICENSE": f"licenses/{name}.j2"} if name in LICENSE_TEXTS else {}


def _described(
    reports_blocked: bool,
    statuses: Sequence[Status],
    typed: rosgraph.Interface,
    configuration: Configuration,
    *,
    has_bond: bool,
) -> list[tuple[str, rosgraph.Interface, str]]:
    """Return the topics of a node's reports about itself: name, type and content."""
    shown = configuration.publish_state_information
    described = [
        ("~/state", _TEXT, "the state of each component, as JSON", shown),
        ("~/definition", _TEXT, "the model: components, states, transitions, requirements; as JSON", shown),
        ("~/typed_state", typed, "the state of each component", shown and configuration.typed_state),
        ("~/blocked", _TEXT, "each blocked command with the reason, as JSON", reports_blocked),
        ("/diagnostics", _STATUSES, "a status for each component", bool(statuses)),
        ("bond", _HEARTBEATS, "heartbeats for `nav2_lifecycle_manager`", has_bond),
    ]
    return [(name, kind, content) for name, kind, content, published in described if published]


def _turned(node: GeneratedNode) -> list[tuple[Variable, str]]:
    """Return the node's object variables that may hold quaternions, each with its component."""
    return [
        (variable, component)
        for component, variables in node.components
        for variable in variables
        if variable.part and not variable.part.is_array and has_defaults(variable.part.interface)
    ]


def _awaited(node: GeneratedNode, configuration: Configuration) -> list[str]:
    """Return the topics that commands wait for."""
    names = {topic.removeprefix("/") for topic in configuration.wait_for}
    return [topic.topic for topic in node.subscriptions if topic.topic.removeprefix("/") in names]


def _test_files(ros: Middleware, name: str, into: str | None) -> dict[str, str]:
    """Return path to template. A user's package has its own Dockerfile, if any, and possibly several nodes."""
    if not into:
        return dict(ros.test_files)
    own = {path: template for path, template in ros.test_files.items() if path != "Dockerfile"}
    return {path.replace("play_trace.py", _player(name, into)): template for path, template in own.items()}


def _player(name: str, into: str | None) -> str:
    """Return the file name of the program that plays traces. ROS 1 finds it by its name in the whole package."""
    return f"{name}_play_trace.py" if into else "play_trace.py"


def _groups(declared: Iterable[Parameter]) -> dict[str, dict[str, Parameter]]:
    """Group parameters by the part of their names before the last point, "" first."""
    groups: dict[str, dict[str, Parameter]] = {"": {}}
    for parameter in declared:
        group, _, name = parameter.name.rpartition(".")
        groups.setdefault(group, {})[name] = parameter
    return groups


def _library(declared: Iterable[Parameter], configuration: Configuration) -> dict[str, Any]:
    """Return the parameters that generate_parameter_library declares, as a tree by the parts of their names.

    The library makes the parts names in C++. The node itself declares a parameter with a keyword in its name, and the
    event log if its default depends on the name of the node.
    """
    tree: dict[str, Any] = {}
    if configuration.parameters == "library":
        for parameter in declared:
            *outer, name = parameter.name.split(".")
            if KEYWORDS.isdisjoint([*outer, name]) and not (name == "event_log" and configuration.write_events_to_log):
                reduce(lambda level, part: level.setdefault(part, {}), outer, tree)[name] = parameter
    return tree


def shipped_headers(headers: Iterable[str]) -> dict[str, str]:
    """Return headers in `include` by name, such as `robosc/json`, with all that they include: text by name."""
    texts: dict[str, str] = {}
    waiting = list(headers)
    while waiting:
        name = waiting.pop().removesuffix(".hpp")
        if name not in texts:
            texts[name] = (locate("m2t/ros/include") / f"{name}.hpp").read_text(encoding="utf-8")
            waiting += _INCLUDED.findall(texts[name])
    return dict(sorted(texts.items()))


def has_defaults(interface: rosgraph.Interface) -> bool:
    """Return whether a message of this type may hold a header or a quaternion, which the node then sets."""
    if interface.package == "std_msgs":
        return interface.type == "Header"
    if interface.package == "std_srvs":
        return False
    return interface.package != "geometry_msgs" or interface.type not in _PLAIN


def controller_package(configuration: Configuration) -> set[str]:
    """Return the package of the existing controller, if the configuration names one."""
    controller = configuration.supervisor.controller
    return {started.package_name for started in (controller.run, controller.launch) if started}


def launch_path(configuration: Configuration) -> str:
    """Return the launch file's path in the existing controller's package. Empty if the configuration names none."""
    launch = configuration.supervisor.controller.launch
    if launch is None:
        return ""
    return launch.file if "/" in launch.file else f"launch/{launch.file}"


def _no_stop(node: GeneratedNode, configuration: Configuration, *, stops_on_violation: bool) -> list[tuple[str, str]]:
    """Return the warnings at the node's start that nothing stops the robot, with their conditions."""
    if node.shutdown or not node.publishers:
        return []
    silence = [("watchdog_stops_", NO_STOP_ON_SILENCE)] if node.subscriptions else []
    end = [] if configuration.says_how_to_stop else [("!watchdog_stops_" if silence else "", NO_STOP)]
    violation = [("", NO_STOP_ON_VIOLATION)] if stops_on_violation else []
    return [*silence, *end, *violation]
