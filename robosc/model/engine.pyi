"""Generated from metamodel/engine.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression, sct
from robosc.model.places import Place

class EngineModel(expression.NamedElement):
    """The controller of one robot."""
    model: sct.SupervisoryControlModel
    variables: MutableSequence[StateVariable]
    inputs: MutableSequence[Input]
    sources: MutableSequence[Source]
    groups: MutableSequence[Group]
    conditions: MutableSequence[Condition]
    events: MutableSequence[Event]
    choices: MutableSequence[Choice]
    settlingBound: int
    incremental: bool
    timers: MutableSequence[Timer]
    def __init__(self, *, model: sct.SupervisoryControlModel | None = ..., variables: Iterable[StateVariable] = ..., inputs: Iterable[Input] = ..., sources: Iterable[Source] = ..., groups: Iterable[Group] = ..., conditions: Iterable[Condition] = ..., events: Iterable[Event] = ..., choices: Iterable[Choice] = ..., settlingBound: int | None = ..., incremental: bool | None = ..., timers: Iterable[Timer] = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class Storage:
    """An integer type of a machine."""
    bits: int
    signed: bool
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, bits: int | None = ..., signed: bool | None = ...) -> None: ...

class Declaration(Storage):
    """A variable or an input. In memory all values are integers: false is 0, true is 1. Locations and literals are their positions, from 0."""
    name: str
    type: expression.Type
    minimum: int
    maximum: int
    initial: int
    def __init__(self, *, name: str | None = ..., type: expression.Type | None = ..., minimum: int | None = ..., maximum: int | None = ..., initial: int | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...

class StateVariable(Declaration):
    """A part of the state."""
    plant: sct.Plant
    variable: sct.DiscreteVariable | None
    def __init__(self, *, plant: sct.Plant | None = ..., variable: sct.DiscreteVariable | None = ..., name: str | None = ..., type: expression.Type | None = ..., minimum: int | None = ..., maximum: int | None = ..., initial: int | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...

class Input(Declaration):
    """Data of an event."""
    input: sct.Input
    def __init__(self, *, input: sct.Input | None = ..., name: str | None = ..., type: expression.Type | None = ..., minimum: int | None = ..., maximum: int | None = ..., initial: int | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...

class LocationType(expression.Type):
    """The type of a plant's location."""
    plant: sct.Plant
    def __init__(self, *, plant: sct.Plant | None = ..., source: Place | None = ...) -> None: ...

class Source:
    """A source of incoming events: a topic, a service or an action. The controller counts the reactions to each source."""
    name: str
    batch: bool
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., batch: bool | None = ...) -> None: ...

class Timer:
    """A timer that runs or has stopped. On expiry it stops, and its event happens if the guard of the event holds."""
    event: Event
    milliseconds: int
    initial: bool
    location: sct.Location | None
    duration: sct.Duration | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, event: Event | None = ..., milliseconds: int | None = ..., initial: bool | None = ..., location: sct.Location | None = ..., duration: sct.Duration | None = ...) -> None: ...

class Restart:
    """A change of timers by an event, if the condition holds before the event."""
    condition: expression.Expression | None
    left: sct.Plant | None
    starts: MutableSequence[Timer]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, condition: expression.Expression | None = ..., left: sct.Plant | None = ..., starts: Iterable[Timer] = ...) -> None: ...

class Group:
    """Mutually exclusive events: at most one of them happens in a span."""
    name: str
    span: Span
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., span: Span | None = ...) -> None: ...

class Span:
    """round: one pass over the cancels and triggers, as after a batch or in a tick; tick: from the start of one tick to the start of the next."""
    name: str
    round: ClassVar[Span]
    tick: ClassVar[Span]

class Reader:
    """A user of the state. An incremental control loop reevaluates a reader after an event that writes state which the reader reads. The features `readers` contain the readers of an event or of a changed condition. Their order is cancels, triggers, silent events, choices, conditions. They are empty if the control loop is not incremental."""
    name: str
    readers: MutableSequence[Reader]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Condition(Reader):
    """A condition shared by several guards: a function, or a value that is computed once."""
    value: expression.Expression
    events: MutableSequence[Event]
    def __init__(self, *, value: expression.Expression | None = ..., events: Iterable[Event] = ..., name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Event(Reader):
    """An event of the controller. It may happen if its guard holds; then its effect changes the state."""
    event: sct.Event
    role: Role
    description: str
    remarks: MutableSequence[str]
    inputs: MutableSequence[Input]
    source: Source | None
    group: Group | None
    choice: Choice | None
    guard: Guard
    effect: Effect
    reasons: MutableSequence[Reason]
    restarts: MutableSequence[Restart]
    def __init__(self, *, event: sct.Event | None = ..., role: Role | None = ..., description: str | None = ..., remarks: Iterable[str] = ..., inputs: Iterable[Input] = ..., source: Source | None = ..., group: Group | None = ..., choice: Choice | None = ..., guard: Guard | None = ..., effect: Effect | None = ..., reasons: Iterable[Reason] = ..., restarts: Iterable[Restart] = ..., name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Reason:
    """A cause that can prevent an event, in the words of the robot's model. If the guard is false and no cause with a condition applies, synthesis is the cause."""
    kind: Origin
    condition: expression.Expression | None
    text: str
    location: StateVariable | None
    requirement: sct.Requirement | None
    assumption: sct.Plant | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, kind: Origin | None = ..., condition: expression.Expression | None = ..., text: str | None = ..., location: StateVariable | None = ..., requirement: sct.Requirement | None = ..., assumption: sct.Plant | None = ...) -> None: ...

class Role:
    """cancel, trigger: the control loop sends the event, cancels first; silent: the control loop performs silent events until none is enabled; data: selects the data of a trigger; incoming: the robot causes the event, and the caller performs it; timeout: a timer expires."""
    name: str
    cancel: ClassVar[Role]
    trigger: ClassVar[Role]
    silent: ClassVar[Role]
    data: ClassVar[Role]
    incoming: ClassVar[Role]
    timeout: ClassVar[Role]

class Guard:
    """The conjunction of all terms, the condition of an event on the state. No term is constant, except the single term `false` of a guard that never holds. No two terms are equal."""
    terms: MutableSequence[Term]
    plants: expression.Expression | None
    assumption: expression.Expression | None
    requirement: expression.Expression | None
    synthesis: expression.Expression | None
    data: expression.Expression | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, terms: Iterable[Term] = ..., plants: expression.Expression | None = ..., assumption: expression.Expression | None = ..., requirement: expression.Expression | None = ..., synthesis: expression.Expression | None = ..., data: expression.Expression | None = ...) -> None: ...

