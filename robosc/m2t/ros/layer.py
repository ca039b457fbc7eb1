"""What the templates of a layer print: all that passes it, in both directions, as text of C++."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.ros.events import Reasons
from robosc.m2t.ros.expressions import CppPrinter
from robosc.m2t.ros.names import CppNames
from robosc.m2t.ros.node import Node
from robosc.metamodel import rosgraph, sct
from robosc.semantics.edges import edges_from
from robosc.semantics.roles import Roles, plant_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.ros.node import EventHandler


@dataclass(frozen=True)
class Reason:
    """A reason as an expression of C++ (a text), and the condition under which it is one."""

    condition: str
    text: str


@dataclass(frozen=True)
class Gate:
    """What the controller sends and the supervisor lets through or blocks.

    A word fit for names, the event's enumerator, its communication in the model.
    """

    word: str
    event: str
    name: str
    #: The requirements on it, as the model has them.
    requirements: list[str]
    #: Where a requirement fails.
    failing: list[Reason]
    #: Where a component or a communication has no transition for it.
    missing: list[Reason]
    #: What would follow if synthesis did not forbid it, as a literal of C++.
    explanation: str | None


@dataclass(frozen=True)
class Inward:
    """A message from the robot to the controller, and the event that it is."""

    word: str
    topic: str
    interface: rosgraph.Interface
    event: EventHandler
    unread: bool


@dataclass(frozen=True)
class Outward:
    """A message from the controller to the robot."""

    word: str
    topic: str
    interface: rosgraph.Interface
    gate: Gate


@dataclass(frozen=True)
class Call:
    """A service or action that the controller uses; only an action has feedback and is cancelled by an event."""

    word: str
    name: str
    interface: rosgraph.Interface
    gate: Gate
    response: EventHandler
    error: EventHandler
    feedback: EventHandler | None
    cancel: str | None


class LayerNode:
    """The layer of one graph: `node` is what it has in common with the controller's node."""

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self.node = Node(graph)
        self._model = graph.model
        self._names = CppNames(graph)
        self._printer = CppPrinter(self._names)
        self._reasons = Reasons(graph.model)
        self.inward = [
            Inward(
                self._word(source.receptions[0].event), topic.topic, topic.interface, topic.receptions[0], topic.unread
            )
            for source, topic in zip(graph.subscriptions, self.node.subscriptions, strict=True)
        ]
        self.outward = [
            Outward(
                self._word(topic.sendings[0].event), topic.topic, topic.interface, self._gate(topic.sendings[0].event)
            )
            for topic in graph.publishers
        ]
        sources: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
        self.calls = [
            Call(
                self._word(source.request.event),
                source.identifier,
                source.interface,
                self._gate(source.request.event),
                client.response,
                client.error,
                client.feedback,
                client.cancel,
            )
            for source, client in zip(sources, self.node.clients, strict=True)
        ]
        sent = [message for topic in self.node.publishers for message in topic.messages]
        sent += [client.request for client in self.node.clients]
        #: Events of the controller and internal ones that change the node's own data.
        self.changing = [*self.node.internal, *(message.reaction for message in sent if message.reaction)]
        #: Events that choose provided data, which is none of the layer's business.
        self.ignored = [self._names.c.enumerator(event) for events in Roles(graph.model).data for event in events]

    @property
    def services(self) -> list[Call]:
        """The services."""
        return [call for call in self.calls if call.interface.kind == rosgraph.InterfaceKind.service]

    @property
    def actions(self) -> list[Call]:
        """The actions."""
        return [call for call in self.calls if call.interface.kind == rosgraph.InterfaceKind.action]

    @property
    def gates(self) -> list[Gate]:
        """What the controller sends."""
        return [*(topic.gate for topic in self.outward), *(call.gate for call in self.calls)]

    @property
    def received(self) -> list[EventHandler]:
        """What comes from the robot."""
        answers = [handler for call in self.calls for handler in (call.feedback, call.response, call.error) if handler]
        return [*(topic.event for topic in self.inward), *answers]

    def remapped(self, parts_of_actions: Sequence[str]) -> list[str]:
        """The robot's names that a controller is started with others for; an action is re-mapped part by part."""
        names = [topic.topic for topic in self.inward] + [topic.topic for topic in self.outward]
        names += [service.name for service in self.services]
        return names + [f"{action.name}/{part}" for action in self.actions for part in parts_of_actions]

    def _word(self, event: sct.Event) -> str:
        return self._names.c.member(plant_of(event))

    def _gate(self, event: sct.Event) -> Gate:
        """How an event is passed or blocked."""
        plant = plant_of(event)
        required = [requirement for requirement in self._model.requirements if requirement.event == event]
        explanation = self._reasons.explanation(event)
        return Gate(
            self._names.c.member(plant),
            self._names.c.enumerator(event),
            plant.origin or plant.name,
            self._reasons.requirements(event),
            [Reason(self._failing(one), string_literal(one.text or "a requirement")) for one in required],
            [reason for plant in self._model.plants for reason in self._missing(plant, event)],
            string_literal(explanation) if explanation else None,
        )

    def _failing(self, requirement: sct.Requirement) -> str:
        holds = self._printer(requirement.condition)
        return holds if requirement.kind == sct.RequirementKind.disables else f"!({holds})"

    def _missing(self, plant: sct.Plant, event: sct.Event) -> list[Reason]:
        """That a plant which takes part in the event can't, with its location."""
        edges = {location: edge for location in plant.locations for edge in edges_from(location) if edge.event == event}
        if not edges or (len(edges) == len(plant.locations) and not any(edge.guard for edge in edges.values())):
            return []
        possible = " || ".join(self._taken(location, edge) for location, edge in edges.items())
        origin = plant.origin or plant.name
        if len(plant.locations) == 1:
            text = string_literal(f"{origin}.{plant.locations[0].name}")
        else:
            location = f"{self._names.c.lookup(plant)}({self._names.state(plant)})"
            text = f"std::string({string_literal(origin + '.')}) + {location}"
        return [Reason(f"!({possible})", text)]

    def _taken(self, location: sct.Location, edge: sct.Edge) -> str:
        here = self._names.is_in(location)
        return here if edge.guard is None else f"({here} && {self._printer.tight(edge.guard)})"
