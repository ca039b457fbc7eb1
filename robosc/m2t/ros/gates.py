"""The commands of a node, each with what may keep the supervisor from letting it happen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.ros.events import Reasons
from robosc.m2t.ros.expressions import CppPrinter
from robosc.m2t.ros.names import CppNames
from robosc.metamodel import rosgraph, sct
from robosc.semantics.edges import departures, edges_by_event
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.ros.node import Node


@dataclass(frozen=True)
class Reason:
    """A reason as an expression of C++ (a text), and the condition under which it is one."""

    condition: str
    text: str


@dataclass(frozen=True)
class Gate:
    """What goes to the robot and the supervisor lets through or blocks.

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

    @property
    def is_open(self) -> bool:
        """Whether nothing is known that could block it."""
        return not (self.failing or self.missing or self.explanation)


def gates(graph: rosgraph.RosGraph, node: Node) -> dict[rosgraph.Sending, Gate]:
    """The gate of each command of a node."""
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    sendings += [service.request for service in graph.serviceClients]
    sendings += [action.request for action in graph.actionClients]
    messages = [message for publisher in node.publishers for message in publisher.messages]
    messages += [client.request for client in node.clients]
    maker = _Maker(graph)
    return {
        sending: maker.gate(message.word, sending.event) for message, sending in zip(messages, sendings, strict=True)
    }


class _Maker:
    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self._names = CppNames(graph)
        self._printer = CppPrinter(self._names)
        self._reasons = Reasons(graph.model)
        self._edges = edges_by_event(graph.model.plants)
        self._requirements: dict[sct.Event, list[sct.Requirement]] = {}
        for requirement in graph.model.requirements:
            self._requirements.setdefault(requirement.event, []).append(requirement)

    def gate(self, word: str, event: sct.Event) -> Gate:
        plant = plant_of(event)
        explanation = self._reasons.explanation(event)
        return Gate(
            word,
            self._names.c.enumerator(event),
            plant.origin or plant.name,
            self._reasons.requirements(event),
            [
                Reason(self._failing(requirement), string_literal(requirement.text or "a requirement"))
                for requirement in self._requirements.get(event, ())
            ],
            [reason for plant, edges in self._edges.get(event, {}).items() for reason in self._missing(plant, edges)],
            string_literal(explanation) if explanation else None,
        )

    def _failing(self, requirement: sct.Requirement) -> str:
        holds = self._printer(requirement.condition)
        return holds if requirement.kind == sct.RequirementKind.disables else f"!({holds})"

    def _missing(self, plant: sct.Plant, edges: Sequence[sct.Edge]) -> list[Reason]:
        """That a plant can take none of its edges for an event, with its location."""
        places = departures(plant, edges)
        if len(places) == len(plant.locations) and not any(edge.guard for edge in edges):
            return []
        possible = " || ".join(self._taken(location, edge) for location, edge in places)
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
