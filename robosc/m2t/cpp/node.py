"""What the templates of a node print: a ROS graph with every expression, name and type as text of C++."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.types import type_name
from robosc.m2t.cpp import reports
from robosc.m2t.cpp.expressions import CppPrinter, parts
from robosc.m2t.cpp.names import CppNames
from robosc.m2t.cpp.reasons import Reasons
from robosc.m2t.cpp.shutdown import message_named
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.metamodel.expression_types import is_double
from robosc.semantics.headers import parts_with_headers
from robosc.semantics.printing import PRECEDENCE
from robosc.semantics.received import reads_elements

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass(frozen=True)
class Assignment:
    """`target = value`."""

    target: str
    value: str


@dataclass(frozen=True)
class Reaction:
    """Assignments under a condition on the state before the event; None: always."""

    condition: str | None
    assignments: list[Assignment]


@dataclass(frozen=True)
class Happening:
    """An event, its inputs, its data and what it changes in the node.

    `copy` of the node's variables: `old`, which values read while the variables change; `next`, which changes while
    values read the variables; or none. One that `reads_elements` of arrays changes a copy only, and does not happen
    where one is not there; inputs that do are among the reactions, where a transition reads them.
    """

    event: str
    name: str
    inputs: list[Assignment]
    reads_elements: bool
    copy: str
    reactions: list[Reaction]
    data: reports.EventData | None


@dataclass(frozen=True)
class Subscription:
    """A topic that the node listens to; `word` is fit for names. `unread`: nothing in its messages matters."""

    word: str
    topic: str
    interface: rosgraph.Interface
    receptions: list[Happening]
    unread: bool

    @property
    def reads_elements(self) -> bool:
        """Whether a message may be one that can't be read."""
        return any(each.reads_elements for each in self.receptions)


@dataclass(frozen=True)
class Alternative:
    """The data of one provide statement: names of fields and their values, under a condition on the state."""

    condition: str
    fields: list[tuple[str, str]]


@dataclass(frozen=True)
class Message:
    """Data that the node sends: a message, a request or a goal.

    It may fail where a double could be no finite number. `reaction` is what sending it changes in the node; `parts`
    may hold headers that are the node's to fill in, "" is the whole.
    """

    word: str
    event: str
    requirements: list[str]
    alternatives: list[Alternative]
    may_fail: bool
    reaction: Happening | None
    parts: list[str]


@dataclass(frozen=True)
class Publisher:
    """A topic that the node sends to."""

    word: str
    topic: str
    interface: rosgraph.Interface
    messages: list[Message]


@dataclass(frozen=True)
class Client:
    """A service that the node calls, or an action that it starts: only these have feedback and are cancelled."""

    word: str
    name: str
    interface: rosgraph.Interface
    request: Message
    response: Happening
    error: Happening
    feedback: Happening | None
    cancel: str | None
    cancel_requirements: list[str]
    reset: str

    @property
    def data(self) -> str:
        """The member that holds what is sent."""
        return f"{self.word}_{'goal' if self.cancel else 'request'}_"


@dataclass(frozen=True)
class LastMessage:
    """A message that goes out whatever is required of it, and the requirements that this overrides."""

    publisher: Publisher
    message: Message
    overrides: list[str]


@dataclass(frozen=True)
class Enumeration:
    """An enumeration that only the node knows: literals in C++ and in the model."""

    name: str
    literals: list[tuple[str, str]]


@dataclass(frozen=True)
class Rule:
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
    rules: list[Rule]
    default: str


@dataclass(frozen=True)
class Variable:
    """A variable of the node."""

    name: str
    type: str
    initial: str


