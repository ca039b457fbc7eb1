"""Generated from metamodel/rosgraph.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression, sct
from robosc.model.places import Place

class RosGraph(expression.NamedElement):
    """The ROS node of one robot's controller with its connections."""
    model: sct.SupervisoryControlModel
    interfaces: MutableSequence[Interface]
    enumerations: MutableSequence[expression.Enumeration]
    conversions: MutableSequence[Conversion]
    variables: MutableSequence[NodeVariable]
    subscriptions: MutableSequence[Subscription]
    publishers: MutableSequence[Publisher]
    serviceClients: MutableSequence[ServiceClient]
    actionClients: MutableSequence[ActionClient]
    serviceServers: MutableSequence[ServiceServer]
    actionServers: MutableSequence[ActionServer]
    reactions: MutableSequence[Reaction]
    parameters: MutableSequence[Parameter]
    def __init__(self, *, model: sct.SupervisoryControlModel | None = ..., interfaces: Iterable[Interface] = ..., enumerations: Iterable[expression.Enumeration] = ..., conversions: Iterable[Conversion] = ..., variables: Iterable[NodeVariable] = ..., subscriptions: Iterable[Subscription] = ..., publishers: Iterable[Publisher] = ..., serviceClients: Iterable[ServiceClient] = ..., actionClients: Iterable[ActionClient] = ..., serviceServers: Iterable[ServiceServer] = ..., actionServers: Iterable[ActionServer] = ..., reactions: Iterable[Reaction] = ..., parameters: Iterable[Parameter] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Interface(expression.Located):
    """A ROS type."""
    package: str
    type: str
    kind: InterfaceKind
    def __init__(self, *, package: str | None = ..., type: str | None = ..., kind: InterfaceKind | None = ..., source: Place | None = ...) -> None: ...

class InterfaceKind:
    """The kinds of ROS types."""
    name: str
    message: ClassVar[InterfaceKind]
    service: ClassVar[InterfaceKind]
    action: ClassVar[InterfaceKind]

class NodeVariable(expression.NamedElement):
    """A variable of a component that the supervisor does not need."""
    component: str | None
    type: expression.Type
    initial: expression.Expression | None
    reception: Reception | None
    path: MutableSequence[str]
    def __init__(self, *, component: str | None = ..., type: expression.Type | None = ..., initial: expression.Expression | None = ..., reception: Reception | None = ..., path: Iterable[str] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Parameter(NodeVariable):
    """A value of the robot, as a ROS parameter. The initial value applies if the robot sets none. No assignment changes a parameter."""
    description: str | None
    lowest: float | None
    highest: float | None
    durations: MutableSequence[sct.Duration]
    def __init__(self, *, description: str | None = ..., lowest: float | None = ..., highest: float | None = ..., durations: Iterable[sct.Duration] = ..., component: str | None = ..., type: expression.Type | None = ..., initial: expression.Expression | None = ..., reception: Reception | None = ..., path: Iterable[str] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Conversion(expression.NamedElement):
    """A conversion of data to a literal of an enumeration. The first matching rule decides. A rule that reads past the end of an array does not match."""
    enumeration: expression.Enumeration
    rules: MutableSequence[ConversionRule]
    default: expression.EnumerationLiteral
    def __init__(self, *, enumeration: expression.Enumeration | None = ..., rules: Iterable[ConversionRule] = ..., default: expression.EnumerationLiteral | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class ConversionRule(expression.Located):
    """A rule of a conversion."""
    condition: expression.Expression
    literal: expression.EnumerationLiteral
    def __init__(self, *, condition: expression.Expression | None = ..., literal: expression.EnumerationLiteral | None = ..., source: Place | None = ...) -> None: ...

class Subscription(expression.Located):
    """A topic that the node receives. All receptions of one ROS message are one batch: the node sets inputs and performs events in this order, without other events between them."""
    topic: str
    interface: Interface
    receptions: MutableSequence[Reception]
    def __init__(self, *, topic: str | None = ..., interface: Interface | None = ..., receptions: Iterable[Reception] = ..., source: Place | None = ...) -> None: ...

class Reception(expression.NamedElement):
    """Data that arrives with an event. It has the name of the communication in the robot model."""
    event: sct.Event
    inputs: MutableSequence[InputAssignment]
    def __init__(self, *, event: sct.Event | None = ..., inputs: Iterable[InputAssignment] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class InputAssignment(expression.Located):
    """An assignment to an input before its event. An integer outside the input's range becomes the nearest bound. If the value reads past the end of an array and a transition on the event reads the input, the event does not happen."""
    input: sct.Input
    value: expression.Expression
    def __init__(self, *, input: sct.Input | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Publisher(expression.Located):
    """A topic that the node sends."""
    topic: str
    interface: Interface
    sendings: MutableSequence[Sending]
    def __init__(self, *, topic: str | None = ..., interface: Interface | None = ..., sendings: Iterable[Sending] = ..., source: Place | None = ...) -> None: ...

class Sending(expression.NamedElement):
    """Data that the node sends with an event. It has the name of the communication in the robot model."""
    event: sct.Event
    alternatives: MutableSequence[ProvidedData]
    inputs: MutableSequence[InputAssignment]
    onChange: bool | None
    limits: MutableSequence[DataLimit]
    def __init__(self, *, event: sct.Event | None = ..., alternatives: Iterable[ProvidedData] = ..., inputs: Iterable[InputAssignment] = ..., onChange: bool | None = ..., limits: Iterable[DataLimit] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class ProvidedData(expression.Located):
    """The data of one provide statement."""
    location: sct.Location
    fields: MutableSequence[FieldAssignment]
    def __init__(self, *, location: sct.Location | None = ..., fields: Iterable[FieldAssignment] = ..., source: Place | None = ...) -> None: ...

class DataLimit(expression.Located):
    """A change of data that the node is about to send. A wire access without variable and quantifier reads the data so far. A double that a limit reads and that is not finite withholds the event."""
    condition: expression.Expression | None
    fields: MutableSequence[FieldAssignment]
    def __init__(self, *, condition: expression.Expression | None = ..., fields: Iterable[FieldAssignment] = ..., source: Place | None = ...) -> None: ...

class FieldAssignment(expression.Located):
    """An assignment to a field of data that the node sends."""
    path: MutableSequence[str]
    type: expression.Type
    value: expression.Expression
    condition: expression.Expression | None
    def __init__(self, *, path: Iterable[str] = ..., type: expression.Type | None = ..., value: expression.Expression | None = ..., condition: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ServiceClient(expression.Located):
    """A service that the node calls."""
    identifier: str
    interface: Interface
    request: Sending
    response: Reception
    error: Reception
    reset: sct.Event
    def __init__(self, *, identifier: str | None = ..., interface: Interface | None = ..., request: Sending | None = ..., response: Reception | None = ..., error: Reception | None = ..., reset: sct.Event | None = ..., source: Place | None = ...) -> None: ...

class ActionClient(expression.Located):
    """An action that the node starts."""
    identifier: str
    interface: Interface
    request: Sending
    feedback: Reception
    response: Reception
    error: Reception
    cancel: sct.Event
    canceled: Reception
    reset: sct.Event
    def __init__(self, *, identifier: str | None = ..., interface: Interface | None = ..., request: Sending | None = ..., feedback: Reception | None = ..., response: Reception | None = ..., error: Reception | None = ..., cancel: sct.Event | None = ..., canceled: Reception | None = ..., reset: sct.Event | None = ..., source: Place | None = ...) -> None: ...

class ServiceServer(expression.Located):
    """A service that the node serves. The node takes one request at a time; the others wait."""
    identifier: str
    interface: Interface
    request: Reception
    response: Sending | None
    def __init__(self, *, identifier: str | None = ..., interface: Interface | None = ..., request: Reception | None = ..., response: Sending | None = ..., source: Place | None = ...) -> None: ...

class ActionServer(expression.Located):
    """An action that the node serves, with one goal at a time. An answer is absent if no transition names it: it never happens."""
    identifier: str
    interface: Interface
    request: Reception
    cancel: sct.Event | None
    feedback: Sending | None
    response: Sending | None
    error: Sending | None
    canceled: Sending | None
    def __init__(self, *, identifier: str | None = ..., interface: Interface | None = ..., request: Reception | None = ..., cancel: sct.Event | None = ..., feedback: Sending | None = ..., response: Sending | None = ..., error: Sending | None = ..., canceled: Sending | None = ..., source: Place | None = ...) -> None: ...

class Reaction(expression.Located):
    """The reads and changes of an event in the node if a component is in one of the locations and the guard holds. Values are those before the event."""
    event: sct.Event
    locations: MutableSequence[sct.Location]
    guard: expression.Expression | None
    needs: MutableSequence[expression.Expression]
    assignments: MutableSequence[NodeAssignment]
    def __init__(self, *, event: sct.Event | None = ..., locations: Iterable[sct.Location] = ..., guard: expression.Expression | None = ..., needs: Iterable[expression.Expression] = ..., assignments: Iterable[NodeAssignment] = ..., source: Place | None = ...) -> None: ...

class NodeAssignment(expression.Located):
    """An assignment to a variable of the node."""
    variable: NodeVariable
    value: expression.Expression
    def __init__(self, *, variable: NodeVariable | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class NodeVariableReference(expression.Expression):
    """The value of a variable of the node."""
    variable: NodeVariable
    single: bool | None
    def __init__(self, *, variable: NodeVariable | None = ..., single: bool | None = ..., source: Place | None = ...) -> None: ...

class WireAccess(expression.Expression):
    """The data of the current event, the argument of the conversion in its rules, or the data to be sent in a limit."""
    steps: MutableSequence[WireStep]
    type: expression.Type | None
    quantifier: ArrayQuantifier | None
    variable: NodeVariable | None
    def __init__(self, *, steps: Iterable[WireStep] = ..., type: expression.Type | None = ..., quantifier: ArrayQuantifier | None = ..., variable: NodeVariable | None = ..., source: Place | None = ...) -> None: ...

class WireStep(expression.Located):
    """One step into ROS data."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class FieldStep(WireStep):
    """A step to a field."""
    name: str
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class IndexStep(WireStep):
    """A step to an element of an array."""
    index: int | None
    position: expression.Expression | None
    def __init__(self, *, index: int | None = ..., position: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class SliceStep(WireStep):
    """The elements of an array from the first to the last index, both included. The slice is empty if the last index is less than the first."""
    first: expression.Expression
    last: expression.Expression
    def __init__(self, *, first: expression.Expression | None = ..., last: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ConversionCall(expression.Expression):
    """The literal that a conversion returns."""
    conversion: Conversion
    argument: WireAccess
    def __init__(self, *, conversion: Conversion | None = ..., argument: WireAccess | None = ..., source: Place | None = ...) -> None: ...

class ErrorReason(expression.Expression):
    """The reason for the failure of the service or action in an `error` event: the literal with the name of the node's reason."""
    enumeration: expression.Enumeration
    def __init__(self, *, enumeration: expression.Enumeration | None = ..., source: Place | None = ...) -> None: ...

class IfReadable(expression.Expression):
    """A value that reads elements of arrays, or an alternative if such an element is missing. It occurs in reactions to events that the node cannot refuse."""
    value: expression.Expression
    otherwise: expression.Expression
    def __init__(self, *, value: expression.Expression | None = ..., otherwise: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayQuantifier(expression.NamedElement, expression.Expression):
    """A condition on the elements of an array, or the number of elements that fulfill it. Evaluation is from left to right and stops at the first decisive element. Its name is that of an element."""
    quantifier: Quantifier
    array: WireAccess
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., array: WireAccess | None = ..., body: expression.Expression | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Quantifier:
    """The combination of a condition on several elements."""
    name: str
    all: ClassVar[Quantifier]
    any: ClassVar[Quantifier]
    count: ClassVar[Quantifier]

class ArrayLiteral(expression.Expression):
    """An array with its elements."""
    elements: MutableSequence[expression.Expression]
    def __init__(self, *, elements: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class ArrayType(expression.Type):
    """An array."""
    element: expression.Type | None
    def __init__(self, *, element: expression.Type | None = ..., source: Place | None = ...) -> None: ...

class ObjectType(expression.Type):
    """A ROS object."""
    fields: MutableSequence[ObjectField]
    def __init__(self, *, fields: Iterable[ObjectField] = ..., source: Place | None = ...) -> None: ...

class ObjectField(expression.NamedElement):
    """A field of an object, by its ROS name."""
    type: expression.Type
    def __init__(self, *, type: expression.Type | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...
