"""Generated from metamodel/sct.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression
from robosc.model.places import Place

class SupervisoryControlModel(expression.NamedElement):
    """The plants, requirements and supervisor of one robot."""
    enumerations: MutableSequence[expression.Enumeration]
    plants: MutableSequence[Plant]
    requirements: MutableSequence[Requirement]
    invariants: MutableSequence[StateInvariant]
    reachabilityRequirements: MutableSequence[ReachabilityRequirement]
    properties: MutableSequence[Property]
    supervisor: Supervisor | None
    durations: MutableSequence[Duration]
    initialPredicates: MutableSequence[expression.Expression]
    markerPredicates: MutableSequence[expression.Expression]
    supervised: bool | None
    def __init__(self, *, enumerations: Iterable[expression.Enumeration] = ..., plants: Iterable[Plant] = ..., requirements: Iterable[Requirement] = ..., invariants: Iterable[StateInvariant] = ..., reachabilityRequirements: Iterable[ReachabilityRequirement] = ..., properties: Iterable[Property] = ..., supervisor: Supervisor | None = ..., durations: Iterable[Duration] = ..., initialPredicates: Iterable[expression.Expression] = ..., markerPredicates: Iterable[expression.Expression] = ..., supervised: bool | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Plant(expression.NamedElement):
    """An automaton with variables. The guards of a location's edges with one event exclude each other. The guards of an uncontrollable event from CIF may overlap; then each enabled edge is possible."""
    kind: PlantKind
    origin: str | None
    reference: str | None
    text: str | None
    topic: str | None
    events: MutableSequence[Event]
    inputs: MutableSequence[Input]
    variables: MutableSequence[DiscreteVariable]
    locations: MutableSequence[Location]
    edges: MutableSequence[Edge]
    def __init__(self, *, kind: PlantKind | None = ..., origin: str | None = ..., reference: str | None = ..., text: str | None = ..., topic: str | None = ..., events: Iterable[Event] = ..., inputs: Iterable[Input] = ..., variables: Iterable[DiscreteVariable] = ..., locations: Iterable[Location] = ..., edges: Iterable[Edge] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class PlantKind:
    """message, service, action: communication (thesis listings 5.1 to 5.3); serviceServer, actionServer: a service or an action that the controller serves; behaviour: a component's automaton; data: the provide statements of one communication (listing 5.4); requirement: an automaton that observes events and never blocks one. The restrictions of a requirement automaton are requirements on its locations. The state count of the plants does not include its locations. assumption: a plant with one location that permits events from the robot only where a condition holds; the node checks it."""
    name: str
    message: ClassVar[PlantKind]
    service: ClassVar[PlantKind]
    action: ClassVar[PlantKind]
    behaviour: ClassVar[PlantKind]
    data: ClassVar[PlantKind]
    requirement: ClassVar[PlantKind]
    assumption: ClassVar[PlantKind]
    serviceServer: ClassVar[PlantKind]
    actionServer: ClassVar[PlantKind]

class Event(expression.NamedElement):
    """An event of all plants that have it in their alphabets, simultaneous in all of them."""
    controllable: bool
    kind: EventKind
    inputs: MutableSequence[Input]
    timer: Timer | None
    def __init__(self, *, controllable: bool | None = ..., kind: EventKind | None = ..., inputs: Iterable[Input] = ..., timer: Timer | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class EventKind:
    """trigger, cancel: sent by the controller; response, error, feedback, canceled: caused by the robot; reset, tau: silent; data: selection of the provided data; timeout: expiry of a timer; plain: an event of a model from CIF without a communication; input: a change of a CIF input variable by the environment; request, cancelRequest: caused by a client of a service or an action that the controller serves; reply, replyFeedback, replyError, replyCanceled: the answers of the controller to that client."""
    name: str
    trigger: ClassVar[EventKind]
    response: ClassVar[EventKind]
    error: ClassVar[EventKind]
    feedback: ClassVar[EventKind]
    cancel: ClassVar[EventKind]
    reset: ClassVar[EventKind]
    tau: ClassVar[EventKind]
    data: ClassVar[EventKind]
    timeout: ClassVar[EventKind]
    plain: ClassVar[EventKind]
    input: ClassVar[EventKind]
    canceled: ClassVar[EventKind]
    request: ClassVar[EventKind]
    cancelRequest: ClassVar[EventKind]
    reply: ClassVar[EventKind]
    replyFeedback: ClassVar[EventKind]
    replyError: ClassVar[EventKind]
    replyCanceled: ClassVar[EventKind]

class Timer(expression.Located):
    """A timer that runs while a component is in a location, or always, with the events that restart it. On expiry, its event happens once. For synthesis, the event is possible at any time."""
    milliseconds: int | None
    duration: Duration | None
    location: Location | None
    entries: MutableSequence[Edge]
    without: MutableSequence[Event]
    def __init__(self, *, milliseconds: int | None = ..., duration: Duration | None = ..., location: Location | None = ..., entries: Iterable[Edge] = ..., without: Iterable[Event] = ..., source: Place | None = ...) -> None: ...

class Duration(expression.Located):
    """The time to expiry of timers, from a parameter of the robot. Synthesis does not use it. A running timer keeps the value from its start."""
    parameter: str
    milliseconds: int
    shortest: int
    longest: int
    unit: int
    def __init__(self, *, parameter: str | None = ..., milliseconds: int | None = ..., shortest: int | None = ..., longest: int | None = ..., unit: int | None = ..., source: Place | None = ...) -> None: ...

class Input(expression.NamedElement):
    """Data of an event. Only guards and updates of edges read it, and only on events that name the input."""
    type: expression.Type
    text: str | None
    def __init__(self, *, type: expression.Type | None = ..., text: str | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class DiscreteVariable(expression.NamedElement):
    """A variable of a plant."""
    type: expression.Type
    initial: expression.Expression | None
    def __init__(self, *, type: expression.Type | None = ..., initial: expression.Expression | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Location(expression.NamedElement):
    """A location of a plant."""
    initial: bool
    marked: bool
    edges: MutableSequence[Edge]
    def __init__(self, *, initial: bool | None = ..., marked: bool | None = ..., edges: Iterable[Edge] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Edge(expression.Located):
    """A possible step of one plant."""
    event: Event
    guard: expression.Expression | None
    updates: MutableSequence[Update]
    target: Location
    def __init__(self, *, event: Event | None = ..., guard: expression.Expression | None = ..., updates: Iterable[Update] = ..., target: Location | None = ..., source: Place | None = ...) -> None: ...

class Update(expression.Located):
    """An assignment to a variable. A value outside the range of an integer variable becomes the nearest bound."""
    variable: DiscreteVariable
    value: expression.Expression
    def __init__(self, *, variable: DiscreteVariable | None = ..., value: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class StatedRequirement(expression.Located):
    """A requirement or a property as in the robot model."""
    name: str | None
    text: str | None
    def __init__(self, *, name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class Requirement(StatedRequirement):
    """A restriction of a controllable event. Requirement automata and models from CIF may also restrict an uncontrollable event. Synthesis then avoids the states in which the event is forbidden."""
    event: Event
    kind: RequirementKind
    condition: expression.Expression
    automaton: Plant | None
    ranges: MutableSequence[DiscreteVariable]
    def __init__(self, *, event: Event | None = ..., kind: RequirementKind | None = ..., condition: expression.Expression | None = ..., automaton: Plant | None = ..., ranges: Iterable[DiscreteVariable] = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class RequirementKind:
    """needs: the event happens only if the condition holds; disables: the event happens only if the condition does not hold."""
    name: str
    needs: ClassVar[RequirementKind]
    disables: ClassVar[RequirementKind]

class StateInvariant(StatedRequirement):
    """A condition on every reachable state under the supervisor."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class ReachabilityRequirement(StatedRequirement):
    """From each reachable state with the premise, the supervised system can reach a state with the condition, by a path whose states satisfy `pathCondition`, in at most `bound` events. Some values of the inputs suffice."""
    condition: expression.Expression
    premise: expression.Expression | None
    pathCondition: expression.Expression | None
    bound: int | None
    def __init__(self, *, condition: expression.Expression | None = ..., premise: expression.Expression | None = ..., pathCondition: expression.Expression | None = ..., bound: int | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class Property(StatedRequirement):
    """A claim about the supervised system that verification proves. Synthesis does not enforce it."""
    condition: expression.Expression
    def __init__(self, *, condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class InvariantProperty(Property):
    """The condition holds in every reachable state."""
    def __init__(self, *, condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class ReachabilityProperty(Property):
    """A claim that the system can reach a state with the condition."""
    premise: expression.Expression | None
    def __init__(self, *, premise: expression.Expression | None = ..., condition: expression.Expression | None = ..., name: str | None = ..., text: str | None = ..., source: Place | None = ...) -> None: ...

class Supervisor(expression.Located):
    """The maximally permissive, controllable, non-blocking supervisor."""
    uncontrolledStates: int | None
    controlledStates: int
    bddNodes: int
    settlingBound: int | None
    guards: MutableSequence[EventGuard]
    initial: expression.Expression | None
    def __init__(self, *, uncontrolledStates: int | None = ..., controlledStates: int | None = ..., bddNodes: int | None = ..., settlingBound: int | None = ..., guards: Iterable[EventGuard] = ..., initial: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class EventGuard(expression.Located):
    """The guard that the supervisor adds to an event: both parts must hold. It does not repeat the restrictions of the plants."""
    event: Event
    requirement: expression.Expression | None
    requirements: MutableSequence[Requirement]
    synthesis: expression.Expression | None
    someRequired: expression.Expression | None
    someData: expression.Expression | None
    explanation: str | None
    everEnabled: bool
    def __init__(self, *, event: Event | None = ..., requirement: expression.Expression | None = ..., requirements: Iterable[Requirement] = ..., synthesis: expression.Expression | None = ..., someRequired: expression.Expression | None = ..., someData: expression.Expression | None = ..., explanation: str | None = ..., everEnabled: bool | None = ..., source: Place | None = ...) -> None: ...

class LocationReference(expression.Expression):
    """A boolean: true while the plant is in the location."""
    location: Location
    def __init__(self, *, location: Location | None = ..., source: Place | None = ...) -> None: ...

class VariableReference(expression.Expression):
    """The value of a variable."""
    variable: DiscreteVariable
    def __init__(self, *, variable: DiscreteVariable | None = ..., source: Place | None = ...) -> None: ...

class InputReference(expression.Expression):
    """The value of an input."""
    input: Input
    def __init__(self, *, input: Input | None = ..., source: Place | None = ...) -> None: ...

class Quotient(expression.BinaryExpression):
    """The integer quotient of the left operand, which is never negative, by the right operand, a positive constant. Only models from CIF contain it."""
    def __init__(self, *, left: expression.Expression | None = ..., right: expression.Expression | None = ..., source: Place | None = ...) -> None: ...
