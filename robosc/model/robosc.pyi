"""Generated from metamodel/robosc.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression
from robosc.model.places import Place

class Base(expression.NamedElement):
    """What one .rscd file holds (thesis figure 4.2)."""
    file: str | None
    definitions: MutableSequence[Definition]
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Robot(Base):
    """A robot: components, data types, interfaces, requirements and provided data."""
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Library(Base):
    """Components, data types and interfaces to be used in robots."""
    def __init__(self, *, file: str | None = ..., definitions: Iterable[Definition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Definition(expression.Located):
    """Anything directly inside a robot or a library. Requirements and provide statements stand in robots only."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class AccessibleItem(expression.NamedElement):
    """What an expression can name: a component, a state, a variable, an enum value (thesis 4.2.4, the access model)."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Interface(Definition, expression.NamedElement):
    """A ROS message, service or action type of a package (thesis 4.2.5)."""
    type: str
    package: str
    def __init__(self, *, type: str | None = ..., package: str | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class NamedExpression(Definition, ComponentDefinition, expression.NamedElement):
    """A name for an expression, in a robot, a library or a component."""
    value: expression.Expression
    def __init__(self, *, value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Constant(NamedExpression, AccessibleItem):
    """A name for a value, usable wherever a literal is; its value is a constant expression."""
    type: DataType
    def __init__(self, *, type: DataType | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Parameter(NamedExpression, AccessibleItem):
    """A value that is set on the robot: a ROS parameter of the node. Its own value is the one that it has where none is set. What the supervisor evaluates does not read it."""
    type: DataType
    lowest: expression.Expression | None
    highest: expression.Expression | None
    description: str | None
    def __init__(self, *, type: DataType | None = ..., lowest: expression.Expression | None = ..., highest: expression.Expression | None = ..., description: str | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Condition(NamedExpression, AccessibleItem):
    """A name for a boolean expression over states and variables."""
    def __init__(self, *, value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Function(NamedExpression):
    """A name for an expression with parameters; it is written out where it is called."""
    parameters: MutableSequence[FormalParameter]
    type: DataType
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: DataType | None = ..., value: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class FormalParameter(AccessibleItem):
    """What a function, a component or an enum gets from whoever uses it."""
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
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: ComponentType | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class ComponentType(expression.Located):
    """How a component is defined."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class LocalComponent(ComponentType):
    """A component defined in this file."""
    definitions: MutableSequence[ComponentDefinition]
    def __init__(self, *, definitions: Iterable[ComponentDefinition] = ..., source: Place | None = ...) -> None: ...

