"""Template values of a node: a ROS graph with all expressions, names and types as C++."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import groupby
from typing import TYPE_CHECKING

from robosc.language.configuration.parameters import model_parameters
from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.expressions import type_name
from robosc.m2t.ros import reports
from robosc.m2t.ros.expressions import CppPrinter
from robosc.m2t.ros.names import CppNames
from robosc.model import engine, rosgraph, sct
from robosc.model import expression as ex
from robosc.model.reflection import tree
from robosc.model.semantics.component_parts import answers
from robosc.model.semantics.definition import reported_variables
from robosc.model.semantics.messages import (
    EACH,
    doubles_read,
    fields_set,
    find_message,
    first_value,
    holds_objects,
    is_structured,
    limit_expressions,
    parts_with_headers,
    path_of,
    paths_set,
    reads_elements,
    reads_parameters,
    reads_reason,
    stored_doubles,
)
from robosc.model.semantics.naming import Names
from robosc.model.semantics.operators import PRECEDENCE
from robosc.model.semantics.roles import assumptions, component_name
from robosc.model.semantics.typing import DOUBLE, ArrayType, infer
from robosc.model.semantics.walks import parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.model.semantics.messages import Path

#: Method of an action's server that sends an answer.
_ANSWERED_BY = {"feedback": "publish", "response": "succeed", "error": "abort", "canceled": "canceled"}
#: Method that writes a field unchanged.
_HAND_ON = "hand_on"


@dataclass(frozen=True)
class Assignment:
    """An assignment `target = value`. Arrays and objects are assigned by a function."""

    target: str
    value: str
    function: str = ""

    @property
    def statement(self) -> str:
        """The assignment, with a semicolon."""
        stored = f"{self.function}({self.target}, {self.value});"
        return stored if self.function else f"{self.target} = {self.value};"


@dataclass(frozen=True)
class Reaction:
    """Assignments under a condition on the data and the state before the event; None: always. `needs` are only read."""

    condition: str | None
    needs: list[str]
    assignments: list[Assignment]


@dataclass(frozen=True)
class EventHandler:
    """The node's handler of an event: its inputs, its data and its changes to the node.

    `copy` is the copy of the node's variables. `old` is read while the variables change; `next` changes while the
    variables are read; "" is no copy. A handler that `reads_elements` of arrays changes only a copy. The event does not
    happen if an element is missing; inputs with elements are among the reactions, if a transition reads them. A handler
    that `reads_reason` reads the reason of an error. An event that is `assumed` may violate an assumption; `component`
    is a literal. The inputs of an event that is `decided` decide whether it can happen.
    """

    event: str
    name: str
    inputs: list[Assignment]
    reads_elements: bool
    copy: str
    reactions: list[Reaction]
    data: reports.EventData | None
    reads_reason: bool = False
    assumed: bool = False
    component: str = ""
    decided: bool = False


@dataclass(frozen=True)
class Subscription:
    """A topic that the node subscribes to.

    `word` is valid in names. `unread`: the node ignores the content of its messages.
    """

    word: str
    topic: str
    interface: rosgraph.Interface
    receptions: list[EventHandler]
    unread: bool

    @property
    def may_be_unheard(self) -> bool:
        """Whether a message may count as not received: unreadable, or against an assumption."""
        return any(handler.reads_elements or handler.assumed for handler in self.receptions)


@dataclass(frozen=True)
class Alternative:
    """The data of one provide statement under a condition.

    The fields are in groups with a condition, None if it is always true. A field is a writing method, a name and a
    value.
    """

    condition: str
    fields: list[tuple[str | None, list[tuple[str, str, str]]]]


@dataclass(frozen=True)
class Limit:
    """A change of data to be sent, under a condition, None if it is always true. `fields` as in `Alternative`."""

    condition: str | None
    fields: list[tuple[str | None, list[tuple[str, str, str]]]]


@dataclass(frozen=True)
class Message:
    """Data that the node sends: a message, a request or a goal.

    `on_change` are the fields to compare if the message is sent only on change. Sending may fail if a double may not be
    finite, or if the message `reads_elements` of arrays. `reaction` are the changes in the node. `parts` are those that
    may hold headers for the node to fill in; "" is the whole message. `limits` change the data; they read `before`, a
    copy of it. `inputs` are statements that set the supervisor's inputs from the data, `message`. They may read
    elements of arrays if `inputs_may_fail`. `doubles` are statements that require the doubles of both to be finite.
    `decisive` is the data that the inputs read, for the log of a layer.
    """

    word: str
    event: str
    requirements: Sequence[str]
    alternatives: list[Alternative]
    may_fail: bool
    reads_elements: bool
    on_change: list[str] | None
    reaction: EventHandler | None
    parts: list[str]
    limits: list[Limit]
    doubles: list[str]
    inputs: list[str]
    inputs_may_fail: bool
    decisive: reports.EventData | None


@dataclass(frozen=True)
class Publisher:
    """A topic that the node publishes on."""

    word: str
    topic: str
    interface: rosgraph.Interface
    messages: list[Message]

    @property
    def on_change(self) -> bool:
        """Whether all messages are sent on change only."""
        return all(message.on_change is not None for message in self.messages)


@dataclass(frozen=True)
class Client:
    """A service that the node calls, or an action that it starts. Only actions have feedback and can be canceled.

    `unread` is the log's data of an unreadable answer, which is an error.
    """

    word: str
    name: str
    interface: rosgraph.Interface
    request: Message
    response: EventHandler
    unread: reports.EventData | None
    error: EventHandler
    feedback: EventHandler | None
    canceled: EventHandler | None
    cancel: str | None
    cancel_requirements: Sequence[str]
    reset: str

    @property
    def data(self) -> str:
        """Member that holds the sent data."""
        return f"{self.word}_{'goal' if self.cancel else 'request'}_"


@dataclass(frozen=True)
class Answer:
    """An answer of a server: `method` of its class, and the data. `kind` is `response` or `feedback`."""

    method: str
    kind: str
    message: Message


@dataclass(frozen=True)
class Server:
    """A service or an action that the node serves.

    `request` is a request or a goal. `cancel` is the handler of a client's cancel, None if the node accepts none.
    """

    word: str
    name: str
    interface: rosgraph.Interface
    request: EventHandler
    cancel: EventHandler | None
    answers: list[Answer]

    @property
    def is_action(self) -> bool:
        """Whether it is an action."""
        return self.interface.kind == rosgraph.InterfaceKind.action


@dataclass(frozen=True)
class LastMessage:
    """A message that is sent in spite of all requirements, and the requirements that this overrides."""

    publisher: Publisher
    message: Message
    overrides: list[str]


@dataclass(frozen=True)
class Enumeration:
    """An enumeration that only the node has: its literals in C++ and in the model."""

    name: str
    literals: list[tuple[str, str]]


@dataclass(frozen=True)
class ConversionRule:
    """A rule of a conversion."""

    condition: str
    literal: str
    reads_elements: bool


@dataclass(frozen=True)
class Conversion:
    """A function from data to a literal."""

    name: str
    function: str
    type: str
    rules: list[ConversionRule]
    default: str
    reads_parameters: bool


@dataclass(frozen=True)
class Reasons:
    """The enumeration of reasons: its type, and the literal for each value of the headers."""

    type: str
    literals: list[tuple[str, str]]


@dataclass(frozen=True)
class Variable:
    """A variable of the node: its type and initial value, or the part of ROS data whose type it has."""

    name: str
    type: str
    initial: str
    part: Part | None = None


@dataclass(frozen=True)
class Part:
    """A part of incoming data: of a message, or of the `response` or `feedback` of a client; and the path to it."""

    kind: str
    interface: rosgraph.Interface
    path: str
    is_array: bool


class GeneratedNode:
    """The node of one graph, prepared for the templates, in the order of the model.

    `on_shutdown` names the messages to send when the node stops the robot, `on_withheld` those to send if the data of a
    command cannot be sent, `on_blocked` those that a layer sends in place of blocked ones. The node must send each of
    them.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        executed: engine.EngineModel,
        on_shutdown: Sequence[str] = (),
        on_withheld: Sequence[str] = (),
        on_blocked: Sequence[str] = (),
    ) -> None:
        self._graph = graph
        self._names = CppNames(graph)
        self._printer = CppPrinter(self._names)
        self._events = {event.event: event for event in executed.events}
        self._sent = Names()
        self.robot = graph.name
        self.prefix = self._names.c.prefix
        #: Time argument of engine calls; empty if the model has no timers.
        self.at = ", alarm_->at()" if executed.timers else ""
        self.enumerations = [self._enumeration(enumeration) for enumeration in graph.enumerations]
        self.conversions = [self._conversion(conversion) for conversion in graph.conversions]
        self._carriers: dict[rosgraph.Reception, tuple[str, rosgraph.Interface]] = {}
        for topic in graph.subscriptions:
            self._carriers |= dict.fromkeys(topic.receptions, ("type", topic.interface))
        clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
        for client in clients:
            self._carriers[client.response] = "response", client.interface
        for action in graph.actionClients:
            self._carriers[action.feedback] = "feedback", action.interface
            self._carriers |= dict.fromkeys([action.error, action.canceled], ("response", action.interface))
        self._carriers |= {server.request: ("request", server.interface) for server in graph.serviceServers}
        self._carriers |= {server.request: ("goal", server.interface) for server in graph.actionServers}
        self.components = [
            (self._names.components[component], list(map(self._variable, variables)))
            for component, variables in self._names.stored.items()
        ]
        if graph.parameters:
            self.components.append((self._names.parameters, list(map(self._variable, graph.parameters))))
        self._reactions: dict[sct.Event, list[rosgraph.Reaction]] = {}
        for reaction in graph.reactions:
            self._reactions.setdefault(reaction.event, []).append(reaction)
        #: Parameters on the robot: name, type, and place in the node.
        self.parameters = [
            (known.name, self._type(parameter.type), self._names.variable(parameter))
            for parameter, known in model_parameters(graph).items()
        ]
        #: Timers with a duration from a parameter: its place in the node, its unit in milliseconds, the engine's
        #: setting.
        self.durations = [
            {"place": self._names.variable(parameter), "unit": duration.unit, "member": self._names.c.setting(duration)}
            for parameter in graph.parameters
            for duration in parameter.durations
        ]
        self.subscriptions = [self._subscription(subscription) for subscription in graph.subscriptions]
        self.publishers = [self._publisher(publisher) for publisher in graph.publishers]
        self.services = [self._client(client) for client in graph.serviceClients]
        self.actions = [self._client(client) for client in graph.actionClients]
        self.servers = [self._server(server) for server in (*graph.serviceServers, *graph.actionServers)]
        self.shutdown = [self._last(name) for name in on_shutdown]
        self.instead = [self._last(name) for name in on_withheld]
        self.on_blocked = [self._last(name) for name in on_blocked]
        outside = {reception.event for topic in graph.subscriptions for reception in topic.receptions}
        outside |= {sending.event for topic in graph.publishers for sending in topic.sendings}
        for service in graph.serviceClients:
            outside |= {service.request.event, service.response.event, service.error.event}
        for action in graph.actionClients:
            outside |= {action.request.event, action.feedback.event, action.response.event}
            outside |= {action.error.event, action.canceled.event}
        for server in (*graph.serviceServers, *graph.actionServers):
            outside |= {server.request.event, *(sending.event for sending in answers(server).values())}
            outside |= {server.cancel} if isinstance(server, rosgraph.ActionServer) else set()
        self.internal = [self._handler(event) for event in self._reactions if event not in outside]
        shown = reported_variables(graph)
        self.reported = [
            reports.component(plant, shown.get(plant.origin, ()), self._names)
            for plant in graph.model.plants
            if plant.kind == sct.PlantKind.behaviour
        ]

    @property
    def clients(self) -> list[Client]:
        """Services, then actions."""
        return [*self.services, *self.actions]

    @property
    def sent(self) -> list[tuple[Publisher | Client | Server, Message]]:
        """All data that the node sends, with its topic, service or action."""
        sent: list[tuple[Publisher | Client | Server, Message]] = [
            (publisher, message) for publisher in self.publishers for message in publisher.messages
        ]
        sent += [(client, client.request) for client in self.clients]
        return sent + [(server, answer.message) for server in self.servers for answer in server.answers]

    @property
    def assumed(self) -> bool:
        """Whether the model has assumptions."""
        return bool(assumptions(self._graph.model))

    @property
    def may_withhold(self) -> bool:
        """Whether the data of a command may be impossible to send."""
        return any(message.may_fail or message.inputs for _, message in self.sent)

    @property
    def hands_on(self) -> bool:
        """Whether the node sends received objects unchanged."""
        messages = [message for _, message in self.sent]
        groups = [alternative.fields for message in messages for alternative in message.alternatives]
        groups += [limit.fields for message in messages for limit in message.limits]
        writings = (writing for fields in groups for _, several in fields for writing in several)
        return any(method == _HAND_ON for method, _, _ in writings)

    @property
    def limited(self) -> list[tuple[Publisher, Message]]:
        """Messages with limits."""
        return [
            (publisher, message) for publisher in self.publishers for message in publisher.messages if message.limits
        ]

    @property
    def decided(self) -> list[tuple[Publisher | Client | Server, Message]]:
        """Commands on which the supervisor decides with their data."""
        return [(owner, message) for owner, message in self.sent if message.inputs]

    @property
    def examined(self) -> list[tuple[Publisher | Client | Server, Message]]:
        """Commands whose data a layer limits, or with which the supervisor decides."""
        decided = [message.event for _, message in self.decided]
        return [*((owner, message) for owner, message in self.limited if message.event not in decided), *self.decided]

    @property
    def reason(self) -> Reasons | None:
        """Literals for the reasons of errors. None if the node reads no reasons."""
        error_reason = next((part for _, part in tree(self._graph) if isinstance(part, rosgraph.ErrorReason)), None)
        if error_reason is None:
            return None
        literals = [(literal.name, self._names.literal(literal)) for literal in error_reason.enumeration.literals]
        return Reasons(self._type(ex.EnumerationType(enumeration=error_reason.enumeration)), literals)

    @property
    def interfaces(self) -> list[rosgraph.Interface]:
        """Types in use, each once, by package and name."""
        used: list[Subscription | Publisher | Client | Server] = [*self.subscriptions, *self.publishers, *self.clients]
        used += self.servers
        by_name = {(kind.package, kind.type, kind.kind.name): kind for kind in (end.interface for end in used)}
        return [by_name[key] for key in sorted(by_name)]

    # Types

    def _type(self, kind: ex.Type) -> str:
        match kind:
            case ex.BooleanType():
                return "bool"
            case ex.IntegerType():
                return "Integer"
            case ex.DoubleType():
                return "double"
            case ex.StringType():
                return "std::string"
            case rosgraph.ArrayType() if kind.element is not None:
                return f"std::vector<{self._type(kind.element)}>"
        assert isinstance(kind, ex.EnumerationType)
        return self._names.enumeration(kind.enumeration) or f"std::{type_name(kind)}"

    def _variable(self, variable: rosgraph.NodeVariable) -> Variable:
        name, kind = self._names.member(variable), variable.type
        if variable.reception is not None and holds_objects(kind):
            sort, interface = self._carriers[variable.reception]
            path = "".join("[0]" if step == "0" else f".{step}" for step in variable.path)
            return Variable(name, "", "", Part(sort, interface, path, isinstance(kind, rosgraph.ArrayType)))
        if variable.initial is None:
            return Variable(name, self._type(kind), "{}")
        return Variable(self._names.member(variable), self._type(variable.type), self._printer(variable.initial))

    def _enumeration(self, enumeration: ex.Enumeration) -> Enumeration:
        literals = [(self._names.within(literal), literal.name) for literal in enumeration.literals]
        return Enumeration(self._names.within(enumeration), literals)

    def _conversion(self, conversion: rosgraph.Conversion) -> Conversion:
        printer = CppPrinter(self._names, data="value", node="kept")
        return Conversion(
            conversion.name,
            self._names.conversion(conversion),
            self._type(ex.EnumerationType(enumeration=conversion.enumeration)),
            [
                ConversionRule(
                    self._tested(rule, printer), self._names.literal(rule.literal), reads_elements(rule.condition)
                )
                for rule in conversion.rules
            ],
            self._names.literal(conversion.default),
            reads_parameters(conversion),
        )

    @staticmethod
    def _tested(rule: rosgraph.ConversionRule, printer: CppPrinter) -> str:
        """Return a rule's condition in a form that is valid before `&& read.complete()`."""
        printed = printer.printed(rule.condition)
        loose = printed.precedence < PRECEDENCE[ex.Conjunction] and reads_elements(rule.condition)
        return printed.tight if loose else printed.text

    # Incoming data

    def _subscription(self, subscription: rosgraph.Subscription) -> Subscription:
        receptions = [self._reception(reception) for reception in subscription.receptions]
        return Subscription(
            self._names.word(subscription),
            subscription.topic,
            subscription.interface,
            receptions,
            unread=not any(handler.data for handler in receptions),
        )

    def _reception(self, reception: rosgraph.Reception) -> EventHandler:
        values = self._values(reception)
        inputs = [self._input(assignment) for assignment in reception.inputs]
        handler = self._handler(reception.event, inputs, reports.received_parts(values, self._names))
        # An unreadable answer is an error, too. The reason selects the data for the log.
        is_error = reception.event.kind == sct.EventKind.error
        reads = is_error and (reads_reason(values) or handler.data is not None)
        return replace(handler, reads_reason=reads)

    def _values(self, reception: rosgraph.Reception) -> list[ex.Expression]:
        """Return all values that are computed from incoming data."""
        reactions = self._reactions.get(reception.event, ())
        assigned = (assignment.value for reaction in reactions for assignment in reaction.assignments)
        return [*(assignment.value for assignment in reception.inputs), *assigned]

    def _input(self, assignment: rosgraph.InputAssignment) -> Assignment:
        kind = assignment.input.type
        may_fail = reads_elements(assignment.value)
        printer = CppPrinter(self._names, reader="element") if may_fail else self._printer
        value = printer(assignment.value)
        if isinstance(kind, ex.IntegerType):
            value = f"{printer.integer(assignment.value, kind)}.to<std::{type_name(kind)}>()"
        if may_fail:
            value = f"read_or({self._first(kind)}, [&](ArrayReader& element) {{ return {value}; }})"
        return Assignment(f"supervisor_.inputs.{self._names.c.member(assignment.input)}", value)

    def _first(self, kind: ex.Type) -> str:
        value = first_value(kind)
        if isinstance(value, ex.EnumerationLiteral):
            return self._names.literal(value)
        return f"std::{type_name(kind)}{{{value}}}" if isinstance(kind, ex.IntegerType) else str(value).lower()

    def _handler(
        self,
        event: sct.Event,
        inputs: Sequence[Assignment] = (),
        data: reports.EventData | None = None,
    ) -> EventHandler:
        reactions = self._reactions.get(event, ())
        assignments = [assignment for reaction in reactions for assignment in reaction.assignments]
        assigned = {assignment.variable for assignment in assignments}
        keeps_old = any(
            isinstance(part, rosgraph.NodeVariableReference | rosgraph.WireAccess) and part.variable in assigned
            for assignment in assignments
            for part in parts(assignment.value)
        )
        guards = [reaction.guard for reaction in reactions if reaction.guard is not None]
        values = [*guards, *(assignment.value for assignment in assignments)]
        reads = any(map(reads_elements, values)) or any(reaction.needs for reaction in reactions)
        copy = ("next" if assignments else "") if reads else "old" if keeps_old else ""
        return EventHandler(
            self._names.c.enumerator(event),
            f"{event.eContainer().name}.{event.name}",
            list(inputs),
            reads,
            copy,
            self._merged(reactions, copy),
            data,
            assumed=any(reason.assumption is not None for reason in self._events[event].reasons),
            component=string_literal(component_name(event)),
            decided=self._events[event].guard.data is not None,
        )

    def _merged(self, reactions: Sequence[rosgraph.Reaction], copy: str) -> list[Reaction]:
        """Merge equal reactions of one component."""
        places: dict[tuple[sct.Plant, str | None, tuple[str, ...], tuple[Assignment, ...]], list[sct.Location]] = {}
        for reaction in reactions:
            guard = None if reaction.guard is None else self._printer.tight(reaction.guard)
            needs = tuple(map(self._printer, reaction.needs))
            assignments = tuple(self._assignment(assignment, copy) for assignment in reaction.assignments)
            key = reaction.locations[0].eContainer(), guard, needs, assignments
            places.setdefault(key, []).extend(reaction.locations)
        return [
            Reaction(self._condition(where, guard), list(needs), list(assignments))
            for (_, guard, needs, assignments), where in places.items()
        ]

    def _condition(self, locations: Sequence[sct.Location], guard: str | None) -> str | None:
        """Return the condition that a plant is in one of these locations and a guard holds.

        None if it is always true.
        """
        plants: dict[sct.Plant, int] = {}
        for location in locations:
            plants[location.eContainer()] = plants.get(location.eContainer(), 0) + 1
        if any(number == len(plant.locations) for plant, number in plants.items()):
            return guard
        place = " || ".join(self._names.is_in(location) for location in locations)
        if guard is None:
            return place
        return f"({place}) && {guard}" if len(locations) > 1 else f"{place} && {guard}"

    def _assignment(self, assignment: rosgraph.NodeAssignment, copy: str) -> Assignment:
        kind, value = assignment.variable.type, assignment.value
        node = "old" if copy == "old" else "data_"
        target = f"{'next' if copy == 'next' else 'data_'}.{self._names.variable(assignment.variable)}"
        printer = CppPrinter(self._names, node=node)
        if is_structured(kind) and isinstance(value, rosgraph.IfReadable):
            printer = CppPrinter(self._names, node=node, reader="element")
            lambda_text = f"[&](ArrayReader& element) {{ return {printer(value.value)}; }}"
            return Assignment(target, lambda_text, "store_if_readable")
        text = printer.integer(value, kind) if isinstance(kind, ex.IntegerType) else printer(value)
        return Assignment(target, text, "store" if is_structured(kind) else "")

    # Outgoing data

    def _publisher(self, publisher: rosgraph.Publisher) -> Publisher:
        return Publisher(
            self._names.word(publisher),
            publisher.topic,
            publisher.interface,
            [self._message(sending) for sending in publisher.sendings],
        )

    def _client(self, client: rosgraph.ServiceClient | rosgraph.ActionClient) -> Client:
        request = self._message(client.request)
        action = client if isinstance(client, rosgraph.ActionClient) else None
        return Client(
            request.word,
            client.identifier,
            client.interface,
            request,
            self._reception(client.response),
            reports.received_parts([*self._values(client.response), *self._values(client.error)], self._names),
            self._reception(client.error),
            self._reception(action.feedback) if action else None,
            self._reception(action.canceled) if action else None,
            self._names.c.enumerator(action.cancel) if action else None,
            self._events[action.cancel].remarks if action else [],
            self._names.c.enumerator(client.reset),
        )

    def _server(self, server: rosgraph.ServiceServer | rosgraph.ActionServer) -> Server:
        cancel = server.cancel if isinstance(server, rosgraph.ActionServer) else None
        word = self._sent.fresh(self._word(server.request.event))
        return Server(
            word,
            server.identifier,
            server.interface,
            self._reception(server.request),
            None if cancel is None else self._handler(cancel),
            [
                Answer(
                    _ANSWERED_BY[answer] if isinstance(server, rosgraph.ActionServer) else "respond",
                    "feedback" if answer == "feedback" else "response",
                    self._message(sending, f"{word}_{answer}"),
                )
                for answer, sending in answers(server).items()
            ],
        )

    def _last(self, name: str) -> LastMessage:
        sending = find_message(self._graph, name)
        assert sending is not None
        event = self._names.c.enumerator(sending.event)
        publisher, message = next(
            (topic, message) for topic in self.publishers for message in topic.messages if message.event == event
        )
        reasons = self._events[sending.event].reasons
        overrides = [reason.text for reason in reasons if reason.kind == engine.Origin.requirement]
        return LastMessage(publisher, message, overrides)

    def _word(self, event: sct.Event) -> str:
        """Return a word for the communication of an event."""
        plant: sct.Plant = event.eContainer()
        return self._names.c.member(plant).removeprefix(f"{plant.kind.name.removesuffix('Server')}_")

    def _message(self, sending: rosgraph.Sending, word: str | None = None) -> Message:
        fields = fields_set(sending)
        values = [part for field in fields for part in (field.condition, field.value) if part is not None]
        reads = any(map(reads_elements, [*values, *limit_expressions(sending)]))
        doubles, stored = doubles_read(sending), stored_doubles(sending)
        return Message(
            self._sent.fresh(word or self._word(sending.event)),
            self._names.c.enumerator(sending.event),
            self._events[sending.event].remarks,
            [self._alternative(provided) for provided in sending.alternatives],
            reads or bool(sending.limits and (doubles or stored)) or any(map(_may_be_infinite, fields)),
            reads,
            [".".join(path) for path in paths_set(sending)] if sending.onChange else None,
            self._handler(sending.event) if sending.event in self._reactions else None,
            [".".join(path) for path in parts_with_headers(sending)],
            [self._limit(limit) for limit in sending.limits],
            [*map(_required, doubles), *(self._required_stored(*each) for each in stored.items())],
            [self._command_input(assignment) for assignment in sending.inputs],
            any(reads_elements(assignment.value) or _is_ranged(assignment) for assignment in sending.inputs),
            reports.received_parts([assignment.value for assignment in sending.inputs], self._names),
        )

    def _required_stored(self, name: str, stored: ex.Expression) -> str:
        """Return the statement that requires a stored double, or the doubles of an array, to be finite."""
        value, label = self._printer(stored), string_literal(name)
        if isinstance(infer(stored), ArrayType):
            return f"for (const auto& element : {value}) write.require({label}, element);"
        return f"write.require({label}, {value});"

    def _command_input(self, assignment: rosgraph.InputAssignment) -> str:
        """Return the statement that sets an input of a command."""
        kind, value = assignment.input.type, self._printer(assignment.value)
        if isinstance(kind, ex.IntegerType) and isinstance(assignment.value, rosgraph.WireAccess):
            path = string_literal(".".join(path_of(assignment.value)))
            value = f"read.within({path}, {value}, {kind.minimum}, {kind.maximum}).to<std::{type_name(kind)}>()"
        elif isinstance(kind, ex.IntegerType):
            value = f"{self._printer.integer(assignment.value, kind)}.to<std::{type_name(kind)}>()"
        return Assignment(f"supervisor_.inputs.{self._names.c.member(assignment.input)}", value).statement

    def _limit(self, limit: rosgraph.DataLimit) -> Limit:
        printer = CppPrinter(self._names, data="before")
        condition = None if limit.condition is None else printer(limit.condition)
        return Limit(condition, self._groups(limit.fields, printer))

    def _alternative(self, provided: rosgraph.ProvidedData) -> Alternative:
        return Alternative(self._names.is_in(provided.location), self._groups(provided.fields, self._printer))

    def _groups(
        self, fields: Iterable[rosgraph.FieldAssignment], printer: CppPrinter
    ) -> list[tuple[str | None, list[tuple[str, str, str]]]]:
        conditions = groupby(fields, lambda field: None if field.condition is None else printer(field.condition))
        return [
            (condition, [self._writing_of(field, printer) for field in several]) for condition, several in conditions
        ]

    def _writing_of(self, assignment: rosgraph.FieldAssignment, printer: CppPrinter) -> tuple[str, str, str]:
        """Return the method that writes a field, the field's name, and its value."""
        name, value, kind = ".".join(assignment.path), assignment.value, assignment.type
        if holds_objects(kind) and isinstance(value, rosgraph.WireAccess):
            return _HAND_ON, name, printer(value)
        if isinstance(value, rosgraph.ArrayLiteral) and isinstance(kind, rosgraph.ArrayType):
            element = kind.element
            assert element is not None
            values = [_value(part, element, printer) for part in value.elements]
            return "set_elements", name, f"std::initializer_list<{self._type(element)}>{{{', '.join(values)}}}"
        return "set_elements" if is_structured(kind) else "set", name, _value(value, kind, printer)