class Node:
    """The node of one graph; everything is ready to be printed, in the order of the model.

    `on_shutdown` names the messages that go out when the node stops the robot, `on_withheld` those when data of a
    command can't be sent; each must be one that it sends.
    """

    def __init__(
        self, graph: rosgraph.RosGraph, on_shutdown: Sequence[str] = (), on_withheld: Sequence[str] = ()
    ) -> None:
        self._graph = graph
        self._names = CppNames(graph)
        self._printer = CppPrinter(self._names)
        self._reasons = Reasons(graph.model)
        self.robot = graph.name
        self.prefix = self._names.c.prefix
        self.enumerations = [self._enumeration(each) for each in graph.enumerations]
        self.conversions = [self._conversion(each) for each in graph.conversions]
        self.components = [
            (member, [self._variable(each) for each in graph.variables if each.component == component])
            for component, member in self._names.components.items()
        ]
        self.subscriptions = [self._subscription(each) for each in graph.subscriptions]
        self.publishers = [self._publisher(each) for each in graph.publishers]
        self.services = [self._service(each) for each in graph.serviceClients]
        self.actions = [self._action(each) for each in graph.actionClients]
        self.shutdown = [self._last(name) for name in on_shutdown]
        self.instead = [self._last(name) for name in on_withheld]
        outside = {each.event for topic in graph.subscriptions for each in topic.receptions}
        outside |= {each.event for topic in graph.publishers for each in topic.sendings}
        for service in graph.serviceClients:
            outside |= {service.request.event, service.response.event, service.error}
        for action in graph.actionClients:
            outside |= {action.request.event, action.feedback.event, action.response.event, action.error}
        silent = dict.fromkeys(each.event for each in graph.reactions if each.event not in outside)
        self.silent = [self._happening(event) for event in silent]
        self.reported = [
            reports.component(plant, [each for each in graph.variables if each.component == plant.origin], self._names)
            for plant in graph.model.plants
            if plant.kind == sct.PlantKind.behaviour
        ]

    @property
    def clients(self) -> list[Client]:
        """Services, then actions."""
        return [*self.services, *self.actions]

    @property
    def interfaces(self) -> list[rosgraph.Interface]:
        """The types in use, each once, by package and name."""
        used: list[Subscription | Publisher | Client] = [*self.subscriptions, *self.publishers, *self.clients]
        found = {(each.interface.package, each.interface.type, each.interface.kind.name): each for each in used}
        return [found[key].interface for key in sorted(found)]

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
        assert isinstance(kind, ex.EnumerationType)
        return self._names.enumeration(kind.enumeration) or f"std::{type_name(kind)}"

    def _variable(self, variable: rosgraph.NodeVariable) -> Variable:
        return Variable(self._names.member(variable), self._type(variable.type), self._printer(variable.initial))

    def _enumeration(self, enumeration: ex.Enumeration) -> Enumeration:
        literals = [(self._names.literal(each).rpartition("::")[2], each.name) for each in enumeration.literals]
        return Enumeration(str(self._names.enumeration(enumeration)).rpartition("::")[2], literals)

    def _conversion(self, conversion: rosgraph.Conversion) -> Conversion:
        printer = CppPrinter(self._names, data="value")
        return Conversion(
            conversion.name,
            self._names.conversion(conversion),
            self._type(ex.EnumerationType(enumeration=conversion.enumeration)),
            [
                Rule(self._tested(each, printer), self._names.literal(each.literal), reads_elements(each.condition))
                for each in conversion.rules
            ],
            self._names.literal(conversion.default),
        )

    @staticmethod
    def _tested(rule: rosgraph.ConversionRule, printer: CppPrinter) -> str:
        """A rule's condition, fit to stand before `&& read.complete()`."""
        loose = printer.precedence(rule.condition) < PRECEDENCE[ex.Conjunction] and reads_elements(rule.condition)
        return printer.tight(rule.condition) if loose else printer(rule.condition)

    # What comes in

    def _subscription(self, subscription: rosgraph.Subscription) -> Subscription:
        receptions = [self._reception(each) for each in subscription.receptions]
        return Subscription(
            self._names.word(subscription),
            subscription.topic,
            subscription.interface,
            receptions,
            unread=not any(each.data for each in receptions),
        )

    def _reception(self, reception: rosgraph.Reception) -> Happening:
        values = [each.value for each in reception.inputs]
        for reaction in self._reactions(reception.event):
            values += [each.value for each in reaction.assignments]
        inputs = [self._input(each) for each in reception.inputs]
        return self._happening(reception.event, inputs, reports.received(values, self._names))

    def _input(self, assignment: rosgraph.InputAssignment) -> Assignment:
        kind = assignment.input.type
        value = self._printer(assignment.value)
        if isinstance(kind, ex.IntegerType):
            value = f"{self._printer.integer(assignment.value, kind)}.to<std::{type_name(kind)}>()"
        return Assignment(f"supervisor_.inputs.{self._names.c.member(assignment.input)}", value)

    def _reactions(self, event: sct.Event) -> list[rosgraph.Reaction]:
        return [each for each in self._graph.reactions if each.event == event]

    def _happening(
        self,
        event: sct.Event,
        inputs: Sequence[Assignment] = (),
        data: reports.EventData | None = None,
    ) -> Happening:
        reactions = self._reactions(event)
        assignments = [each for reaction in reactions for each in reaction.assignments]
        assigned = {each.variable for each in assignments}
        keeps_old = any(
            isinstance(part, rosgraph.NodeVariableReference) and part.variable in assigned
            for each in assignments
            for part in parts(each.value)
        )
        reads = any(reads_elements(each.value) for each in assignments)
        copy = ("next" if assignments else "") if reads else "old" if keeps_old else ""
        return Happening(
            self._names.c.enumerator(event),
            f"{event.eContainer().name}.{event.name}",
            list(inputs),
            reads,
            copy,
            self._merged(reactions, copy),
            data,
        )

    def _merged(self, reactions: Sequence[rosgraph.Reaction], copy: str) -> list[Reaction]:
        """Reactions of one component that do the same become one."""
        places: dict[tuple[sct.Plant, tuple[Assignment, ...]], list[sct.Location]] = {}
        for each in reactions:
            assignments = tuple(self._assignment(assignment, copy) for assignment in each.assignments)
            places.setdefault((each.locations[0].eContainer(), assignments), []).extend(each.locations)
        return [Reaction(self._are_in(where), list(what)) for (_, what), where in places.items()]

    def _are_in(self, locations: Sequence[sct.Location]) -> str | None:
        """That a plant is in one of these locations of its own; None where one always is."""
        plants: dict[sct.Plant, int] = {}
        for each in locations:
            plants[each.eContainer()] = plants.get(each.eContainer(), 0) + 1
        if any(number == len(plant.locations) for plant, number in plants.items()):
            return None
        return " || ".join(self._names.is_in(each) for each in locations)

    def _assignment(self, assignment: rosgraph.NodeAssignment, copy: str) -> Assignment:
        kind = assignment.variable.type
        printer = CppPrinter(self._names, node="old") if copy == "old" else self._printer
        return Assignment(
            f"{'next' if copy == 'next' else 'data_'}.{self._names.variable(assignment.variable)}",
            printer.integer(assignment.value, kind) if isinstance(kind, ex.IntegerType) else printer(assignment.value),
        )

    # What goes out

    def _publisher(self, publisher: rosgraph.Publisher) -> Publisher:
        return Publisher(
            self._names.word(publisher),
            publisher.topic,
            publisher.interface,
            [self._message(each) for each in publisher.sendings],
        )

    def _service(self, client: rosgraph.ServiceClient) -> Client:
        return self._client(client, client.response, None, None)

    def _action(self, client: rosgraph.ActionClient) -> Client:
        return self._client(client, client.response, client.feedback, client.cancel)

    def _client(
        self,
        client: rosgraph.ServiceClient | rosgraph.ActionClient,
        response: rosgraph.Reception,
        feedback: rosgraph.Reception | None,
        cancel: sct.Event | None,
    ) -> Client:
        request = self._message(client.request)
        return Client(
            request.word,
            client.identifier,
            client.interface,
            request,
            self._reception(response),
            self._happening(client.error),
            self._reception(feedback) if feedback else None,
            self._names.c.enumerator(cancel) if cancel else None,
            self._reasons.of(cancel) if cancel else [],
            self._names.c.enumerator(client.reset),
        )

    def _last(self, name: str) -> LastMessage:
        sending = message_named(self._graph, name)
        assert sending is not None
        event = self._names.c.enumerator(sending.event)
        publisher, message = next(
            (topic, each) for topic in self.publishers for each in topic.messages if each.event == event
        )
        return LastMessage(publisher, message, self._reasons.requirements(sending.event))

    def _message(self, sending: rosgraph.Sending) -> Message:
        plant: sct.Plant = sending.event.eContainer()
        return Message(
            self._names.c.member(plant).removeprefix(f"{plant.kind.name}_"),
            self._names.c.enumerator(sending.event),
            self._reasons.of(sending.event),
            [self._alternative(each) for each in sending.alternatives],
            any(is_double(field.value) for each in sending.alternatives for field in each.fields),
            self._happening(sending.event) if self._reactions(sending.event) else None,
            [".".join(each) for each in parts_with_headers(sending)],
        )

    def _alternative(self, provided: rosgraph.ProvidedData) -> Alternative:
        return Alternative(
            self._names.is_in(provided.location),
            [(".".join(each.path), self._field(each)) for each in provided.fields],
        )

    def _field(self, assignment: rosgraph.FieldAssignment) -> str:
        kind = assignment.type
        if isinstance(kind, ex.IntegerType):
            return self._printer.integer(assignment.value, kind)
        return self._printer(assignment.value)