class InstantiatedComponent(ComponentType):
    """A component made from a template of the same text."""
    definition: Component
    arguments: MutableSequence[Argument]
    def __init__(self, *, definition: Component | None = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class ImportedComponent(ComponentType):
    """An instance of a component of a library, with plants, variables and topics of its own."""
    library: Library
    definition: Component
    remappings: MutableSequence[TopicRemapping]
    arguments: MutableSequence[Argument]
    def __init__(self, *, library: Library | None = ..., definition: Component | None = ..., remappings: Iterable[TopicRemapping] = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class TopicRemapping(expression.Located):
    """Gives a communication of an imported component another topic."""
    communicationType: CommunicationType
    identifier: str | None
    computedIdentifier: expression.Expression | None
    def __init__(self, *, communicationType: CommunicationType | None = ..., identifier: str | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ComponentDefinition(expression.Located):
    """Anything directly inside a local component."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class ComponentBehaviour(ComponentDefinition):
    """The behaviour of a component."""
    automaton: Automaton
    def __init__(self, *, automaton: Automaton | None = ..., source: Place | None = ...) -> None: ...

class CommunicationType(ComponentDefinition, AccessibleItem):
    """A message, service or action of a component (thesis figure 4.9)."""
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
    """A request that is answered once."""
    requestType: DataType
    responseType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class Action(CommunicationType):
    """A longer task: goal, feedback, result, and it can be cancelled."""
    requestType: DataType
    responseType: DataType
    feedbackType: DataType
    def __init__(self, *, requestType: DataType | None = ..., responseType: DataType | None = ..., feedbackType: DataType | None = ..., identifier: str | None = ..., interface: Interface | None = ..., computedIdentifier: expression.Expression | None = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class MessageDirection:
    """incoming: the component receives it and the controller sends it; outgoing: the other way."""
    name: str
    incoming: ClassVar[MessageDirection]
    outgoing: ClassVar[MessageDirection]

class CommunicationReference(expression.Located):
    """Names a communication, with its component where the bare name would not do."""
    component: Component | None
    communicationType: CommunicationType
    def __init__(self, *, component: Component | None = ..., communicationType: CommunicationType | None = ..., source: Place | None = ...) -> None: ...

class CommunicationTypeSet(expression.Located):
    """One communication, or several in braces."""
    communicationTypes: MutableSequence[CommunicationReference]
    def __init__(self, *, communicationTypes: Iterable[CommunicationReference] = ..., source: Place | None = ...) -> None: ...

class Automaton(expression.Located):
    """States, variables and transitions (thesis figure 4.11)."""
    definitions: MutableSequence[AutomatonDefinition]
    def __init__(self, *, definitions: Iterable[AutomatonDefinition] = ..., source: Place | None = ...) -> None: ...

class AutomatonDefinition(expression.Located):
    """A variable, a state, or a transition that every state has."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class Variable(AutomatonDefinition, AccessibleItem):
    """Data that a component remembers."""
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
    """A transition that is taken only where its guard holds."""
    guard: expression.Expression | None
    def __init__(self, *, guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class ResultTransition(GuardedTransition):
    """Happens with communication."""
    resultType: ResultType
    communicationType: CommunicationReference
    def __init__(self, *, resultType: ResultType | None = ..., communicationType: CommunicationReference | None = ..., guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class ResultType:
    """The events of a communication that a component can react to (thesis table 5.1)."""
    name: str
    request: ClassVar[ResultType]
    response: ClassVar[ResultType]
    error: ClassVar[ResultType]
    feedback: ClassVar[ResultType]
    cancel: ClassVar[ResultType]
    canceled: ClassVar[ResultType]

class TauTransition(GuardedTransition):
    """Happens silently, as soon as its guard holds."""
    def __init__(self, *, guard: expression.Expression | None = ..., assignments: Iterable[Assignment] = ..., target: State | None = ..., source: Place | None = ...) -> None: ...

class TimedTransition(Transition):
    """Happens when a time is up: since its state was entered, or since the last of some messages."""
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
    """Gives a variable a value."""
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
    """Names an object or an enum."""
    type: ComplexDataType
    arguments: MutableSequence[Argument]
    def __init__(self, *, type: ComplexDataType | None = ..., arguments: Iterable[Argument] = ..., source: Place | None = ...) -> None: ...

class InterfaceTypeReference(ComplexDataTypeReference):
    """Names a ROS type in place of an object that the model would define. Linking makes the object, its `type`."""
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
    """Turns data into one of finitely many values."""
    parameters: MutableSequence[FormalParameter]
    type: DataType
    rules: MutableSequence[EnumRule]
    def __init__(self, *, parameters: Iterable[FormalParameter] = ..., type: DataType | None = ..., rules: Iterable[EnumRule] = ..., source: Place | None = ..., name: str | None = ...) -> None: ...

class EnumRule(expression.Located):
    """A rule of an enum."""
    value: EnumValue
    def __init__(self, *, value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumTransformationRule(EnumRule):
    """Gives its value where its condition holds."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumDefaultRule(EnumRule):
    """Gives its value where no other rule does."""
    def __init__(self, *, value: EnumValue | None = ..., source: Place | None = ...) -> None: ...

class EnumValue(AccessibleItem):
    """A value of an enum."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Access(expression.Expression):
    """Reads what a name stands for, or the data of the event (`value`)."""
    value: bool
    component: Component | None
    item: AccessibleItem | None
    segments: MutableSequence[AccessSegment]
    enumeration: EnumDataType | None
    def __init__(self, *, value: bool | None = ..., component: Component | None = ..., item: AccessibleItem | None = ..., segments: Iterable[AccessSegment] = ..., enumeration: EnumDataType | None = ..., source: Place | None = ...) -> None: ...

class ErrorReason(expression.Expression):
    """Why the service or action of an `error` has failed (`error`)."""
    enumeration: EnumDataType | None
    def __init__(self, *, enumeration: EnumDataType | None = ..., source: Place | None = ...) -> None: ...

class Call(expression.Expression):
    """The value of a function for some arguments."""
    function: Function
    arguments: MutableSequence[expression.Expression]
    def __init__(self, *, function: Function | None = ..., arguments: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class InstanceQuantifier(expression.Expression):
    """A condition on the instances of a template or of a library's component, or how many of them it holds of."""
    quantifier: Quantifier
    template: Component
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., template: Component | None = ..., body: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayQuantifier(expression.Expression):
    """A condition on the elements of an array, from left to right and no further than needed, or how many of them it holds of."""
    quantifier: Quantifier
    element: ArrayElement
    array: Access
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., element: ArrayElement | None = ..., array: Access | None = ..., body: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayElement(AccessibleItem):
    """The name of an element of an array in the condition on it."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class ArrayLiteral(expression.Expression):
    """An array in provided data."""
    elements: MutableSequence[expression.Expression]
    def __init__(self, *, elements: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Quantifier:
    """How a condition on several things is put together."""
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
    """What the supervised robot is to be like, enforced or proven."""
    name: str | None
    text: str | None
    def __init__(self, *, name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class Requirement(StatedDefinition):
    """What the supervised robot is to keep to (thesis figure 4.13)."""
    def __init__(self, *, name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class CommunicationRequirement(Requirement):
    """Restricts when communication may start."""
    target: CommunicationTypeSet
    condition: expression.Expression
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class StateInvariant(Requirement):
    """Restricts the states that the supervised robot may come to."""
    kind: InvariantKind
    condition: expression.Expression
    def __init__(self, *, kind: InvariantKind | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class InvariantKind:
    """never: the condition holds in no reachable state; always: it holds in each."""
    name: str
    never: ClassVar[InvariantKind]
    always: ClassVar[InvariantKind]

class OrderRequirement(Requirement):
    """Events happen only after another one."""
    target: EventSet
    each: bool
    anchor: EventReference
    def __init__(self, *, target: EventSet | None = ..., each: bool | None = ..., anchor: EventReference | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class CountRequirement(Requirement):
    """Events happen only so many times since another one, or since the start."""
    bound: expression.Expression
    target: EventSet
    anchor: EventReference
    def __init__(self, *, bound: expression.Expression | None = ..., target: EventSet | None = ..., anchor: EventReference | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class AutomatonRequirement(Requirement):
    """The events that the transitions of an automaton are on happen only where it has one for them."""
    states: MutableSequence[RequirementState]
    def __init__(self, *, states: Iterable[RequirementState] = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class RequirementState(AccessibleItem):
    """A state of a requirement automaton."""
    initial: bool
    marked: bool
    transitions: MutableSequence[RequirementTransition]
    def __init__(self, *, initial: bool | None = ..., marked: bool | None = ..., transitions: Iterable[RequirementTransition] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class RequirementTransition(expression.Located):
    """An event that may happen in a state of a requirement automaton."""
    event: EventReference
    guard: expression.Expression | None
    target: RequirementState | None
    def __init__(self, *, event: EventReference | None = ..., guard: expression.Expression | None = ..., target: RequirementState | None = ..., source: Place | None = ...) -> None: ...

class EventSet(expression.Located):
    """Events."""
    events: MutableSequence[EventReference]
    def __init__(self, *, events: Iterable[EventReference] = ..., source: Place | None = ...) -> None: ...

class EventReference(expression.Located):
    """An event of a communication."""
    communicationType: CommunicationReference
    def __init__(self, *, communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class NamedEvent(EventReference):
    """An event that is named as a transition names it."""
    resultType: ResultType
    def __init__(self, *, resultType: ResultType | None = ..., communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class ImpliedEvent(EventReference):
    """The request of a communication, or what an outgoing message brings."""
    def __init__(self, *, communicationType: CommunicationReference | None = ..., source: Place | None = ...) -> None: ...

class Property(StatedDefinition):
    """What verification is to prove of the supervised robot; it is not enforced."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class InvariantProperty(Property):
    """A condition on all states that the supervised robot comes to."""
    kind: InvariantKind
    def __init__(self, *, kind: InvariantKind | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class ReachabilityProperty(Property):
    """Where the supervised robot can get to."""
    premise: expression.Expression | None
    def __init__(self, *, premise: expression.Expression | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class NeedsRequirement(CommunicationRequirement):
    """The communication may start only where the condition holds."""
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class DisablesRequirement(CommunicationRequirement):
    """The communication may not start where the condition holds."""
    def __init__(self, *, target: CommunicationTypeSet | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class ProvideStatement(Definition, ComponentDefinition):
    """The data that is sent along (thesis figure 4.12)."""
    communicationType: CommunicationReference
    data: expression.Expression
    condition: expression.Expression | None
    def __init__(self, *, communicationType: CommunicationReference | None = ..., data: expression.Expression | None = ..., condition: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ObjectValue(expression.Expression):
    """A value for an object; properties left out keep their ROS default. Only as provided data."""
    properties: MutableSequence[ObjectPropertyValue]
    def __init__(self, *, properties: Iterable[ObjectPropertyValue] = ..., source: Place | None = ...) -> None: ...

class ObjectPropertyValue(expression.Located):
    """A value for one property."""
    property: ObjectProperty
    value: expression.Expression
    def __init__(self, *, property: ObjectProperty | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...
