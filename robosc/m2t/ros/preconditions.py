"""Checks of models and settings for a ROS node: located errors, and warnings on settings without effect."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

from robosc.base.diagnostics import START, Diagnostic, Severity
from robosc.base.ros_types import RosTypes
from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import controller_parameters, layer_parameters, model_parameters
from robosc.m2t.c.preconditions import preconditions as engine_preconditions
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.messages import (
    fields_set,
    find_message,
    holds_objects,
    is_constant,
    parts_of,
    path_of,
    source_of,
)
from robosc.model.semantics.roles import assumptions
from robosc.model.semantics.typing import DOUBLE, ArrayType, declared_type, infer

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.m2t.models import Models
    from robosc.model import engine

RULE, LAYER_RULE = "ros-node", "layer-topic"

_PACKAGE = re.compile(r"[a-z]([a-z0-9]|_(?!_))*[a-z0-9]")
_TYPE = re.compile(r"[A-Z][A-Za-z0-9]*")
_EXECUTABLE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*")
_NODE = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")
_FILE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*(/[A-Za-z0-9_][A-Za-z0-9_.+-]*)*")
_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_TOPIC = re.compile(r"(/_*)?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
#: Types of messages that keep a robot moving until the next message.
_MOVING = frozenset(
    [
        "geometry_msgs/Twist",
        "geometry_msgs/TwistStamped",
        "trajectory_msgs/JointTrajectory",
        "trajectory_msgs/MultiDOFJointTrajectory",
    ]
)
#: Parameters that every node has, by ROS version.
_OWN_PARAMETERS = {1: ("log_level",), 2: ("use_sim_time", "start_type_description_service")}
#: Characters that end a string, or have a meaning in it, where build tools copy it into CMake code.
_RISKY = re.compile(r'["\\$;\n\r]')


def preconditions(models: Models, configuration: Configuration, kind: str, ros: int) -> list[Diagnostic]:
    """Return the errors that make a node with these models and settings impossible, and warnings on unused settings.

    `kind` is "controller" or "layer", `ros` the ROS version, 1 or 2.
    """
    graph = models.rosgraph
    if graph is None:
        message = "this model has no ROS graph: generate from the .rscd or the .rosgraph.xmi"
        return [Diagnostic(models.sct.name, START, Severity.ERROR, RULE, message)]
    findings = [*engine_preconditions(models.sct), *_names(graph), *_types(graph)]
    findings += _packages(graph, models.ros_types or RosTypes(), ros)
    findings += _parameters(graph, configuration, kind, ros)
    if configuration.typed_state and not configuration.publish_state_information:
        hint = 'leave out "publishStateInformation": false'
        findings.append(configuration.error(("typedState",), '"typedState" needs "publishStateInformation"', hint))
    findings += _violations(graph, configuration)
    if kind == "controller":
        name = configuration.package_name(graph)
        return [*findings, *_package(graph, configuration, name), *_settings(graph, configuration)]
    return [
        *findings,
        *_served(graph),
        *_package(graph, configuration, configuration.layer_name(graph)),
        *_shared_topics(graph),
        *_unsendable(graph, configuration, "onBlocked", configuration.on_blocked),
        *_unsteady(graph, configuration, "onBlocked", configuration.on_blocked),
        *_swallowed(graph, models.engine, configuration),
        *_controller(configuration),
        *_unused(configuration),
    ]


def _served(graph: rosgraph.RosGraph) -> Iterator[Diagnostic]:
    """Return errors on services and actions that the controller serves. A layer does not see their clients."""
    servers: list[tuple[ex.Located, str, str]] = [
        *((server, server.identifier, "service") for server in graph.serviceServers),
        *((server, server.identifier, "action") for server in graph.actionServers),
    ]
    for server, name, word in servers:
        message = f"the layer does not serve the {word} `{name}`"
        yield _error(server, message, f"leave `outgoing {word}` out, or choose another target")


def _package(graph: rosgraph.RosGraph, configuration: Configuration, name: str) -> Iterator[Diagnostic]:
    """Return errors on the name and settings of a package."""
    if not _PACKAGE.fullmatch(name):
        yield _error(graph, f'"{name}" is not a name of a ROS package', 'set "package.name" in controller-config.json')
    if _RISKY.search(configuration.package.maintainer):
        hint = 'leave out ", \\, $ and ;'
        yield configuration.error(
            ("package", "maintainer"), "the maintainer has characters that break the build of the package", hint
        )


def _error(element: ex.Located, message: str, hint: str | None = None, rule: str = RULE) -> Diagnostic:
    file, span = place(element)
    return Diagnostic(file, span, Severity.ERROR, rule, message, hint)


def _names(graph: rosgraph.RosGraph) -> Iterator[Diagnostic]:
    """Return errors on names that appear in code unchanged, and that ROS would reject at run time."""
    for interface in graph.interfaces:
        if not _PACKAGE.fullmatch(interface.package):
            yield _error(interface, f'"{interface.package}" is not a name of a ROS package')
        if not _TYPE.fullmatch(interface.type):
            yield _error(interface, f'"{interface.type}" is not a name of a ROS type')
    named: list[tuple[ex.Located, str, str]] = [
        *((subscription, subscription.topic, "topic") for subscription in graph.subscriptions),
        *((publisher, publisher.topic, "topic") for publisher in graph.publishers),
        *((client, client.identifier, "service") for client in graph.serviceClients),
        *((client, client.identifier, "action") for client in graph.actionClients),
        *((server, server.identifier, "service") for server in graph.serviceServers),
        *((server, server.identifier, "action") for server in graph.actionServers),
    ]
    for element, name, kind in named:
        if not _TOPIC.fullmatch(name):
            hint = "write letters, digits and underscores, with single slashes between them"
            yield _error(element, f'"{name}" is not a name of a ROS {kind}', hint)
    for element, name in _fields(graph):
        if not _FIELD.fullmatch(name):
            yield _error(element, f'"{name}" is not a name of a field in ROS')


def _packages(graph: rosgraph.RosGraph, ros_types: RosTypes, ros: int) -> Iterator[Diagnostic]:
    """Return errors on types of packages that only the other ROS version has: the node could not be built."""
    distribution, other = ros_types.distribution(ros), ros_types.distribution(3 - ros)
    for interface in graph.interfaces:
        package = interface.package
        if distribution.lacks_package(package):
            message = f"{distribution.name} has no package {package}, only {other.name} has it"
            hint = (
                f"generate for {other.name}; if {package} exists for {distribution.name}, add its folder with"
                " --interface-path or ROBOSC_INTERFACE_PATH"
            )
            yield _error(interface, message, hint)


def _parameters(graph: rosgraph.RosGraph, configuration: Configuration, kind: str, ros: int) -> Iterator[Diagnostic]:
    """Return errors on parameters with a reserved name, or with numbers that ROS cannot hold."""
    declared = (layer_parameters if kind == "layer" else controller_parameters)(graph, configuration, "")
    names = Counter([*_OWN_PARAMETERS[ros], *(parameter.name for parameter in declared)])
    for element, parameter in model_parameters(graph).items():
        if names[parameter.name] > 1:
            yield _error(element, f"the node has a parameter {parameter.name} of its own", "rename it")
        if ros == 1 and isinstance(parameter.default, int) and parameter.bounds is not None:
            low, high = parameter.bounds
            if low < -(2**31) or high >= 2**31:
                message = f"{parameter.name} may be set to {low}..{high}, and parameters of ROS 1 have 32 bits"
                yield _error(element, message, "narrow its range")


def _types(graph: rosgraph.RosGraph) -> Iterator[Diagnostic]:
    """Return errors on topics with more than one type. A ROS 1 node with such a topic ends at its start."""
    types: dict[str, str] = {}
    ends: list[rosgraph.Subscription | rosgraph.Publisher] = [*graph.subscriptions, *graph.publishers]
    for end in ends:
        kind = f"{end.interface.package}/{end.interface.type}"
        first = types.setdefault(end.topic.removeprefix("/"), kind)
        if kind != first:
            hint = "use another topic, or one type for all communications on this topic"
            yield _error(end, f'"{end.topic}" is a topic of {first} already, and cannot be one of {kind}', hint)


def _fields(graph: rosgraph.RosGraph) -> Iterator[tuple[ex.Located, str]]:
    for _, element in tree(graph):
        if isinstance(element, rosgraph.FieldAssignment):
            yield from ((element, name) for name in element.path)
        elif isinstance(element, rosgraph.FieldStep):
            yield element, element.name


def _settings(graph: rosgraph.RosGraph, configuration: Configuration) -> Iterator[Diagnostic]:
    yield from _outside(graph, configuration, "onShutdown", configuration.on_shutdown)
    yield from _outside(graph, configuration, "onWithheld", configuration.on_withheld)
    yield from _nothing_safe(graph, configuration)
    heard = {subscription.topic.removeprefix("/") for subscription in graph.subscriptions}
    others = [publisher.topic for publisher in graph.publishers]
    others += [service.identifier for service in graph.serviceClients]
    others += [action.identifier for action in graph.actionClients]
    for place_of_topic, topic in enumerate(configuration.wait_for):
        if topic.removeprefix("/") not in heard:
            hint = f"topics that it listens to: {', '.join(sorted(heard))}" if heard else None
            message = f'"waitFor": the node does not listen to {topic}'
            yield configuration.error(("waitFor", place_of_topic), message, hint)
    for topic in configuration.watchdog_ms:
        if topic not in heard and topic in {name.removeprefix("/") for name in others}:
            yield configuration.warning(("watchdogMs", topic), f'"watchdogMs": the node does not listen to {topic}')
    controller = configuration.supervisor.controller
    unused = {
        ("onBlocked",): configuration.on_blocked,
        ("supervisor", "controller"): controller.run or controller.launch,
        ("output", "ros2SupervisorNodeLocation"): configuration.output.ros2_supervisor_node_location,
    }
    for place_of_key, setting in unused.items():
        if setting:
            yield configuration.warning(place_of_key, f'"{".".join(place_of_key)}" has no effect on this target')


def _violations(graph: rosgraph.RosGraph, configuration: Configuration) -> Iterator[Diagnostic]:
    """Return warnings on a node that goes on after a violation, and on a reaction to violations that cannot occur."""
    if not assumptions(graph.model):
        if "on_violation" in configuration.model_fields_set:
            message = '"onViolation" has no effect: the model has no assumption'
            yield configuration.warning(("onViolation",), message)
    elif configuration.on_violation == "report":
        message = '"onViolation": after the first violation of an assumption, nothing about the robot is proved'
        yield configuration.warning(("onViolation",), message, "leave it out: then the first violation stops the robot")


def _outside(
    graph: rosgraph.RosGraph, configuration: Configuration, setting: str, names: Sequence[str]
) -> Iterator[Diagnostic]:
    """Return errors on names in a setting that are no sent messages, and warnings on requirements that it overrides."""
    yield from _unsendable(graph, configuration, setting, names)
    yield from _unsteady(graph, configuration, setting, names)
    for place_of_name, name in enumerate(names):
        sending = find_message(graph, name)
        if sending is None:
            continue
        for requirement in graph.model.requirements:
            if requirement.event is sending.event and requirement.text:
                message = f'"{setting}": {name} is then sent regardless of "{requirement.text}"'
                yield configuration.warning((setting, place_of_name), message)


def _unsendable(
    graph: rosgraph.RosGraph, configuration: Configuration, setting: str, names: Sequence[str]
) -> Iterator[Diagnostic]:
    """Return errors on names in a setting that are no messages to the robot."""
    for place_of_name, name in enumerate(names):
        if find_message(graph, name) is None:
            sent = [sending.name for publisher in graph.publishers for sending in publisher.sendings]
            hint = f"messages to the robot: {', '.join(sent)}" if sent else None
            message = f'"{setting}": {name} is not a message that the node sends'
            yield configuration.error((setting, place_of_name), message, hint)


def _unsteady(
    graph: rosgraph.RosGraph, configuration: Configuration, setting: str, names: Sequence[str]
) -> Iterator[Diagnostic]:
    """Return warnings on messages that stop the robot, if their data depend on its state."""
    for place_of_name, name in enumerate(names):
        sending = find_message(graph, name)
        if sending is not None and not is_constant(sending):
            message = f'"{setting}": the data of {name} depend on the state of the robot, and may not stop it'
            hint = "name a message with one `provide` of constant data"
            yield configuration.warning((setting, place_of_name), message, hint)


def _swallowed(
    graph: rosgraph.RosGraph, executed: engine.EngineModel, configuration: Configuration
) -> Iterator[Diagnostic]:
    """Return warnings on messages that keep the robot moving and that a layer may block without notice to the robot."""
    if "on_blocked" in configuration.model_fields_set:
        return
    stops = configuration.stops_on_violation(graph.model)
    blockable = {event.event for event in executed.events if stops or event.reasons}
    for publisher in graph.publishers:
        kind = f"{publisher.interface.package}/{publisher.interface.type}"
        for sending in publisher.sendings:
            if kind in _MOVING and sending.event in blockable:
                message = (
                    f"the layer can block {sending.name}, also one that stops the robot: the robot then continues with"
                    " its last command"
                )
                hint = (
                    f'name it in controller-config.json: "onBlocked": ["{sending.name}"]; if the robot stops by'
                    " itself, write []"
                )
                yield replace(_error(sending.event, message, hint), severity=Severity.WARNING)


def _nothing_safe(graph: rosgraph.RosGraph, configuration: Configuration) -> Iterator[Diagnostic]:
    """Return warnings if the robot would continue its last command because nothing else is sent."""
    if not graph.publishers:
        return
    if configuration.watchdog_stops and not configuration.on_shutdown:
        message = '"watchdogStops" only holds commands back: "onShutdown" names no message that stops the robot'
        yield configuration.warning(
            ("watchdogStops",), message, 'name the message that stops it: "onShutdown": ["halt"]'
        )
    elif not configuration.says_how_to_stop:
        message = '"onShutdown" is not set: when the node ends, the robot continues with its last command'
        hint = 'name the message that stops it, as in "onShutdown": ["halt"]; if no message can, write []'
        yield configuration.warning(("onShutdown",), message, hint)
    if configuration.stops_on_violation(graph.model) and not configuration.on_shutdown:
        message = (
            'a violation of an assumption only holds commands back: "onShutdown" names no message that stops the robot'
        )
        yield configuration.warning(("onShutdown",), message, 'name the message that stops it: "onShutdown": ["halt"]')
    if "on_withheld" not in configuration.model_fields_set:
        outside = _from_outside(graph)
        for sending in (sending for publisher in graph.publishers for sending in publisher.sendings):
            withheld = next((field for field in fields_set(sending) if _may_be_withheld(field, outside)), None)
            if withheld is not None:
                what = "is not a" if infer(withheld.value) == DOUBLE else "has a value that is not a"
                message = (
                    f"{sending.name} is not sent if its {'.'.join(withheld.path) or 'data'} {what} finite number, and"
                    " no other message is: the robot continues with its last command"
                )
                hint = (
                    'name the message to send then in controller-config.json, as in "onWithheld": ["halt"]; or write []'
                )
                yield replace(_error(withheld, message, hint), severity=Severity.WARNING)


def _may_be_withheld(field: rosgraph.FieldAssignment, outside: set[rosgraph.NodeVariable]) -> bool:
    """Return whether a field's value may hold a double that is not finite, as far as its type is known."""
    value = field.value
    if isinstance(value, rosgraph.WireAccess) and value.variable is not None and holds_objects(field.type):
        return any(isinstance(kind, ex.DoubleType) for _, kind in parts_of(value.variable.type, path_of(value)))
    return infer(value) in {DOUBLE, ArrayType(DOUBLE)} and _reads(value, outside, is_sent=True)