def _value(value: ex.Expression, kind: ex.Type, printer: CppPrinter) -> str:
    return printer.integer(value, kind) if isinstance(kind, ex.IntegerType) else printer(value)


def _is_ranged(assignment: rosgraph.InputAssignment) -> bool:
    """Return whether an input is an integer of the data with a range. A layer forwards no number outside of it."""
    return isinstance(assignment.input.type, ex.IntegerType) and isinstance(assignment.value, rosgraph.WireAccess)


def _required(path: Path, data: str = "data", label: Path = ()) -> str:
    """Return the statement that requires the doubles at a path of data to be finite."""
    for index, step in enumerate(path):
        rest = path[index + 1 :]
        if step == EACH:
            element = f"element{len(label)}"
            return f"for (const auto& {element} : {data}) {_required(rest, element, label)}"
        if step.isdigit():
            return f"if ({data}.size() > {step}) {_required(rest, f'{data}[{step}]', (*label, step))}"
        data, label = f"{data}.{step}", (*label, step)
    return f"write.require({string_literal('.'.join(label))}, {data});"


def _may_be_infinite(field: rosgraph.FieldAssignment) -> bool:
    """Return whether a field may hold a double, and so a value that is not finite."""
    return holds_objects(field.type) or infer(field.value) in {DOUBLE, ArrayType(DOUBLE)}
