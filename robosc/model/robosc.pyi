"""Generated from metamodel/robosc.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression
from robosc.model.places import Place

class Base(expression.NamedElement):
    """The content of one .rscd file (thesis figure 4.2)."""
    file: str | None
    definitions: MutableSequence[Definition]
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Robot(Base):
    """A robot: components, data types, interfaces, requirements and provided data."""
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Library(Base):
    """Components, data types and interfaces for robots."""
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Definition(expression.Located):
    """An element directly inside a robot or a library. Only robots contain requirements, properties, provide statements and limits."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class AccessibleItem(expression.NamedElement):
    """An element that an expression can name: a component, a state, a variable, an enum value (thesis 4.2.4, the access model)."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Interface(Definition, expression.NamedElement):
    """A ROS message, service or action type of a package (thesis 4.2.5)."""
    type: str
    package: str
    def __init__(self, *, type: str | None = ..., package: str | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class NamedExpression(Definition, ComponentDefinition, expression.NamedElement):
    """A name for an expression in a robot, a library or a component."""
    value: expression.Expression
    def __init__(self, *, value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Constant(NamedExpression, AccessibleItem):
    """A name for a constant expression, usable in place of a literal."""
    type: DataType
    def __init__(self, *, type: DataType | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Parameter(NamedExpression, AccessibleItem):
    """A ROS parameter of the node. Its default applies if the robot sets no value. The supervisor does not read parameters."""
    type: DataType
    lowest: expression.Expression | None
    highest: expression.Expression | None
    description: str | None
    def __init__(self, *, type: DataType | None = ..., lowest: expression.Expression | None = ..., highest: expression.Expression | None = ..., description: str | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Condition(NamedExpression, AccessibleItem):
    """A name for a boolean expression over states and variables."""
    def __init__(self, *, value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Function(NamedExpression):
    """A name for an expression with parameters. Each call is replaced by the expression."""
    parameters: MutableSequence[FormalParameter]
    type: DataType
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: DataType | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class FormalParameter(AccessibleItem):
    """A parameter of a function, a component or an enum."""
    type: DataType
    default: expression.Expression | None
    def __init__(self, *, type: DataType | None = ..., default: expression.Expression | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Argument(expression.Located):
    """The value of a parameter of a component or an enum."""
    parameter: FormalParameter | None
    value: expression.Expression
    def __init__(self, *, parameter: FormalParameter | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Component(Definition, AccessibleItem):
    """A part of the robot (thesis figure 4.4)."""
    parameters: MutableSequence[FormalParameter]
    type: ComponentType
    first: expression.Expression | None
    last: expression.Expression | None
    number: FormalParameter | None
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: ComponentType | None = ..., first: expression.Expression | None = ..., last: expression.Expression | None = ..., number: FormalParameter | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class ComponentType(expression.Located):
    """The definition of a component."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class LocalComponent(ComponentType):
    """A component defined in this file."""
    definitions: MutableSequence[ComponentDefinition]
    def __init__(self, *, definitions: Iterable[ComponentDefinition] = ..., source: Place | None = ...) -> None: ...