def _from_outside(graph: rosgraph.RosGraph) -> set[rosgraph.NodeVariable]:
    """Return the variables that may get a double from the robot or from a division, directly or indirectly."""
    assignments = [
        assignment
        for reaction in graph.reactions
        for assignment in reaction.assignments
        if infer(assignment.value) == DOUBLE
    ]
    variables: set[rosgraph.NodeVariable] = set()
    more = True
    while more:
        reached = {assignment.variable for assignment in assignments if _reads(assignment.value, variables)}
        more = not reached <= variables
        variables |= reached
    return variables


def _reads(value: ex.Expression, outside: set[rosgraph.NodeVariable], *, is_sent: bool = False) -> bool:
    """Return whether a value reads a double from the robot. `is_sent`: it is part of a message, and may read that."""
    return any(
        (
            isinstance(part, rosgraph.WireAccess)
            and declared_type(part.type) in {DOUBLE, ArrayType(DOUBLE)}
            and not (is_sent and source_of(part) is None)
        )
        or (isinstance(part, rosgraph.NodeVariableReference) and part.variable in outside)
        or (isinstance(part, ex.Division) and not isinstance(part.right, (ex.IntegerLiteral, ex.DoubleLiteral)))
        for _, part in tree(value)
    )


def _shared_topics(graph: rosgraph.RosGraph) -> Iterator[Diagnostic]:
    """Return errors on topics with several messages: a layer cannot determine which one it passes."""
    named: dict[str, str] = {}
    by_topic: list[tuple[str, Sequence[rosgraph.Reception | rosgraph.Sending]]] = [
        *((subscription.topic, subscription.receptions) for subscription in graph.subscriptions),
        *((publisher.topic, publisher.sendings) for publisher in graph.publishers),
    ]
    for topic, message in ((topic, message) for topic, messages in by_topic for message in messages):
        first = named.get(topic.removeprefix("/"))
        if first is None:
            named[topic.removeprefix("/")] = message.name
            continue
        text = f'{first} and {message.name} are both on "{topic}": a supervisory layer cannot distinguish them'
        yield _error(message, text, "use a separate topic for each, or one message for both", LAYER_RULE)