class Term:
    """A conjunct of a guard."""
    condition: expression.Expression
    origins: MutableSequence[Origin]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, condition: expression.Expression | None = ..., origins: Iterable[Origin] = ...) -> None: ...

class Origin:
    """plants: without the term a plant has no edge for the event; requirement: the requirements; synthesis: the restriction that synthesis added; assumption: the assumptions about the robot."""
    name: str
    plants: ClassVar[Origin]
    requirement: ClassVar[Origin]
    synthesis: ClassVar[Origin]
    assumption: ClassVar[Origin]

class Effect:
    """The changes of an event. They are simultaneous: each value is that before the event. A target can execute the steps in sequence, because no step reads a variable after its assignment. Exceptions are the variables in `copied`: references with `before` read a copy."""
    steps: MutableSequence[Step]
    copied: MutableSequence[StateVariable]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, steps: Iterable[Step] = ..., copied: Iterable[StateVariable] = ...) -> None: ...

class Step:
    """A part of an effect."""
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self) -> None: ...

class Assignment(Step):
    """An assignment to a variable."""
    variable: StateVariable
    value: expression.Expression
    def __init__(self, *, variable: StateVariable | None = ..., value: expression.Expression | None = ...) -> None: ...

class Switch(Step):
    """Assignments that depend on the location of a plant. The first case with a true condition applies."""
    cases: MutableSequence[Case]
    def __init__(self, *, cases: Iterable[Case] = ...) -> None: ...

class Case:
    """A case of a switch."""
    condition: expression.Expression | None
    assignments: MutableSequence[Assignment]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, condition: expression.Expression | None = ..., assignments: Iterable[Assignment] = ...) -> None: ...

class Choice(Reader):
    """The selection of the data to send: the first alternative with an enabled event. The controller selects again before each silent event and after the last."""
    plant: sct.Plant
    variable: StateVariable | None
    alternatives: MutableSequence[Alternative]
    def __init__(self, *, plant: sct.Plant | None = ..., variable: StateVariable | None = ..., alternatives: Iterable[Alternative] = ..., name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Alternative:
    """An alternative of a choice."""
    event: Event
    chosen: expression.Expression | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, event: Event | None = ..., chosen: expression.Expression | None = ...) -> None: ...

class VariableReference(expression.Expression):
    """The value of a state variable."""
    variable: StateVariable
    before: bool
    def __init__(self, *, variable: StateVariable | None = ..., before: bool | None = ..., source: Place | None = ...) -> None: ...

class InputReference(expression.Expression):
    """The value of an input."""
    input: Input
    def __init__(self, *, input: Input | None = ..., source: Place | None = ...) -> None: ...

class ConditionReference(expression.Expression):
    """The value of a shared condition."""
    condition: Condition
    def __init__(self, *, condition: Condition | None = ..., source: Place | None = ...) -> None: ...

class LocationLiteral(expression.Expression):
    """A location of a plant as a value."""
    location: sct.Location
    def __init__(self, *, location: sct.Location | None = ..., source: Place | None = ...) -> None: ...

class And(expression.Expression):
    """The conjunction of the operands. No operand is an And or constant, and no two operands are equal. Operands have no side effects, so a target may evaluate all or some of them."""
    operands: MutableSequence[expression.Expression]
    def __init__(self, *, operands: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Or(expression.Expression):
    """The disjunction of the operands. No operand is an Or or constant, and no two operands are equal. Operands have no side effects, so a target may evaluate all or some of them."""
    operands: MutableSequence[expression.Expression]
    def __init__(self, *, operands: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Remainder(expression.BinaryExpression):
    """The remainder of the left operand divided by the right operand, a positive constant. It has the sign of the left operand, as `%` in C. A call of `mod` is one remainder. For a possibly negative value it is the remainder of a remainder plus the divisor."""
    def __init__(self, *, left: expression.Expression | None = ..., right: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Saturation(expression.UnaryExpression):
    """The nearest value within bounds."""
    minimum: int
    maximum: int
    bits: int
    def __init__(self, *, minimum: int | None = ..., maximum: int | None = ..., bits: int | None = ..., operand: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Conversion(expression.UnaryExpression, Storage):
    """The same value in another storage that can hold it. Operators on integers compute in the storage of their operands. A literal has the storage of the other operand, and a comparison with a literal needs no conversion."""
    widens: bool
    def __init__(self, *, widens: bool | None = ..., operand: expression.Expression | None = ..., source: Place | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...
