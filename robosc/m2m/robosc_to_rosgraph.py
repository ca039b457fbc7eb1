"""Transformation of a robot model to the ROS side of its controller (thesis 5.3, table 5.3)."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from robosc.base.ros_types import RosTypes
from robosc.m2m.declarations import Declarations, default_value
from robosc.m2m.expressions import NodeExpressions, ReceivedValue
from robosc.m2m.single_precision import round_constants
from robosc.m2m.stored_types import StoredTypes
from robosc.model import expression as ex
from robosc.model import robosc, rosgraph, sct
from robosc.model.semantics.communication import (
    CONTROLLABLE,
    basis,
    data_type,
    event_of,
    events,
    happens_anyway,
    ros_type,
)
from robosc.model.semantics.cone_of_influence import guard_of
from robosc.model.semantics.durations import set_on_robot
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.inputs import Data, FailureReason
from robosc.model.semantics.instances import bound_arguments
from robosc.model.semantics.messages import EACH, holds_objects, is_structured, origins, reads_elements
from robosc.model.semantics.naming import Names
from robosc.model.semantics.printing import RoboscPrinter, conjunction
from robosc.model.semantics.state_values import StateValue
from robosc.model.semantics.typing import ArrayType, ObjectType, declared_type
from robosc.model.semantics.walks import branches

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from robosc.base.ros_types import Section
    from robosc.m2m.trace import Trace
    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.inputs import InputSource
    from robosc.model.semantics.instances import Instance, InstanceParameter, InstanceVariable, PortInstance, Statement

    _Translation = Callable[[ex.Expression], ex.Expression]
    _User = rosgraph.ServiceClient | rosgraph.ActionClient | rosgraph.ServiceServer | rosgraph.ActionServer

#: Field of a basic value in a type of std_msgs.
_FIELD = "data"


#: Kind of ROS type for each kind of communication.
_KINDS = {
    robosc.Message: rosgraph.InterfaceKind.message,
    robosc.Service: rosgraph.InterfaceKind.service,
    robosc.Action: rosgraph.InterfaceKind.action,
    robosc.OutgoingService: rosgraph.InterfaceKind.service,
    robosc.OutgoingAction: rosgraph.InterfaceKind.action,
}


def transform(trace: Trace, interfaces: RosTypes | None = None) -> rosgraph.RosGraph:
    """Return the ROS graph of a robot from the trace of its transformation to the sct model.

    `interfaces` holds the known ROS types. None: the types that are known without extra folders. Topics, services and
    actions are in the order of the text. Messages of one topic and ROS type share one subscription.
    """
    return _RoboscToRosgraph(trace, interfaces or RosTypes()).run()


class _RoboscToRosgraph:
    def __init__(self, trace: Trace, interfaces: RosTypes) -> None:
        self.trace = trace
        self.known = interfaces
        self.instances = trace.instances
        robot = self.instances.base
        self.graph = rosgraph.RosGraph(name=robot.name, model=trace.model, source=robot.source)
        self.interfaces: dict[tuple[str, str, str], rosgraph.Interface] = {}
        self.variables: dict[InstanceVariable, rosgraph.NodeVariable] = {}
        self.parameters: dict[InstanceParameter, rosgraph.Parameter] = {}
        self.conversions: dict[tuple[robosc.EnumDataType, tuple[str, ...]], rosgraph.Conversion] = {}
        self.declarations = Declarations(self.graph, trace.declarations)
        self.conversion_names = Names()
        self.stored_types = StoredTypes(self.declarations, self.known)
        self.carriers: dict[rosgraph.Reception, tuple[rosgraph.Interface, Section]] = {}
        self.subscriptions: dict[tuple[str, rosgraph.Interface], rosgraph.Subscription] = {}
        self.publishers: dict[tuple[str, rosgraph.Interface], rosgraph.Publisher] = {}
        self.durations: dict[InstanceParameter, list[sct.Duration]] = {}
        for (place, _), duration in trace.durations.items():
            self.durations.setdefault(place, []).append(duration)
        self.inputs: dict[tuple[PortInstance, PortEvent], list[tuple[InputSource, sct.Input]]] = {}
        for carried, declared in trace.inputs.items():
            self.inputs.setdefault((carried.port, carried.event), []).append((carried, declared))
        self.expressions = NodeExpressions(trace, self.declarations, self.variables, self.parameters, self.wire)

    def run(self) -> rosgraph.RosGraph:
        for parameter in self.instances.parameters:
            self.parameter(parameter)
        for instance in self.instances:
            for owned in instance.variables:
                if owned not in self.trace.variables:
                    self.variable(owned)
        for port in self.instances.ports():
            if isinstance(port.communication, robosc.Message):
                self.message(port)
            else:
                self.client_or_server(port)
        for instance in self.instances:
            self.reactions(instance)
        self.types_of_kept_data()
        return self.graph

    # Data that the node stores

    def variable(self, owned: InstanceVariable) -> None:
        variable = rosgraph.NodeVariable(
            name=owned.variable.name,
            component=owned.instance.name,
            type=self.node_type(owned.type),
            source=owned.variable.source,
        )
        if not is_structured(variable.type):
            variable.initial = self.declarations.initial(owned)
        self.variables[owned] = variable
        self.graph.variables.append(variable)

    def parameter(self, owned: InstanceParameter) -> None:
        declared, within = owned.parameter, owned.instance
        kind = declared.type if within is None else within.data_type(declared.type)
        parameter = rosgraph.Parameter(
            name=declared.name,
            component=within.name if within else None,
            description=declared.description,
            type=self.declarations.type(kind),
            initial=self.instances.expanded.constant(declared.value, within),
            source=declared.source,
        )
        for bound in ("lowest", "highest"):
            setattr(parameter, bound, constant_value(getattr(declared, bound), within))
        parameter.durations.extend(self.durations.get(owned, ()))
        self.parameters[owned] = parameter
        self.graph.parameters.append(parameter)

    # Communication

    def message(self, port: PortInstance) -> None:
        """Add a message. Messages of one topic and ROS type share one subscription or publisher."""
        (event,) = events(port.communication)
        topic, interface = port.instance.topic(port.communication), self.interface(port.communication)
        # A leading slash does not matter: both spellings are one topic, and its messages form one batch.
        key = topic.removeprefix("/"), interface
        where = port.communication.source
        if event.is_sent:
            if key not in self.publishers:
                self.publishers[key] = rosgraph.Publisher(topic=topic, interface=interface, source=where)
                self.graph.publishers.append(self.publishers[key])
            self.publishers[key].sendings.append(self.sending(port, event))
        else:
            if key not in self.subscriptions:
                self.subscriptions[key] = rosgraph.Subscription(topic=topic, interface=interface, source=where)
                self.graph.subscriptions.append(self.subscriptions[key])
            self.subscriptions[key].receptions.append(self.reception(port, event))

    def client_or_server(self, port: PortInstance) -> None:
        """Add a client or a server. Its features have the names of the events in the language, and `reset`."""
        kinds: dict[type[robosc.CommunicationType], tuple[str, _User]] = {
            robosc.Service: ("serviceClients", rosgraph.ServiceClient()),
            robosc.Action: ("actionClients", rosgraph.ActionClient()),
            robosc.OutgoingService: ("serviceServers", rosgraph.ServiceServer()),
            robosc.OutgoingAction: ("actionServers", rosgraph.ActionServer()),
        }
        feature, user = kinds[type(port.communication)]
        user.identifier = port.instance.topic(port.communication)
        user.interface = self.interface(port.communication)
        user.source = port.communication.source
        for event in self.instances.possible_events(port):
            handler: rosgraph.Sending | rosgraph.Reception | sct.Event = self.trace.event(port, event.kind)
            if event.is_sent:
                handler = self.sending(port, event)
            elif event.kind not in (*CONTROLLABLE, sct.EventKind.cancelRequest):
                handler = self.reception(port, event)
            setattr(user, event.name or event.kind.name, handler)
        getattr(self.graph, feature).append(user)

    def interface(self, communication: robosc.CommunicationType) -> rosgraph.Interface:
        """Return the ROS type that a communication links, or the type of `std_msgs` or `std_srvs` for basic data."""
        kind, linked = _KINDS[type(communication)], communication.interface
        named = ros_type(communication)
        assert named is not None
        package, name = named
        key = (package, name, kind.name)
        if key not in self.interfaces:
            interface = rosgraph.Interface(package=package, type=name, kind=kind)
            interface.source = linked.source if linked is not None else None
            self.interfaces[key] = interface
            self.graph.interfaces.append(interface)
        return self.interfaces[key]

    def sending(self, port: PortInstance, event: PortEvent) -> rosgraph.Sending:
        sending = rosgraph.Sending(
            name=port.communication.name,
            event=self.trace.event(port, event.kind),
            onChange=isinstance(port.communication, robosc.Message) and port.communication.onChange,
            source=port.communication.source,
        )
        sent = data_type(port.communication, event)
        assert sent is not None
        for statement in self.instances.provide_statements(port, event):
            provided = statement.element
            alternative = rosgraph.ProvidedData(location=self.trace.provided[statement], source=provided.source)
            is_object = isinstance(declared_type(port.instance.data_type(sent)), ObjectType)
            lone = () if is_object else (self.field(port, event),)
            translate = partial(self.expressions, within=statement.within)
            alternative.fields.extend(self.fields(provided.data, translate, lone, port.instance.data_type(sent)))
            sending.alternatives.append(alternative)
        if (port, event) in self.inputs:
            assert event.section is not None
            for assignment in self.input_assignments(port, event, self.value_of(port, event)):
                round_constants(assignment, self.interface(port.communication), event.section, self.known)
                sending.inputs.append(assignment)
        sending.limits.extend(self.limit(statement, port, event) for statement in self.instances.limits(port))
        return sending

    def limit(
        self, statement: Statement[robosc.LimitStatement], port: PortInstance, event: PortEvent
    ) -> rosgraph.DataLimit:
        value, written = self.value_of(port, event), statement.element
        translate = partial(self.expressions, within=statement.within, data=value)
        limit = rosgraph.DataLimit(
            condition=None if written.condition is None else translate(written.condition),
            fields=self.fields(written.data, translate, tuple(value.fields), port.instance.data_type(value.type)),
            source=written.source,
        )
        assert event.section is not None
        round_constants(limit, self.interface(port.communication), event.section, self.known)
        return limit

    def fields(
        self, data: ex.Expression, translate: _Translation, path: tuple[str, ...], declared: robosc.DataType
    ) -> list[rosgraph.FieldAssignment]:
        if isinstance(data, ex.Conditional) and isinstance(declared_type(declared), ArrayType | ObjectType):
            return [
                self.under(conditions, field, translate)
                for conditions, branch in branches(data)
                for field in self.fields(branch, translate, path, declared)
            ]
        if isinstance(data, robosc.ArrayLiteral):
            assert isinstance(declared, robosc.Array)
            values = [self.converted(element, translate, declared.type) for element in data.elements]
            array = rosgraph.ArrayLiteral(elements=values)
            kind = self.wire_type(declared)
            return [rosgraph.FieldAssignment(path=list(path), type=kind, value=array, source=data.source)]
        if isinstance(data, robosc.ObjectValue):
            return [
                field
                for assignment in data.properties
                for field in self.fields(
                    assignment.value, translate, (*path, assignment.property.name), assignment.property.type
                )
            ]
        return [
            rosgraph.FieldAssignment(
                path=list(path),
                type=self.node_type(declared),
                value=self.converted(data, translate, declared),
                source=data.source,
            )
        ]

    def under(
        self,
        conditions: Sequence[tuple[ex.Expression, bool]],
        field: rosgraph.FieldAssignment,
        translate: _Translation,
    ) -> rosgraph.FieldAssignment:
        """Let an assignment happen only if these conditions hold, or do not hold, in this order."""
        tests = [
            test if holds else ex.Negation(operand=test)
            for test, holds in ((translate(condition), holds) for condition, holds in conditions)
        ]
        field.condition = conjunction([*tests, *([field.condition] if field.condition is not None else [])])
        return field

    def converted(self, value: ex.Expression, translate: _Translation, declared: robosc.DataType) -> ex.Expression:
        expression = translate(value)
        return self.expressions.as_double(expression) if isinstance(declared, robosc.DoubleDataType) else expression

    # Incoming data

    def reception(self, port: PortInstance, event: PortEvent) -> rosgraph.Reception:
        reception = rosgraph.Reception(
            name=port.communication.name,
            event=self.trace.event(port, event.kind),
            source=port.communication.source,
        )
        value = None
        if event.section is not None:
            value = self.value_of(port, event)
            self.carriers[reception] = self.interface(port.communication), event.section
        reception.inputs.extend(self.input_assignments(port, event, value))
        return reception

    def input_assignments(
        self, port: PortInstance, event: PortEvent, value: ReceivedValue | None
    ) -> Iterator[rosgraph.InputAssignment]:
        """Return the assignments to the inputs of an event; `value` is the meaning of `value` in its data."""
        for carried, declared in self.inputs.get((port, event), ()):
            access: ex.Expression
            within: Instance | None = port.instance
            if isinstance(carried, Data):
                access = robosc.Access(
                    value=True, segments=[robosc.PropertySegment(property=part) for part in carried.path]
                )
            elif isinstance(carried, FailureReason):
                access = robosc.ErrorReason(enumeration=carried.enum)
            else:
                access = carried.expression
            if isinstance(carried, StateValue):
                within = carried.within
            yield rosgraph.InputAssignment(input=declared, value=self.expressions(access, within, value))

    def field(self, port: PortInstance, event: PortEvent) -> str:
        """Return the field of a basic value."""
        linked = port.communication.interface
        assert event.section is not None
        return _FIELD if linked is None else self.known.field_of_basic(linked.package, linked.type, event.section)

    def value_of(self, port: PortInstance, event: PortEvent) -> ReceivedValue:
        """Return the meaning of `value` in a ROS message with the data of an event."""
        carried = data_type(port.communication, event)
        assert carried is not None
        is_object = isinstance(basis(carried), robosc.ComplexDataTypeReference)
        return ReceivedValue(carried, port.instance, () if is_object else (self.field(port, event),))

    def wire(
        self,
        whole: robosc.DataType,
        within: Instance | None,
        fields: Sequence[str],
        access: robosc.Access,
        indices: Sequence[ex.Expression],
    ) -> tuple[ex.Expression, robosc.DataType]:
        """Translate an access to data of a type, below some fields, and return its type. Enums are converted."""
        steps, reached = _steps(access.segments, whole, iter(indices))
        steps[:0] = [rosgraph.FieldStep(name=name) for name in fields]
        enum = reached.type if isinstance(reached, robosc.ComplexDataTypeReference) else None
        if isinstance(enum, robosc.EnumDataType):
            argument = rosgraph.WireAccess(steps=steps, type=self.wire_type(enum.type))
            assert isinstance(reached, robosc.ComplexDataTypeReference)
            bound = bound_arguments(enum.parameters, reached.arguments)
            arguments = {name: self.argument(value, within) for name, value in bound.items()}
            call = rosgraph.ConversionCall(conversion=self.conversion(enum, arguments), argument=argument)
            return call, reached
        return rosgraph.WireAccess(steps=steps, type=self.wire_type(reached)), reached

    def argument(self, value: ex.Expression, within: Instance | None) -> ex.Expression:
        """Return an argument of an enum in a form that is valid outside of components."""
        access = set_on_robot(value)
        if access is None:
            return self.instances.expanded.constant(value, within)
        owned = self.instances.parameter(access, within)
        return robosc.Access(component=owned.instance.referent if owned.instance else None, item=owned.parameter)

    def node_type(self, kind: robosc.DataType) -> ex.Type:
        """Return the type of data that the node stores or sends."""
        if isinstance(declared_type(kind), ObjectType):
            return rosgraph.ObjectType()
        return self.wire_type(kind) or self.declarations.type(kind)

    def wire_type(self, kind: robosc.DataType) -> ex.Type | None:
        """Return the type of a basic value or an array. None for an object."""
        if isinstance(kind, robosc.Array):
            element = kind.type if isinstance(kind.type, robosc.BasicDataType) else None
            return rosgraph.ArrayType(element=self.declarations.type(element) if element else None)
        return self.declarations.type(kind) if isinstance(kind, robosc.BasicDataType) else None

    def conversion(
        self, enum: robosc.EnumDataType, arguments: Mapping[robosc.FormalParameter, ex.Expression]
    ) -> rosgraph.Conversion:
        """Return the conversion (listing 5.13) of an enum with some arguments."""
        key = (enum, tuple(map(RoboscPrinter(), arguments.values())))
        if key not in self.conversions:
            conversion = rosgraph.Conversion(
                name=self.conversion_names.fresh(enum.name),
                enumeration=self.declarations.enumeration(enum),
                default=self.declarations.literal(default_value(enum)),
                source=enum.source,
            )
            self.conversions[key] = conversion
            value = ReceivedValue(enum.type)
            for rule in enum.rules:
                if isinstance(rule, robosc.EnumTransformationRule):
                    condition = self.instances.expanded.expand_with(rule.condition, arguments)
                    conversion.rules.append(
                        rosgraph.ConversionRule(
                            condition=self.expressions(condition, None, value),
                            literal=self.declarations.literal(rule.value),
                            source=rule.source,
                        )
                    )
            self.graph.conversions.append(conversion)
        return self.conversions[key]

    # Reactions of the node to events

    def reactions(self, instance: Instance) -> None:
        tried: dict[tuple[sct.Event, robosc.State | None], list[robosc.Transition]] = {}
        for transition, state in instance.transitions:
            places, event = self.trace.behaviours[instance].locations, self.trace.event_of(transition, instance)
            before = tried.setdefault((event, state), [])
            reaction = rosgraph.Reaction(
                event=event,
                locations=list(places) if state is None else [self.trace.locations[instance, state]],
                guard=self.first(transition, before, instance),
                source=transition.source,
            )
            before.append(transition)
            data = self.data(transition, instance)
            for owned, assignment in self.instances.assignments(transition, instance).items():
                value = self.expressions(assignment.value, instance, data)
                if owned in self.variables:
                    variable = self.variables[owned]
                    if happens_anyway(event) and reads_elements(value):
                        # The assignment does not happen if its value cannot be read.
                        unchanged = rosgraph.NodeVariableReference(variable=variable)
                        value = rosgraph.IfReadable(value=value, otherwise=unchanged)
                    reaction.assignments.append(
                        rosgraph.NodeAssignment(variable=variable, value=value, source=assignment.source)
                    )
                elif reads_elements(value) and not happens_anyway(event):
                    reaction.needs.append(value)
            reads = reaction.guard is not None and reads_elements(reaction.guard)
            if reaction.assignments or reaction.needs or reads:
                self.graph.reactions.append(reaction)

    def first(
        self, transition: robosc.Transition, others: Sequence[robosc.Transition], instance: Instance
    ) -> ex.Expression | None:
        """Return the condition that a transition of an event is the first whose guard holds.

        None for a silent transition: the supervisor already requires this condition.
        """
        if not isinstance(transition, robosc.ResultTransition):
            return None
        data = self.data(transition, instance)
        earlier = [guard for guard in map(guard_of, [*others, transition]) if guard is not None]
        guards = [self.expressions(guard, instance, data) for guard in earlier]
        if happens_anyway(self.trace.event_of(transition, instance)):
            guards = [_false_if_missing(guard) for guard in guards]
        own = [] if transition.guard is None else [guards.pop()]
        return conjunction([*(ex.Negation(operand=guard) for guard in guards), *own])

    def types_of_kept_data(self) -> None:
        """Set the ROS types of objects and arrays of objects from the data that is stored in them."""
        declared = {variable: owned.type for owned, variable in self.variables.items()}
        for variable, places in origins(self.graph).items():
            if holds_objects(variable.type):
                variable.reception, path = next(iter(places))
                variable.path.extend(["0" if step == EACH or step.isdigit() else step for step in path])
                interface, section = self.carriers[variable.reception]
                variable.type = self.stored_types.type_of(declared[variable], interface, section, variable.path)

    def data(self, transition: robosc.Transition, instance: Instance) -> ReceivedValue | None:
        """Return the meaning of `value` in a transition. None if its event carries no data."""
        if not isinstance(transition, robosc.ResultTransition):
            return None
        port = self.instances.port(transition.communicationType, instance)
        event = event_of(transition.communicationType, transition.resultType)
        has_data = port is not None and event is not None and event.feature
        return self.value_of(port, event) if has_data else None  # type: ignore[arg-type]


def _false_if_missing(condition: ex.Expression) -> ex.Expression:
    """Make a condition false if an array element that it reads is missing."""
    if not reads_elements(condition):
        return condition
    return rosgraph.IfReadable(value=condition, otherwise=ex.BooleanLiteral(value=False))


def _steps(
    segments: Sequence[robosc.AccessSegment], whole: robosc.DataType, indices: Iterator[ex.Expression]
) -> tuple[list[rosgraph.WireStep], robosc.DataType]:
    """Return the steps of segments into ROS data, and the type of the data that they lead to."""
    steps: list[rosgraph.WireStep] = []
    reached = whole
    for segment in segments:
        if isinstance(segment, robosc.PropertySegment):
            steps.append(rosgraph.FieldStep(name=segment.property.name))
            reached = segment.property.type
        else:
            assert isinstance(segment, robosc.IndexSegment)
            assert isinstance(reached, robosc.Array)
            if segment.last is not None:
                steps.append(rosgraph.SliceStep(first=next(indices), last=next(indices)))
                continue
            position = None if segment.first is None else next(indices)
            steps.append(rosgraph.IndexStep(index=segment.index, position=position))
            reached = reached.type
    return steps, reached