class InstantiatedComponent(ComponentType):
    """An instance of a template in the same text."""
    definition: Component
    arguments: MutableSequence[Argument]
    def __init__(self, *, definition: Component | None = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class ImportedComponent(ComponentType):
    """An instance of a library's component with its own plants, variables and topics."""
    library: Library
    definition: Component
    remappings: MutableSequence[TopicRemapping]
    arguments: MutableSequence[Argument]
    def __init__(self, *, library: Library | None = ..., definition: Component | None = ..., remappings: Iterable[TopicRemapping] = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class TopicRemapping(expression.Located):
    """A different topic for a communication of an imported component."""
    communicationType: CommunicationType
    identifier: str | None
    computedIdentifier: expression.Expression | None
    def __init__(self, *, communicationType: CommunicationType | None = ..., identifier: str | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ComponentDefinition(expression.Located):
    """An element directly inside a local component."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class ComponentBehaviour(ComponentDefinition):
    """The behaviour of a component."""
    automaton: Automaton
    def __init__(self, *, automaton: Automaton | None = ..., source: Place | None = ...) -> None: ...

class CommunicationType(ComponentDefinition, AccessibleItem):
    """A message, service or action of a component (thesis figure 4.9), or one that the controller serves."""
    identifier: str | None
    interface: Interface | None
    computedIdentifier: expression.Expression | None
    def __init__(self, *, identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Message(CommunicationType):
    """A message on a topic."""
    direction: MessageDirection
    type: DataType
    onChange: bool | None
    def __init__(self, *, direction: MessageDirection | None = ..., type: DataType | None = ..., onChange: bool | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Service(CommunicationType):
    """A request with one response."""
    requestType: DataType
    responseType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Action(CommunicationType):
    """A longer task: goal, feedback, result. The controller can cancel it."""
    requestType: DataType
    responseType: DataType
    feedbackType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., feedbackType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class OutgoingService(CommunicationType):
    """A service that the controller serves: others call it, and the controller answers each request once."""
    requestType: DataType
    responseType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class OutgoingAction(CommunicationType):
    """An action that the controller serves: others send a goal, which the controller accepts or rejects. It sends feedback and a result. A client can ask to cancel the goal."""
    requestType: DataType
    responseType: DataType
    feedbackType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., feedbackType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class MessageDirection:
    """incoming: the controller sends the message and the component receives it; outgoing: the component sends it and the controller receives it."""
    name: str
    incoming: ClassVar[MessageDirection]
    outgoing: ClassVar[MessageDirection]

class CommunicationReference(expression.Located):
    """A name of a communication, with its component if the name alone is ambiguous."""
    component: Component | None
    communicationType: CommunicationType
    index: expression.Expression | None
    def __init__(self, *, component: Component | None = ..., communicationType: CommunicationType | None = ..., index: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class CommunicationTypeSet(expression.Located):
    """One communication, or several in braces."""
    communicationTypes: MutableSequence[CommunicationReference]
    def __init__(self, *, communicationTypes: Iterable[CommunicationReference] = ..., source: Place | None = ...) -> None: ...

class Automaton(expression.Located):
    """States, variables and transitions (thesis figure 4.11)."""
    definitions: MutableSequence[AutomatonDefinition]
    def __init__(self, *, definitions: Iterable[AutomatonDefinition] = ..., source: Place | None = ...) -> None: ...

class AutomatonDefinition(expression.Located):
    """A variable, a state, or a transition of every state."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class Variable(AutomatonDefinition, AccessibleItem):
    """Stored data of a component."""
    type: DataType
    initial: expression.Expression | None
    def __init__(self, *, type: DataType | None = ..., initial: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class State(AutomatonDefinition, AccessibleItem):
    """A state of a component."""
    initial: bool
    marked: bool
    transitions: MutableSequence[Transition]
    def __init__(self, *, initial: bool | None = ..., marked: bool | None = ..., transitions: Iterable[Transition] = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Transition(AutomatonDefinition):
    """A change of state, of variables, or of both."""
    assignments: MutableSequence[Assignment]
    target: State | None
    def __init__(self, *, assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class GuardedTransition(Transition):
    """A transition with a guard."""
    guard: expression.Expression | None
    def __init__(self, *, guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class ResultTransition(GuardedTransition):
    """A transition on an event of a communication."""
    resultType: ResultType
    communicationType: CommunicationReference
    def __init__(self, *, resultType: ResultType | None = ..., communicationType: CommunicationReference | None = ..., guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class ResultType:
    """The events of a communication on which a component can have transitions (thesis table 5.1)."""
    name: str
    request: ClassVar[ResultType]
    response: ClassVar[ResultType]
    error: ClassVar[ResultType]
    feedback: ClassVar[ResultType]
    cancel: ClassVar[ResultType]
    canceled: ClassVar[ResultType]

class TauTransition(GuardedTransition):
    """A silent transition, taken as soon as its guard holds."""
    def __init__(self, *, guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class TimedTransition(Transition):
    """A transition after a time since the entry of its state, or since the last of some messages."""
    duration: expression.Expression
    unit: TimeUnit
    without: MutableSequence[CommunicationReference]
    def __init__(self, *, duration: expression.Expression | None = ..., unit: TimeUnit | None = ..., without: Iterable[CommunicationReference] = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class TimeUnit:
    """ms: milliseconds; s: seconds; min: minutes."""
    name: str
    ms: ClassVar[TimeUnit]
    s: ClassVar[TimeUnit]
    min: ClassVar[TimeUnit]

class Assignment(expression.Located):
    """An assignment to a variable."""
    item: Access
    value: expression.Expression
    def __init__(self, *, item: Access | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class DataType(expression.Located):
    """The type of data (thesis figure 4.5)."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class BasicDataType(DataType):
    """A type that needs no definition."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class StringDataType(BasicDataType):
    """Text."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class IntegerDataType(BasicDataType):
    """A whole number."""
    minimum: int | None
    maximum: int | None
    lower: expression.Expression | None
    upper: expression.Expression | None
    def __init__(self, *, minimum: int | None = ..., maximum: int | None = ..., lower: expression.Expression | None = ..., upper: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class BooleanDataType(BasicDataType):
    """true or false."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class DoubleDataType(BasicDataType):
    """A number with a fraction."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class NoneDataType(BasicDataType):
    """No data."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class Array(DataType):
    """A list of values of one type, in data from the middleware only."""
    type: DataType
    def __init__(self, *, type: DataType | None = ..., source: Place | None = ...) -> None: ...

class ComplexDataTypeReference(DataType):
    """A reference to an object or an enum."""
    type: ComplexDataType
    arguments: MutableSequence[Argument]
    def __init__(self, *, type: ComplexDataType | None = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class InterfaceTypeReference(ComplexDataTypeReference):
    """A reference to a ROS type, instead of an object in the model. Linking creates the object, its `type`."""
    package: str
    rosType: str
    definition: ObjectDataType | None
    interface: Interface | None
    def __init__(self, *, package: str | None = ..., rosType: str | None = ..., definition: ObjectDataType | None = ..., interface: Interface | None = ..., type: ComplexDataType | None = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class ComplexDataType(Definition, expression.NamedElement):
    """A data type with a name."""
    def __init__(self, *, source: Place | None = ..., name: str | None = ...) -> None: ...

class ObjectDataType(ComplexDataType):
    """Properties, each with a type."""
    properties: MutableSequence[ObjectProperty]
    def __init__(self, *, properties: Iterable[ObjectProperty] = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class ObjectProperty(expression.NamedElement):
    """A property of an object."""
    type: DataType
    def __init__(self, *, type: DataType | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class EnumDataType(ComplexDataType):
    """A conversion of data to one of finitely many values."""
    parameters: MutableSequence[FormalParameter]
    type: DataType
    rules: MutableSequence[EnumRule]
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: DataType | None = ..., rules: Iterable[EnumRule] = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class EnumRule(expression.Located):
    """A rule of an enum."""
    value: EnumValue
    def __init__(self, *, value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumTransformationRule(EnumRule):
    """A rule with a condition."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumDefaultRule(EnumRule):
    """The rule for all other data."""
    def __init__(self, *, value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumValue(AccessibleItem):
    """A value of an enum."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Access(expression.Expression):
    """The value of a named element, or the data of the event (`value`)."""
    value: bool
    component: Component | None
    item: AccessibleItem | None
    segments: MutableSequence[AccessSegment]
    enumeration: EnumDataType | None
    index: expression.Expression | None
    def __init__(self, *, value: bool | None = ..., component: Component | None = ..., item: AccessibleItem | None = ..., segments: Iterable[AccessSegment] = ..., enumeration: EnumDataType | None = ..., index: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ErrorReason(expression.Expression):
    """The reason for the failure of the service or action in an `error` transition (`error`)."""
    enumeration: EnumDataType | None
    def __init__(self, *, enumeration: EnumDataType | None = ..., source: Place | None = ...) -> None: ...

class Call(expression.Expression):
    """A function with its arguments."""
    function: Function
    arguments: MutableSequence[expression.Expression]
    def __init__(self, *, function: Function | None = ..., arguments: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class IntegerText(expression.UnaryExpression):
    """The digits of a constant integer: `text(i)`, unless the model declares a function of this name."""
    def __init__(self, *, operand: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class InstanceQuantifier(expression.Expression):
    """A condition on the instances of a template or of a library's component, or the number of instances that fulfill it."""
    quantifier: Quantifier
    template: Component
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., template: Component | None = ..., body: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayQuantifier(expression.Expression):
    """A condition on the elements of an array, or the number of elements that fulfill it. Evaluation is from left to right and stops at the first decisive element."""
    quantifier: Quantifier
    element: ArrayElement
    array: Access
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., element: ArrayElement | None = ..., array: Access | None = ..., body: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayElement(AccessibleItem):
    """The name of an element in a condition on an array."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class ArrayLiteral(expression.Expression):
    """An array in provided data."""
    elements: MutableSequence[expression.Expression]
    def __init__(self, *, elements: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Quantifier:
    """The combination of a condition on several elements."""
    name: str
    all: ClassVar[Quantifier]
    any: ClassVar[Quantifier]
    count: ClassVar[Quantifier]

class AccessSegment(expression.Located):
    """One step into data."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class PropertySegment(AccessSegment):
    """A property of an object."""
    property: ObjectProperty
    def __init__(self, *, property: ObjectProperty | None = ..., source: Place | None = ...) -> None: ...

class IndexSegment(AccessSegment):
    """An element of an array, or a slice of it."""
    index: int | None
    first: expression.Expression | None
    last: expression.Expression | None
    def __init__(self, *, index: int | None = ..., first: expression.Expression | None = ..., last: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class StatedDefinition(Definition, ComponentDefinition):
    """A requirement, a property or an assumption: enforced, proven, or checked while the robot runs."""
    name: str | None
    text: str | None
    template: Component | None
    def __init__(self, *, name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class Requirement(StatedDefinition):
    """A requirement that the supervisor enforces (thesis figure 4.13)."""
    def __init__(self, *, name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class CommunicationRequirement(Requirement):
    """A restriction on the start of communication."""
    target: CommunicationTypeSet
    condition: expression.Expression
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class StateInvariant(Requirement):
    """A restriction on the reachable states of the supervised robot."""
    kind: InvariantKind
    condition: expression.Expression
    def __init__(self, *, kind: InvariantKind | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class InvariantKind:
    """never: the condition holds in no reachable state; always: the condition holds in every reachable state."""
    name: str
    never: ClassVar[InvariantKind]
    always: ClassVar[InvariantKind]

class ReachabilityRequirement(Requirement):
    """The supervised robot can always reach a state with the condition."""
    condition: expression.Expression
    premise: expression.Expression | None
    def __init__(self, *, condition: expression.Expression | None = ..., premise: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class OrderRequirement(Requirement):
    """A restriction of events to after another event."""
    target: EventSet
    each: bool
    anchor: EventReference
    def __init__(self, *, target: EventSet | None = ..., each: bool | None = ..., anchor: EventReference | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class CountRequirement(Requirement):
    """A bound on the number of events since another event, or since the start."""
    bound: expression.Expression
    target: EventSet
    anchor: EventReference
    def __init__(self, *, bound: expression.Expression | None = ..., target: EventSet | None = ..., anchor: EventReference | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class AutomatonRequirement(Requirement):
    """A restriction of events by an automaton. Each event on its transitions happens only if the automaton has a transition for it."""
    states: MutableSequence[RequirementState]
    def __init__(self, *, states: Iterable[RequirementState] = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class RequirementState(AccessibleItem):
    """A state of a requirement automaton."""
    initial: bool
    marked: bool
    transitions: MutableSequence[RequirementTransition]
    def __init__(self, *, initial: bool | None = ..., marked: bool | None = ..., transitions: Iterable[RequirementTransition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class RequirementTransition(expression.Located):
    """An event that a state of a requirement automaton permits."""
    event: EventReference
    guard: expression.Expression | None
    target: RequirementState | None
    def __init__(self, *, event: EventReference | None = ..., guard: expression.Expression | None = ..., target: RequirementState | None = ..., source: Place | None = ...) -> None: ...

class EventSet(expression.Located):
    """A set of events."""
    events: MutableSequence[EventReference]
    def __init__(self, *, events: Iterable[EventReference] = ..., source: Place | None = ...) -> None: ...

class EventReference(expression.Located):
    """An event of a communication."""
    communicationType: CommunicationReference
    def __init__(self, *, communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class NamedEvent(EventReference):
    """An event with the keyword of a transition."""
    resultType: ResultType
    def __init__(self, *, resultType: ResultType | None = ..., communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class ImpliedEvent(EventReference):
    """The request of a communication, or the arrival of an outgoing message."""
    def __init__(self, *, communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class Property(StatedDefinition):
    """A claim about the supervised robot that verification proves. The supervisor does not enforce it."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class InvariantProperty(Property):
    """A condition on all reachable states of the supervised robot."""
    kind: InvariantKind
    def __init__(self, *, kind: InvariantKind | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class ReachabilityProperty(Property):
    """A claim that the supervised robot can reach a state with the condition."""
    premise: expression.Expression | None
    def __init__(self, *, premise: expression.Expression | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class NeedsRequirement(CommunicationRequirement):
    """The communication may start only if the condition holds."""
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class DisablesRequirement(CommunicationRequirement):
    """The communication may not start if the condition holds."""
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class Assumption(StatedDefinition):
    """A condition that the robot keeps by itself: its events come only while the condition holds. The node checks it."""
    target: EventSet
    condition: expression.Expression
    def __init__(self, *, target: EventSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., template: Component | None = ..., source: Place | None = ...) -> None: ...

class DataStatement(Definition, ComponentDefinition):
    """A statement on the data of a command: a provide statement or a limit."""
    communicationType: CommunicationReference
    data: expression.Expression
    condition: expression.Expression | None
    def __init__(self, *, communicationType: CommunicationReference | None = ..., data: expression.Expression | None = ..., condition: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ProvideStatement(DataStatement):
    """The data of a command (thesis figure 4.12), or of an answer of the controller. The first statement, in the order of the text, with a true condition applies."""
    feedback: bool | None
    def __init__(self, *, feedback: bool | None = ..., communicationType: CommunicationReference | None = ..., data: expression.Expression | None = ..., condition: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class LimitStatement(DataStatement):
    """A change of the data of an incoming message, after `provide`. `value` is the data so far. All statements with a true condition apply: first those in components, then those outside, in the order of the text."""
    def __init__(self, *, communicationType: CommunicationReference | None = ..., data: expression.Expression | None = ..., condition: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ObjectValue(expression.Expression):
    """A value for an object in provided data or in a limit. Omitted properties have their ROS default, or stay in a limit."""
    properties: MutableSequence[ObjectPropertyValue]
    def __init__(self, *, properties: Iterable[ObjectPropertyValue] = ..., source: Place | None = ...) -> None: ...

class ObjectPropertyValue(expression.Located):
    """A value for one property."""
    property: ObjectProperty
    value: expression.Expression
    def __init__(self, *, property: ObjectProperty | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...
