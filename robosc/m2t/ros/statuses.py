"""Statuses of components for `/diagnostics`, prepared for the templates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.names import identifier
from robosc.model.semantics.component_parts import STATELESS, components, request, servers
from robosc.model.semantics.naming import Names

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2t.ros.gates import Gate
    from robosc.m2t.ros.node import Client, GeneratedNode, Server, Subscription
    from robosc.model import rosgraph


@dataclass(frozen=True)
class Command:
    """A command in a status: key as a literal, gate, name, whether sending may fail, and action, if any."""

    key: str
    gate: Gate
    name: str
    may_fail: bool
    action: Client | None


@dataclass(frozen=True)
class Status:
    """The status of a component: a word for it, and its name, state and variables as C++ expressions.

    `state` is None if the component has no state.
    """

    word: str
    name: str
    state: str | None
    stateless: str
    variables: Sequence[tuple[str, str]]
    #: Commands to the component, and its incoming topics, clients and servers.
    commands: list[Command]
    topics: list[Subscription]
    clients: list[Client]
    servers: list[Server]
    #: Topics of its commands.
    commanded: list[str]

    def watched(self, version: int) -> list[str]:
        """Return the topics, services and actions whose faults a ROS version reports."""
        names = [*(topic.topic for topic in self.topics), *self.commanded]
        if version == 1:
            return [*names, *(f"{server.name}/status" for server in self.servers if server.is_action)]
        return [*names, *(client.name for client in self.clients), *(server.name for server in self.servers)]


def statuses(graph: rosgraph.RosGraph, node: GeneratedNode, gates: Mapping[rosgraph.Sending, Gate]) -> list[Status]:
    """Return the status of each component of a graph whose commands have these gates."""
    heard = dict(zip(graph.subscriptions, node.subscriptions, strict=True))
    called = dict(zip([*graph.serviceClients, *graph.actionClients], node.clients, strict=True))
    served = dict(zip(servers(graph), node.servers, strict=True))
    actions = {client.request.event: client for client in node.clients if client.cancel}
    failing = {message.event for _, message in node.sent if message.may_fail}
    reported = {component.name: component for component in node.reported}
    words = Names()
    return [
        Status(
            words.fresh(identifier(parts.name)),
            string_literal(parts.name),
            component.state if component else None,
            string_literal(STATELESS),
            component.variables if component else (),
            [
                Command(
                    string_literal(request(sending)),
                    gates[sending],
                    sending.name,
                    gates[sending].event in failing,
                    actions.get(gates[sending].event),
                )
                for sending in parts.commands
            ],
            [heard[topic] for topic in parts.topics],
            [called[client] for client in parts.clients],
            [served[server] for server in parts.servers],
            [publisher.topic for publisher in parts.publishers],
        )
        for parts in components(graph)
        for component in [reported.get(string_literal(parts.name))]
    ]
