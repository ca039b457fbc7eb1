"""From a robot model to the ROS side of its controller (thesis 5.3, table 5.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.m2m.constants import default_value, initial_value, literal
from robosc.m2m.enumerations import Enumerations
from robosc.m2m.node_expressions import NodeExpressions
from robosc.m2m.trace import EVENT_OF
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph, sct
from robosc.ros_types import RosTypes, Section
from robosc.semantics.cone_of_influence import transitions
from robosc.semantics.instances import Instance, InstanceVariable, PortInstance
from robosc.semantics.naming import Names

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.m2m.trace import Trace

#: The wire types of basic data without `links`, all of std_msgs.
_BASIC = {
    robosc.BooleanDataType: "Bool",
    robosc.IntegerDataType: "Int16",
    robosc.DoubleDataType: "Float32",
    robosc.StringDataType: "String",
    robosc.NoneDataType: "Empty",
}
#: The field that holds a basic value in a type of std_msgs.
_FIELD = "data"


class _Part(NamedTuple):
    """What one event of a communication carries, in which part of its ROS type."""

    port: PortInstance
    type: robosc.DataType
    part: Section


def transform(trace: Trace, interfaces: RosTypes | None = None) -> rosgraph.RosGraph:
    """The ROS graph of the robot whose transformation to the sct model left this trace.

    `interfaces` is what is known of ROS types; None: what is known without folders of the call.
    Topics, services and actions stand in the order of the text. All messages that one topic feeds with one ROS type
    are one subscription.
    """
    return _Transformation(trace, interfaces or RosTypes()).run()


class _Transformation:
    def __init__(self, trace: Trace, interfaces: RosTypes) -> None:
        self.trace = trace
        self.known = interfaces
        self.instances = trace.instances
        robot = self.instances.base
        self.graph = rosgraph.RosGraph(name=robot.name, model=trace.model, source=robot.source)
        self.interfaces: dict[tuple[str, str, str], rosgraph.Interface] = {}
        self.variables: dict[InstanceVariable, rosgraph.NodeVariable] = {}
        self.conversions: dict[robosc.EnumDataType, rosgraph.Conversion] = {}
        self.enumerations = Enumerations(self.graph, trace.enumerations)
        self.conversion_names = Names()
        self.subscriptions: dict[tuple[str, rosgraph.Interface], rosgraph.Subscription] = {}
        self.publishers: dict[tuple[str, rosgraph.Interface], rosgraph.Publisher] = {}
        self.expressions = NodeExpressions(trace, self.variables, self.enumerations)

    def run(self) -> rosgraph.RosGraph:
        for instance in self.instances:
            for definition in instance.automaton.definitions if instance.automaton else ():
                if isinstance(definition, robosc.Variable):
                    self.variable(InstanceVariable(instance, definition))
        for port in self.instances.ports():
            if isinstance(port.communication, robosc.Message):
                self.message(port, port.communication)
            elif isinstance(port.communication, robosc.Service):
                self.service(port, port.communication)
            elif isinstance(port.communication, robosc.Action):
                self.action(port, port.communication)
        for instance in self.instances:
            self.reactions(instance)
        return self.graph

    # Data that the node keeps

    def variable(self, owned: InstanceVariable) -> None:
        if owned in self.trace.variables:
            return
        value = initial_value(owned.variable)
        variable = rosgraph.NodeVariable(
            name=owned.variable.name,
            component=owned.instance.name,
            type=self.type(owned.variable.type),
            initial=literal(self.enumerations.literal(value) if isinstance(value, robosc.EnumValue) else value),
            source=owned.variable.source,
        )
        self.variables[owned] = variable
        self.graph.variables.append(variable)

    def type(self, kind: robosc.DataType) -> ex.Type:
        match kind:
            case robosc.BooleanDataType():
                return ex.BooleanType()
            case robosc.IntegerDataType():
                return ex.IntegerType(minimum=kind.minimum, maximum=kind.maximum)
            case robosc.DoubleDataType():
                return ex.DoubleType()
            case robosc.StringDataType():
                return ex.StringType()
        assert isinstance(kind, robosc.ComplexDataTypeReference)
        assert isinstance(kind.type, robosc.EnumDataType)
        return ex.EnumerationType(enumeration=self.enumerations.enumeration(kind.type))

    # Communication

    def message(self, port: PortInstance, message: robosc.Message) -> None:
        topic = port.instance.topic(message)
        interface = self.interface(message, message.type, rosgraph.InterfaceKind.message)
        # Written with a slash or without, it is one topic, and what comes on it one batch.
        key = topic.removeprefix("/"), interface
        where = message.source
        if message.direction == robosc.MessageDirection.outgoing:
            subscription = self.subscriptions.get(key)
            if subscription is None:
                subscription = rosgraph.Subscription(topic=topic, interface=interface, source=where)
                self.subscriptions[key] = subscription
                self.graph.subscriptions.append(subscription)
            subscription.receptions.append(self.reception(port, robosc.ResultType.response))
        else:
            publisher = self.publishers.get(key)
            if publisher is None:
                publisher = rosgraph.Publisher(topic=topic, interface=interface, source=where)
                self.publishers[key] = publisher
                self.graph.publishers.append(publisher)
            publisher.sendings.append(self.sending(port))

    def service(self, port: PortInstance, service: robosc.Service) -> None:
        self.graph.serviceClients.append(
            rosgraph.ServiceClient(
                identifier=port.instance.topic(service),
                interface=self.interface(service, service.requestType, rosgraph.InterfaceKind.service),
                request=self.sending(port),
                response=self.reception(port, robosc.ResultType.response),
                error=self.trace.event(port, sct.EventKind.error),
                reset=self.trace.event(port, sct.EventKind.reset),
                source=service.source,
            )
        )

    def action(self, port: PortInstance, action: robosc.Action) -> None:
        self.graph.actionClients.append(
            rosgraph.ActionClient(
                identifier=port.instance.topic(action),
                interface=self.interface(action, action.requestType, rosgraph.InterfaceKind.action),
                request=self.sending(port),
                feedback=self.reception(port, robosc.ResultType.feedback),
                response=self.reception(port, robosc.ResultType.response),
                error=self.trace.event(port, sct.EventKind.error),
                cancel=self.trace.event(port, sct.EventKind.cancel),
                reset=self.trace.event(port, sct.EventKind.reset),
                source=action.source,
            )
        )

    def interface(
        self, communication: robosc.CommunicationType, carried: robosc.DataType, kind: rosgraph.InterfaceKind
    ) -> rosgraph.Interface:
        linked = communication.interface
        if linked is not None:
            package, name = linked.package, linked.type
        elif kind == rosgraph.InterfaceKind.service:
            package, name = "std_srvs", "Empty"
        else:
            package, name = "std_msgs", _BASIC[type(_wire_type(carried))]
        key = (package, name, kind.name)
        if key not in self.interfaces:
            interface = rosgraph.Interface(package=package, type=name, kind=kind)
            interface.source = linked.source if linked is not None else None
            self.interfaces[key] = interface
            self.graph.interfaces.append(interface)
        return self.interfaces[key]

    def sending(self, port: PortInstance) -> rosgraph.Sending:
        sending = rosgraph.Sending(
            name=port.communication.name,
            event=self.trace.event(port, sct.EventKind.trigger),
            source=port.communication.source,
        )
        for statement in self.instances.provided(port):
            alternative = rosgraph.ProvidedData(location=self.trace.provided[statement], source=statement.source)
            sent = _sent(port)
            lone = () if isinstance(statement.data, robosc.ObjectValue) else (self.field(sent),)
            for field in self.fields(statement.data, lone, sent.type):
                alternative.fields.append(field)
            sending.alternatives.append(alternative)
        return sending

    def fields(
        self, data: ex.Expression, path: tuple[str, ...], declared: robosc.DataType
    ) -> list[rosgraph.FieldAssignment]:
        if isinstance(data, robosc.ObjectValue):
            return [
                field
                for given in data.properties
                for field in self.fields(given.value, (*path, given.property.name), given.property.type)
            ]
        value = self.expressions(data, None)
        return [
            rosgraph.FieldAssignment(
                path=list(path),
                type=self.type(declared),
                value=self.expressions.as_double(value) if isinstance(declared, robosc.DoubleDataType) else value,
                source=data.source,
            )
        ]

    # Data that comes in

    def reception(self, port: PortInstance, result_type: robosc.ResultType) -> rosgraph.Reception:
        part = _received(port, result_type)
        assert part is not None
        reception = rosgraph.Reception(
            name=port.communication.name,
            event=self.trace.event(port, EVENT_OF[result_type.name]),
            source=port.communication.source,
        )
        for data, declared in self.trace.inputs.items():
            if data.port == port and data.result_type == result_type:
                segments = [robosc.PropertySegment(property=part) for part in data.path]
                reception.inputs.append(rosgraph.InputAssignment(input=declared, value=self.wire(part)(segments)))
        return reception

    def field(self, part: _Part) -> str:
        """The field that holds a basic value."""
        linked = part.port.communication.interface
        return _FIELD if linked is None else self.known.field_of_basic(linked.package, linked.type, part.part)

    def wire(self, part: _Part) -> Callable[[Sequence[robosc.AccessSegment]], ex.Expression]:
        """What `value` with its segments means where the ROS message carries this part."""
        is_basic = not isinstance(_wire_type(part.type), robosc.ComplexDataTypeReference)

        def access(segments: Sequence[robosc.AccessSegment]) -> ex.Expression:
            steps, reached = _steps(segments, part.type)
            if is_basic:
                steps.insert(0, rosgraph.FieldStep(name=self.field(part)))
            if isinstance(reached, robosc.ComplexDataTypeReference) and isinstance(reached.type, robosc.EnumDataType):
                conversion = self.conversion(reached.type)
                argument = rosgraph.WireAccess(steps=steps, type=self.basic_type(reached.type.type))
                return rosgraph.ConversionCall(conversion=conversion, argument=argument)
            return rosgraph.WireAccess(steps=steps, type=self.basic_type(reached))

        return access

    def basic_type(self, kind: robosc.DataType) -> ex.Type | None:
        return self.type(kind) if isinstance(kind, robosc.BasicDataType) else None

    def conversion(self, enum: robosc.EnumDataType) -> rosgraph.Conversion:
        """Listing 5.13."""
        if enum not in self.conversions:
            conversion = rosgraph.Conversion(
                name=self.conversion_names.fresh(enum.name),
                enumeration=self.enumerations.enumeration(enum),
                default=self.enumerations.literal(default_value(enum)),
                source=enum.source,
            )
            self.conversions[enum] = conversion
            for rule in enum.rules:
                if isinstance(rule, robosc.EnumTransformationRule):
                    condition = self.expressions(rule.condition, None, self.argument(enum.type))
                    conversion.rules.append(
                        rosgraph.ConversionRule(
                            condition=condition,
                            literal=self.enumerations.literal(rule.value),
                            source=rule.source,
                        )
                    )
            self.graph.conversions.append(conversion)
        return self.conversions[enum]

    def argument(self, whole: robosc.DataType) -> Callable[[Sequence[robosc.AccessSegment]], ex.Expression]:
        """What `value` with its segments means in the rules of an enum over this type."""

        def access(segments: Sequence[robosc.AccessSegment]) -> ex.Expression:
            steps, reached = _steps(segments, whole)
            if isinstance(reached, robosc.ComplexDataTypeReference) and isinstance(reached.type, robosc.EnumDataType):
                nested = rosgraph.WireAccess(steps=steps, type=self.basic_type(reached.type.type))
                return rosgraph.ConversionCall(conversion=self.conversion(reached.type), argument=nested)
            return rosgraph.WireAccess(steps=steps, type=self.basic_type(reached))

        return access

    # What events change in the node

    def reactions(self, instance: Instance) -> None:
        assert instance.automaton is not None or not list(transitions(instance))
        for transition, state in transitions(instance):
            assigned = self.instances.assignments(transition, instance)
            assignments = {owned: assignment for owned, assignment in assigned.items() if owned in self.variables}
            if not assignments:
                continue
            event, data = self.event_and_data(transition, instance)
            places = self.trace.behaviours[instance].locations
            reaction = rosgraph.Reaction(
                event=event,
                locations=list(places) if state is None else [self.trace.locations[instance, state]],
                source=transition.source,
            )
            for owned, assignment in assignments.items():
                variable = self.variables[owned]
                value = self.expressions(assignment.value, instance, data)
                reaction.assignments.append(
                    rosgraph.NodeAssignment(variable=variable, value=value, source=assignment.source)
                )
            self.graph.reactions.append(reaction)

    def event_and_data(
        self, transition: robosc.Transition, instance: Instance
    ) -> tuple[sct.Event, Callable[[Sequence[robosc.AccessSegment]], ex.Expression] | None]:
        if isinstance(transition, robosc.TauTransition):
            return self.trace.taus[instance, transition], None
        assert isinstance(transition, robosc.ResultTransition)
        port = self.instances.port(transition.communicationType, instance)
        assert port is not None
        event = self.trace.event(port, EVENT_OF[transition.resultType.name])
        carried = _received(port, transition.resultType)
        return event, None if carried is None else self.wire(carried)


def _wire_type(kind: robosc.DataType) -> robosc.DataType:
    """An enum has the wire type of its base."""
    if isinstance(kind, robosc.ComplexDataTypeReference) and isinstance(kind.type, robosc.EnumDataType):
        return _wire_type(kind.type.type)
    return kind


def _steps(
    segments: Sequence[robosc.AccessSegment], whole: robosc.DataType
) -> tuple[list[rosgraph.WireStep], robosc.DataType]:
    """The steps into ROS data that segments mean, and the type of what they reach."""
    steps: list[rosgraph.WireStep] = []
    reached = whole
    for segment in segments:
        if isinstance(segment, robosc.PropertySegment):
            steps.append(rosgraph.FieldStep(name=segment.property.name))
            reached = segment.property.type
        else:
            assert isinstance(segment, robosc.IndexSegment)
            assert isinstance(reached, robosc.Array)
            steps.append(rosgraph.IndexStep(index=segment.index))
            reached = reached.type
    return steps, reached


def _sent(port: PortInstance) -> _Part:
    match port.communication:
        case robosc.Message() as message:
            return _Part(port, message.type, Section.MESSAGE)
        case robosc.Service() as service:
            return _Part(port, service.requestType, Section.REQUEST)
    assert isinstance(port.communication, robosc.Action)
    return _Part(port, port.communication.requestType, Section.GOAL)


def _received(port: PortInstance, result_type: robosc.ResultType) -> _Part | None:
    """The data that an event of a communication brings; None for the events that bring none."""
    communication = port.communication
    if result_type == robosc.ResultType.feedback and isinstance(communication, robosc.Action):
        return _Part(port, communication.feedbackType, Section.FEEDBACK)
    if result_type != robosc.ResultType.response:
        return None
    match communication:
        case robosc.Message():
            return _Part(port, communication.type, Section.MESSAGE)
        case robosc.Service():
            return _Part(port, communication.responseType, Section.RESPONSE)
    assert isinstance(communication, robosc.Action)
    return _Part(port, communication.responseType, Section.RESULT)
