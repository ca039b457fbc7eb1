"""Commands of a node, each with the reasons for which the supervisor may block it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.expressions import CPrinter, integer_type
from robosc.m2t.ros.names import CppNames
from robosc.model import engine, rosgraph, sct
from robosc.model.semantics.component_parts import answers
from robosc.model.semantics.printing import Printed
from robosc.model.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.ros.node import GeneratedNode
    from robosc.model import expression as ex

#: Method of the header's `BlockReasons` that adds a reason, by the origin of the reason.
_ADDED_BY = {
    engine.Origin.requirement: "add_requirement",
    engine.Origin.plants: "add_state",
    engine.Origin.synthesis: "add_consequence",
}


@dataclass(frozen=True)
class GateReason:
    """A reason: its condition, if any, the method that adds it, and its text as a C++ expression."""

    condition: str | None
    add: str
    text: str


@dataclass(frozen=True)
class Gate:
    """A command to the robot that the supervisor passes or blocks.

    `word` is valid in names, `event` is the event's enumerator, `name` its communication in the model, `requirements`
    are the texts of the requirements on it. Without reasons, only a violation of an assumption can block it.
    """

    word: str
    event: str
    name: str
    requirements: Sequence[str]
    reasons: Sequence[GateReason]


def gates(graph: rosgraph.RosGraph, node: GeneratedNode, executed: engine.EngineModel) -> dict[rosgraph.Sending, Gate]:
    """Return the gate of each command of a node."""
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    sendings += [service.request for service in graph.serviceClients]
    sendings += [action.request for action in graph.actionClients]
    servers = (*graph.serviceServers, *graph.actionServers)
    sendings += [sending for server in servers for sending in answers(server).values()]
    messages = [message for _, message in node.sent]
    printer = _Printer(CppNames(graph))
    events = {event.event: event for event in executed.events}
    return {
        sending: Gate(
            message.word,
            message.event,
            _name(sending.event),
            message.requirements,
            [printer.reason(reason) for reason in events[sending.event].reasons],
        )
        for message, sending in zip(messages, sendings, strict=True)
    }


def _name(event: sct.Event) -> str:
    plant = plant_of(event)
    return plant.origin or plant.name


class _Printer(CPrinter):
    """Prints conditions on the state of the node's supervisor in C++."""

    state = "supervisor_.state."
    inputs = "supervisor_.inputs."

    def __init__(self, names: CppNames) -> None:
        super().__init__(names.c)
        self._places = names

    def write(self, expression: ex.Expression, printed: Sequence[Printed]) -> Printed:
        """Print an expression. A conversion becomes a C++ cast."""
        if isinstance(expression, engine.Conversion) and not (expression.widens and expression.bits == 16):
            kind = integer_type(expression.bits, signed=expression.signed)
            return Printed(f"static_cast<std::{kind}>({printed[0].text})")
        return super().write(expression, printed)

    def reason(self, reason: engine.Reason) -> GateReason:
        text = string_literal(reason.text)
        if reason.location is not None:
            plant = reason.location.plant
            text = f"std::string({text}) + {self._places.c.lookup(plant)}({self._places.state(plant)})"
        return GateReason(self(reason.condition) if reason.condition else None, _ADDED_BY[reason.kind], text)
