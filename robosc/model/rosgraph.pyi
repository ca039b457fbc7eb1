"""Generated from metamodel/rosgraph.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression, sct
from robosc.model.places import Place

class RosGraph(expression.NamedElement):
    """The node of one robot's controller and everything it is connected to."""
    model: sct.SupervisoryControlModel
    interfaces: MutableSequence[Interface]
    enumerations: MutableSequence[expression.Enumeration]
    conversions: MutableSequence[Conversion]
    variables: MutableSequence[NodeVariable]
    subscriptions: MutableSequence[Subscription]
    publishers: MutableSequence[Publisher]
    serviceClients: MutableSequence[ServiceClient]
    actionClients: MutableSequence[ActionClient]
    reactions: MutableSequence[Reaction]
    parameters: MutableSequence[Parameter]
    def __init__(self, *, model: sct.SupervisoryControlModel | None = ..., interfaces: Iterable[Interface] = ..., enumerations: Iterable[expression.Enumeration] = ..., conversions: Iterable[Conversion] = ..., variables: Iterable[NodeVariable] = ..., subscriptions: Iterable[Subscription] = ..., publishers: Iterable[Publisher] = ..., serviceClients: Iterable[ServiceClient] = ..., actionClients: Iterable[ActionClient] = ..., reactions: Iterable[Reaction] = ..., parameters: Iterable[Parameter] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

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
    """A value that is set on the robot, as a ROS parameter; its first value is the one that it has where none is set. Nothing is assigned to it."""
    description: str | None
    lowest: float | None
    highest: float | None
    durations: MutableSequence[sct.Duration]
    def __init__(self, *, description: str | None = ..., lowest: float | None = ..., highest: float | None = ..., durations: Iterable[sct.Duration] = ..., component: str | None = ..., type: expression.Type | None = ..., initial: expression.Expression | None = ..., reception: Reception | None = ..., path: Iterable[str] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Conversion(expression.NamedElement):
    """Turns data into a literal of an enumeration; the first rule that matches decides. A rule that reads past the end of an array does not match."""
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
    """A topic that the node listens to. All receptions of one ROS message are one batch: inputs are set and events performed in this order with nothing in between."""
    topic: str
    interface: Interface
    receptions: MutableSequence[Reception]
    def __init__(self, *, topic: str | None = ..., interface: Interface | None = ..., receptions: Iterable[Reception] = ..., source: Place | None = ...) -> None: ...

class Reception(expression.NamedElement):
    """Data that comes in with an event; its name is the communication's in the robot model."""
    event: sct.Event
    inputs: MutableSequence[InputAssignment]
    def __init__(self, *, event: sct.Event | None = ..., inputs: Iterable[InputAssignment] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class InputAssignment(expression.Located):
    """Sets an input before its event happens. An integer outside the input's range becomes the nearest bound. Where it reads past the end of an array and a transition that the event takes reads the input, the event does not happen."""
    input: sct.Input
    value: expression.Expression
    def __init__(self, *, input: sct.Input | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Publisher(expression.Located):
    """A topic that the node sends to."""
    topic: str
    interface: Interface
    sendings: MutableSequence[Sending]
    def __init__(self, *, topic: str | None = ..., interface: Interface | None = ..., sendings: Iterable[Sending] = ..., source: Place | None = ...) -> None: ...

class Sending(expression.NamedElement):
    """Data that goes out with an event; its name is the communication's in the robot model."""
    event: sct.Event
    alternatives: MutableSequence[ProvidedData]
    onChange: bool | None
    def __init__(self, *, event: sct.Event | None = ..., alternatives: Iterable[ProvidedData] = ..., onChange: bool | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class ProvidedData(expression.Located):
    """The data of one provide statement."""
    location: sct.Location
    fields: MutableSequence[FieldAssignment]
    def __init__(self, *, location: sct.Location | None = ..., fields: Iterable[FieldAssignment] = ..., source: Place | None = ...) -> None: ...

class FieldAssignment(expression.Located):
    """Sets a field of data that goes out."""
    path: MutableSequence[str]
    type: expression.Type
    value: expression.Expression
    def __init__(self, *, path: Iterable[str] = ..., type: expression.Type | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

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

class Reaction(expression.Located):
    """What an event reads and changes in the node, when a component is in one of the locations and the guard holds. Values are read as they were before the event."""
    event: sct.Event
    locations: MutableSequence[sct.Location]
    guard: expression.Expression | None
    needs: MutableSequence[expression.Expression]
    assignments: MutableSequence[NodeAssignment]
    def __init__(self, *, event: sct.Event | None = ..., locations: Iterable[sct.Location] = ..., guard: expression.Expression | None = ..., needs: Iterable[expression.Expression] = ..., assignments: Iterable[NodeAssignment] = ..., source: Place | None = ...) -> None: ...

class NodeAssignment(expression.Located):
    """Gives a variable of the node a value."""
    variable: NodeVariable
    value: expression.Expression
    def __init__(self, *, variable: NodeVariable | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class NodeVariableReference(expression.Expression):
    """The value of a variable of the node."""
    variable: NodeVariable
    def __init__(self, *, variable: NodeVariable | None = ..., source: Place | None = ...) -> None: ...

class WireAccess(expression.Expression):
    """Reads the data that came in with the event at hand, or, in a conversion's rule, the conversion's argument."""
    steps: MutableSequence[WireStep]
    type: expression.Type | None
    quantifier: ArrayQuantifier | None
    variable: NodeVariable | None
    def __init__(self, *, steps: Iterable[WireStep] = ..., type: expression.Type | None = ..., quantifier: ArrayQuantifier | None = ..., variable: NodeVariable | None = ..., source: Place | None = ...) -> None: ...

class WireStep(expression.Located):
    """One step into ROS data."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class FieldStep(WireStep):
    """A field."""
    name: str
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class IndexStep(WireStep):
    """An element of an array."""
    index: int | None
    position: expression.Expression | None
    def __init__(self, *, index: int | None = ..., position: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class SliceStep(WireStep):
    """The elements of an array from one to another, both included; none where the last one is before the first."""
    first: expression.Expression
    last: expression.Expression
    def __init__(self, *, first: expression.Expression | None = ..., last: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ConversionCall(expression.Expression):
    """The literal that a conversion gives."""
    conversion: Conversion
    argument: WireAccess
    def __init__(self, *, conversion: Conversion | None = ..., argument: WireAccess | None = ..., source: Place | None = ...) -> None: ...

class ErrorReason(expression.Expression):
    """Why the service or action of an `error` has failed: the literal that is called like the node's reason."""
    enumeration: expression.Enumeration
    def __init__(self, *, enumeration: expression.Enumeration | None = ..., source: Place | None = ...) -> None: ...

class IfReadable(expression.Expression):
    """A value that reads elements of arrays; another one where such an element is missing. It stands in reactions to events that happen in any case."""
    value: expression.Expression
    otherwise: expression.Expression
    def __init__(self, *, value: expression.Expression | None = ..., otherwise: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class ArrayQuantifier(expression.NamedElement, expression.Expression):
    """A condition on the elements of an array, from left to right and no further than needed, or how many of them it holds of. Its name is that of an element."""
    quantifier: Quantifier
    array: WireAccess
    body: expression.Expression
    def __init__(self, *, quantifier: Quantifier | None = ..., array: WireAccess | None = ..., body: expression.Expression | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Quantifier:
    """How a condition on several things is put together."""
    name: str
    all: ClassVar[Quantifier]
    any: ClassVar[Quantifier]
    count: ClassVar[Quantifier]

class ArrayLiteral(expression.Expression):
    """An array of these elements."""
    elements: MutableSequence[expression.Expression]
    def __init__(self, *, elements: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class ArrayType(expression.Type):
    """An array."""
    element: expression.Type | None
    def __init__(self, *, element: expression.Type | None = ..., source: Place | None = ...) -> None: ...

class ObjectType(expression.Type):
    """An object, as ROS has it."""
    fields: MutableSequence[ObjectField]
    def __init__(self, *, fields: Iterable[ObjectField] = ..., source: Place | None = ...) -> None: ...

class ObjectField(expression.NamedElement):
    """A field of an object, by its ROS name."""
    type: expression.Type
    def __init__(self, *, type: expression.Type | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...