def _controller(configuration: Configuration) -> Iterator[Diagnostic]:
    """Return errors on settings that are copied to the launch file."""
    controller = configuration.supervisor.controller
    run, launch = controller.run, controller.launch
    key = ("supervisor", "controller")
    if run and launch:
        yield configuration.error(key, '"run" and "launch" both start the controller', "leave out one of them")
    checked: list[tuple[str, str, str | None, re.Pattern[str]]] = []
    if run:
        checked += [
            ("run", "packageName", run.package_name, _PACKAGE),
            ("run", "executable", run.executable, _EXECUTABLE),
            ("run", "name", run.name, _NODE),
            ("run", "namespace", run.namespace, _NAMESPACE),
        ]
    if launch:
        checked += [("launch", "packageName", launch.package_name, _PACKAGE), ("launch", "file", launch.file, _FILE)]
    for form, name, value, pattern in checked:
        if value is not None and not pattern.fullmatch(value):
            message = f'"{".".join((*key, form, name))}" is not a name that a launch file could use'
            yield configuration.error((*key, form, name), message)


def _unused(configuration: Configuration) -> Iterator[Diagnostic]:
    """Return warnings on settings without effect on a layer."""
    settings = {
        "retryMs": configuration.retry_ms != Configuration().retry_ms,
        "frameId": configuration.frame_id and not configuration.on_blocked,
        "watchdogMs": configuration.watchdog_ms,
        "watchdogStops": configuration.watchdog_stops,
        "onShutdown": configuration.on_shutdown,
        "onWithheld": configuration.on_withheld,
        "waitFor": configuration.wait_for,
        "lifecycle": configuration.lifecycle is not None,
    }
    for key, used in settings.items():
        if used:
            yield configuration.warning((key,), f'"{key}" has no effect on this target')
