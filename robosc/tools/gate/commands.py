"""Commands of a robot as tools: names, descriptions and shapes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from robosc.base.ros_types import DefinitionError, RosTypes, Section
from robosc.model import engine as executed
from robosc.model import rosgraph
from robosc.model.semantics.communication import sent_type
from robosc.model.semantics.instances import Instances
from robosc.model.semantics.roles import event_name, plant_of
from robosc.tools.gate.shapes import Fields, Shapes, comment, source_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.m2t.models import Models
    from robosc.model.semantics.instances import PortInstance

Element: TypeAlias = rosgraph.Publisher | rosgraph.ServiceClient | rosgraph.ActionClient

#: Characters that not every client accepts in the name of a tool, and the most that all accept.
_UNUSUAL = re.compile(r"\W", re.ASCII)
_LONGEST = 64
_KINDS = {
    Section.MESSAGE: "Send the message `{}` to the robot.",
    Section.REQUEST: "Call the service `{}` of the robot and return its response.",
    Section.GOAL: "Start a goal of the action `{}`. The answer is its acceptance; `wait` returns its result.",
}


class UnknownTypeError(Exception):
    """ROS type without a known definition: there is no schema for its data."""


@dataclass(frozen=True)
class Command:
    """Command of a robot. `tool` is the name of its tool, `name` its name in the model, as on `~/blocked`."""

    tool: str
    name: str
    description: str
    shape: Fields
    sending: rosgraph.Sending
    element: Element
    section: Section

    @property
    def ros_name(self) -> str:
        """Name of its topic, service or action."""
        return _ros_name(self.element)


def _ros_name(element: Element) -> str:
    return str(element.topic if isinstance(element, rosgraph.Publisher) else element.identifier)


def commands(models: Models) -> list[Command]:
    """Return the commands of a robot whose model has a supervisor, in the order of the text.

    Raises UnknownTypeError.
    """
    graph = models.rosgraph
    assert graph is not None
    types = models.ros_types or RosTypes()
    ports = {} if models.robosc is None else _ports(models)
    reasons = _requirements(models)
    names: set[str] = set()
    known = []
    for element, section, sending in _sendings(graph):
        plant = plant_of(sending.event)
        name = plant.origin or plant.name
        port = ports.get(name)
        interface = element.interface
        shapes = Shapes(types.distribution(2), None if port is None else port.instance)
        declared = None if port is None else sent_type(port.communication)
        try:
            basic = types.field_of_basic(interface.package, interface.type, section)
            shape = shapes.of(interface.package, interface.type, section, declared, basic)
        except DefinitionError as error:
            raise UnknownTypeError(f"{name}: {error}") from None
        description = " ".join(_description(name, element, section, sending, port, reasons))
        known.append(Command(tool_name(name, names), name, description, shape, sending, element, section))
    return known


def tool_name(name: str, used: set[str]) -> str:
    """Return the name of a tool for a name of the model, unlike all `used` ones, and add it to them."""
    plain = _UNUSUAL.sub("_", name).strip("_")[:_LONGEST] or "_"
    chosen, number = plain, 2
    while chosen in used:
        ending = f"_{number}"
        chosen, number = plain[: _LONGEST - len(ending)] + ending, number + 1
    used.add(chosen)
    return chosen


def _sendings(graph: rosgraph.RosGraph) -> Iterator[tuple[Element, Section, rosgraph.Sending]]:
    for publisher in graph.publishers:
        yield from ((publisher, Section.MESSAGE, sending) for sending in publisher.sendings)
    for service in graph.serviceClients:
        yield service, Section.REQUEST, service.request
    for action in graph.actionClients:
        yield action, Section.GOAL, action.request


def _ports(models: Models) -> Mapping[str, PortInstance]:
    assert models.robosc is not None
    return {f"{port.instance.name}.{port.communication.name}": port for port in Instances(models.robosc).ports()}


def _requirements(models: Models) -> Mapping[str, list[str]]:
    """Return the texts of the requirements on each event, by its name."""
    return {
        event.name: [reason.text for reason in event.reasons if reason.kind == executed.Origin.requirement]
        for event in models.engine.events
    }


def _description(  # noqa: PLR0913, PLR0917 - the parts of a description
    name: str,
    element: Element,
    section: Section,
    sending: rosgraph.Sending,
    port: PortInstance | None,
    reasons: Mapping[str, Iterable[str]],
) -> Iterator[str]:
    yield _KINDS[section].format(name)
    note = None if port is None else comment(port.communication)
    if note:
        yield note if note.endswith((".", "!", "?")) else f"{note}."
    yield f"ROS name: `{_ros_name(element)}`, type {element.interface.package}/{element.interface.type}."
    texts = list(dict.fromkeys(reasons.get(event_name(sending.event), ())))
    if texts:
        yield f"Requirements: {'; '.join(f'`{text}`' for text in texts)}."
    limits = [text for limit in sending.limits for text in [source_text(limit)] if text is not None]
    if limits:
        yield f"Limits change the data: {'; '.join(f'`{text}`' for text in limits)}."
