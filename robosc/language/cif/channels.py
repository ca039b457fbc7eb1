"""Channels: one automaton sends, one receives, and all automata with the channel in their alphabet synchronize.

An event of the sct metamodel has no sender and no receiver. A channel with one sender and one receiver becomes an event
of both. The received value becomes the sent one, by its place if the sender sends several. If a channel has several
senders or receivers, then:

- A controllable channel stays one event, because CIF permits only one pair in a state. Each sender may stay where
  another one sends. If two can send, their edges overlap, which synthesis rejects. The same applies to receivers.
- An uncontrollable channel becomes one event for each pair, because the system chooses the pair. A sender with several
  values in a location also has one event for each of them.

Source: language tutorial of CIF, "Channels"; `linearize-product` of CIF's `cif2cif` has the same meaning.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice, product
from typing import TYPE_CHECKING, Any

from robosc.language.cif.faults import CifFaultError, construct
from robosc.language.cif.static_values import TypedNode, default, literal
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cif_types import LARGEST, Type, contains, format_type, join_types
from robosc.model.semantics.naming import Names
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from robosc.language.cif.scopes import Declaration, Scope, Specification
    from robosc.language.cif.values import Values

    Updates = tuple[list[tuple[sct.DiscreteVariable, ex.Expression, Any]], dict[sct.DiscreteVariable, ex.Expression]]

#: Type of a channel that transfers no data.
VOID = "void"
#: Maximum number of events that a channel becomes.
_MOST = 10_000
_WORDS = {"!": "sends over", "?": "receives from", "": "synchronizes with"}


@dataclass
class EventEdge:
    """An edge of the text for one of its events.

    `fits` has the condition under which each variable stays in range. `use` is `!` if the automaton sends, `?` if it
    receives, and otherwise empty. The updates of an edge that receives are read with the value that is sent.
    """

    location: sct.Location
    event: sct.Event
    guard: ex.Expression | None
    fits: dict[sct.DiscreteVariable, ex.Expression]
    updates: list[tuple[sct.DiscreteVariable, ex.Expression, Any]]
    target: sct.Location
    node: Any
    use: str = ""
    sent: TypedNode | None = None


@dataclass
class _Communication:
    """An event of a channel, with the edges of the automata that can send and receive."""

    event: sct.Event
    senders: dict[Scope, list[EventEdge]]
    receivers: dict[Scope, list[EventEdge]]


def at(location: sct.Location, plant: sct.Plant) -> list[ex.Expression]:
    """Return the condition that the plant is in a location; empty if it has no other location."""
    return [sct.LocationReference(location=location)] if len(plant.locations) > 1 else []


def sent_value(node: Any, declared: Declaration, scope: Scope, values: Values) -> TypedNode | None:
    """Return the value that an event on an edge sends, or None. Raises CifFaultError if its use is wrong."""
    name, use = node.event.text, (node.use or "").strip()
    if not use:
        return None
    if declared.type is None:
        message = f"`{name}` is not a channel: its declaration has no type"
        raise CifFaultError(node, "type", message, f"leave out `{use}`, or write `void` after `event`")
    if scope.kind == "requirement":
        raise construct(node, "requirement automata that send or receive", f"leave out `{use}`")
    if use == "?":
        return None
    if declared.type == VOID:
        if node.sent is not None:
            raise CifFaultError(node.sent, "type", f"the channel `{name}` transfers no value", "leave it out")
        return None
    if node.sent is None:
        raise CifFaultError(node, "type", f"the channel `{name}` transfers a value", f"write it after `{name}!`")
    value = values.whole(node.sent, scope)
    if not (isinstance(value.type, range) if declared.type == "int" else contains(declared.type, value.type)):
        message = f"`{name}` is {format_type(declared.type)}, the sent value {format_type(value.type)}"
        raise CifFaultError(node.sent, "type", message)
    return value


class Channels:
    """The events of channels and their edges."""

    def __init__(
        self, names: Specification, values: Values, updates: Callable[[Any, Scope], Updates], declared: Iterable[Any]
    ) -> None:
        """Prepare the channels among the `declared` events. `updates` reads the updates of an edge."""
        self._names = names
        self._values = values
        self._updates = updates
        self._channels: dict[sct.Event, Declaration] = {
            event.element: event for event in declared if event.type is not None
        }
        self._events: dict[sct.Event, list[sct.Event]] = {}

    def events_of(self, event: sct.Event) -> list[sct.Event]:
        """Return the events into which an event of the text is divided: none if a channel has no sender or receiver."""
        return self._events.get(event, [event])

    def resolve(self, edges: dict[Scope, list[EventEdge]]) -> dict[Scope, list[EventEdge]]:
        """Return the edges of each automaton with the events of `events_of`, and the received values in updates."""
        resolved: dict[Scope, list[EventEdge]] = {scope: [] for scope in edges}
        for event, declared in self._channels.items():
            communications = list(self._communications(declared, edges))
            self._events[event] = [communication.event for communication in communications]
            for communication in communications:
                for parties in (communication.senders, communication.receivers):
                    for scope, own in parties.items():
                        resolved[scope] += [*own, *_staying(scope, parties, communication.event)]
        return {
            scope: [
                replace(edge, event=event)
                for edge in own
                if not edge.use
                for event in self._events.get(edge.event, [edge.event])
            ]
            + resolved[scope]
            for scope, own in edges.items()
        }

    def _communications(self, declared: Declaration, edges: dict[Scope, list[EventEdge]]) -> Iterator[_Communication]:
        """Yield the events of a channel; report automata that use it in several ways."""
        channel: sct.Event = declared.element
        users: dict[str, dict[Scope, list[EventEdge]]] = {"!": {}, "?": {}, "": {}}
        for scope, own in edges.items():
            uses = {edge.use: edge for edge in own if edge.event is channel}
            if len(uses) > 1:
                first, second, *_ = uses
                message = f"`{scope.path}` {_WORDS[first]} `{declared.name}` and {_WORDS[second]} it"
                with self._names.reporting():
                    raise CifFaultError(uses[second].node, "type", message, "use two automata")
            for use in uses:
                users[use][scope] = [edge for edge in own if edge.event is channel and edge.use == use]
        pairs = list(islice(_pairs(channel, users["!"], users["?"]), _MOST + 1))
        if len(pairs) > _MOST:
            message = f"the uncontrollable channel `{declared.name}` has more than {_MOST} pairs of sender and receiver"
            with self._names.reporting():
                raise CifFaultError(declared.node, "cif-construct", message, "divide it into several channels")
            return
        names = Names(declared.scope.names)
        for senders, receivers in pairs:
            event = channel
            if len(pairs) > 1:
                parties = "_".join(scope.path.replace(".", "_") for scope in (*senders, *receivers))
                name = names.fresh(f"{declared.name}_{parties}")
                event = sct.Event(
                    name=name, controllable=channel.controllable, kind=channel.kind, source=channel.source
                )
            sending = {scope: [replace(edge, event=event) for edge in own] for scope, own in senders.items()}
            value = None if declared.type == VOID else _value(sending)
            receiving = {
                scope: [self._receive(edge, event, scope, value) for edge in own] for scope, own in receivers.items()
            }
            yield _Communication(event, sending, receiving)
        if not pairs:
            # The updates of edges that never happen are only checked.
            for scope, own in users["?"].items():
                for edge in own:
                    self._receive(edge, channel, scope, _example(declared, edge.node))

    def _receive(self, edge: EventEdge, event: sct.Event, scope: Scope, value: TypedNode | None) -> EventEdge:
        """Return an edge with the updates that it makes if it receives a value; report their faults."""
        self._values.received = value
        try:
            with self._names.reporting():
                updates, fits = self._updates(edge.node, scope)
                return replace(edge, event=event, updates=updates, fits=fits)
        finally:
            self._values.received = None
        return edge


def _pairs(
    channel: sct.Event, senders: dict[Scope, list[EventEdge]], receivers: dict[Scope, list[EventEdge]]
) -> Iterator[tuple[dict[Scope, list[EventEdge]], dict[Scope, list[EventEdge]]]]:
    """Yield the senders and receivers of each event that a channel becomes."""
    if channel.controllable and senders and receivers:
        yield senders, receivers
        return
    for (sender, sending), (receiver, receiving) in product(senders.items(), receivers.items()):
        for own in _alternatives(sending):
            yield {sender: own}, {receiver: receiving}


def _alternatives(edges: list[EventEdge]) -> list[list[EventEdge]]:
    """Divide the edges of a sender so that each part sends one value in a location."""
    parts: list[list[EventEdge]] = []
    for edge in edges:
        free = (
            part for part in parts if edge.sent is None or all(other.location is not edge.location for other in part)
        )
        part = next(free, None)
        if part is None:
            parts.append(part := [])
        part.append(edge)
    return parts


def _value(senders: dict[Scope, list[EventEdge]]) -> TypedNode:
    """Return the sent value, which depends on the edge that can be taken."""
    edges = [edge for own in senders.values() for edge in own]
    located = len(senders) == 1 and len({edge.location for edge in edges}) == len(edges)
    result: TypedNode | None = None
    for edge in reversed(edges):
        condition = _possible(edge, guarded=not located)
        value = edge.sent
        assert value is not None
        if result is None or condition is None:
            result = value
            continue
        kind: Type = join_types(value.type, result.type)
        choice = ex.Conditional(condition=condition, then=copy_tree(value.expression), otherwise=result.expression)
        result = TypedNode(value.node, choice, kind)
    assert result is not None
    return result


def _possible(edge: EventEdge, *, guarded: bool = True) -> ex.Expression | None:
    """Return the condition on the state in which an edge can be taken, or None if that is always so."""
    guard = [copy_tree(edge.guard)] if guarded and edge.guard is not None else []
    return conjunction([*at(edge.location, edge.location.eContainer()), *guard])


def _staying(scope: Scope, parties: dict[Scope, list[EventEdge]], event: sct.Event) -> Iterator[EventEdge]:
    """Yield the edges with which an automaton stays while another one sends, or receives."""
    assert scope.plant is not None
    for other, own in parties.items():
        if other is scope:
            continue
        conditions = [_possible(edge) for edge in own]
        always = any(condition is None for condition in conditions)
        guard = None if always else disjunction(condition for condition in conditions if condition is not None)
        for location in scope.plant.locations:
            yield EventEdge(location, event, guard, {}, [], location, own[0].node, own[0].use)


def _example(declared: Declaration, node: Any) -> TypedNode | None:
    """Return a value of the type of a channel, or None if it transfers none."""
    if declared.type == VOID:
        return None
    kind = range(-LARGEST - 1, LARGEST + 1) if declared.type == "int" else declared.type
    return TypedNode(node, literal(default(kind)), kind)
