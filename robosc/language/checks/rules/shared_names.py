"""Rules on shared topics and servers: `topic-types`, `shared-server` and `indistinct-commands`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Severity
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import kind_text, ros_type, sent_type
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.walks import branches

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model import expression as ex
    from robosc.model.semantics.instances import Instance, Instances, PortInstance, Statement

    _Kind = type[rsc.CommunicationType] | tuple[type[rsc.CommunicationType], ...]


@rule("topic-types")
def topic_types(base: rsc.Base) -> Iterator[Finding]:
    """All messages on one topic have one ROS type."""
    for first, second in _of_other_types(base, rsc.Message):
        yield Finding(
            _place(second),
            f"{_described(second)} has the type `{_type(second)}` on the topic `{_name(second)}`, on which"
            f" {_described(first)} has the type `{_type(first)}`: ROS does not connect them",
            "use one type for both, or a separate topic for one of them",
            related=first.communication,
        )


@rule("shared-server")
def shared_server(base: rsc.Base) -> Iterator[Finding]:
    """All services with one name have one ROS type and at most one server, and so do all actions with one name."""
    for kinds in ((rsc.Service, rsc.OutgoingService), (rsc.Action, rsc.OutgoingAction)):
        for first, second in _of_other_types(base, kinds):
            yield Finding(
                _place(second),
                f"{_described(second)} has the type `{_type(second)}`, and {_described(first)} of the same name"
                f" `{_name(second)}` has the type `{_type(first)}`: only one of them can be answered",
                "use one type for both, or a separate name for one of them",
                related=first.communication,
            )
        yield from _served_twice(base, kinds[1])


def _served_twice(base: rsc.Base, kind: type[rsc.CommunicationType]) -> Iterator[Finding]:
    """Report communications that the controller would serve a second time."""
    firsts: dict[str, PortInstance] = {}
    for second in _ports(instances(base), kind) if isinstance(base, rsc.Robot) else ():
        first = firsts.setdefault(_name(second).removeprefix("/"), second)
        if first is not second and ros_type(first.communication) == ros_type(second.communication):
            yield Finding(
                _place(second),
                f"{_described(second)} has the name `{_name(second)}` of {_described(first)}, expected a name of its"
                " own: a client reaches only one of them",
                "give it another `identifier`, or use one of them for both",
                related=first.communication,
            )


@rule("indistinct-commands", Severity.WARNING)
def indistinct_commands(base: rsc.Base) -> Iterator[Finding]:
    """Any two messages that the controller sends on one topic differ in their data."""
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    firsts: dict[object, PortInstance] = {}
    for second in _ports(known, rsc.Message):
        sent = sent_type(second.communication)
        if sent is None or isinstance(sent, rsc.NoneDataType):
            continue
        data = _statements(second, known)
        alike = (_name(second).removeprefix("/"), ros_type(second.communication), data)
        first = firsts.setdefault(alike, second)
        if first is not second:
            why = "carry the same data" if data else "have no `provide`, so that both carry zeros"
            yield Finding(
                _place(second),
                f"{_described(first)} and {_described(second)} go to the topic `{_name(second)}` and {why}: the robot"
                " cannot tell them apart",
                f"provide other data with `{escape_keyword(second.communication.name)}`, or use one message for both",
                related=first.communication,
            )


def _statements(port: PortInstance, known: Instances) -> tuple[tuple[str, str], ...]:
    """Return the data and the condition of each effective `provide` and `limit` for a command, with names expanded."""
    statements = []
    effective: list[Statement[Any]] = [*known.provide_statements(port), *known.limits(port)]
    for statement in effective:
        data, condition = statement.element.data, statement.element.condition
        shown = _shown(data, statement.within, known) if data is not None else ""
        statements.append((shown, "" if condition is None else _shown(condition, statement.within, known)))
    return tuple(statements)


def _shown(expression: ex.Expression, within: Instance | None, known: Instances) -> str:
    if isinstance(expression, rsc.ObjectValue):
        fields = (
            (field.property.name if field.property else "", _shown(field.value, within, known))
            for field in expression.properties
            if field.value is not None
        )
        return "{" + ", ".join(f"{name}: {value}" for name, value in sorted(fields)) + "}"
    if any(isinstance(branch, rsc.ObjectValue) for _, branch in branches(expression)):
        return "; ".join(
            f"{_shown(branch, within, known)} if {[(_shown(test, within, known), holds) for test, holds in conditions]}"
            for conditions, branch in branches(expression)
        )
    return RoboscPrinter()(known.expanded(expression, within))


def _of_other_types(base: rsc.Base, kind: _Kind) -> Iterator[tuple[PortInstance, PortInstance]]:
    """Yield the communications whose ROS type differs from that of the first with the same name, with that first."""
    if not isinstance(base, rsc.Robot):
        return
    firsts: dict[str, PortInstance] = {}
    for second in _ports(instances(base), kind):
        if ros_type(second.communication) is None:
            continue
        first = firsts.setdefault(_name(second).removeprefix("/"), second)
        same_name = first.communication.name == second.communication.name  # `unique-communication` reports it
        if not same_name and ros_type(first.communication) != ros_type(second.communication):
            yield first, second


def _ports(known: Instances, kind: _Kind) -> Iterator[PortInstance]:
    """Yield the communications of a kind whose instances have all arguments; `argument` reports the others."""
    for port in known.ports():
        complete = not {*port.instance.definition.parameters} - port.instance.arguments.keys()
        if complete and isinstance(port.communication, kind) and port.communication.name:
            yield port


def _place(port: PortInstance) -> ex.Located:
    """Return the place of a communication: its component if imported or instantiated, else its declaration."""
    is_instance = port.instance.component is not port.instance.definition
    return port.instance.component if is_instance else port.communication


def _described(port: PortInstance) -> str:
    kind = kind_text(port.communication)
    return f"{kind} `{port.communication.name}` of `{port.instance.name}`"


def _name(port: PortInstance) -> str:
    return port.instance.topic(port.communication)


def _type(port: PortInstance) -> str:
    return "/".join(ros_type(port.communication) or ())
