"""Generated from metamodel/engine.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model import expression, sct
from robosc.model.places import Place

class EngineModel(expression.NamedElement):
    """One robot's controller."""
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
    """What holds a value. In memory all values are integers: false and true are 0 and 1, locations and literals their positions, from 0."""
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
    """Data that comes with an event."""
    input: sct.Input
    def __init__(self, *, input: sct.Input | None = ..., name: str | None = ..., type: expression.Type | None = ..., minimum: int | None = ..., maximum: int | None = ..., initial: int | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...

class LocationType(expression.Type):
    """The locations of a plant."""
    plant: sct.Plant
    def __init__(self, *, plant: sct.Plant | None = ..., source: Place | None = ...) -> None: ...

class Source:
    """What incoming events come from: a topic, a service or an action. Reactions are counted for each."""
    name: str
    batch: bool
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., batch: bool | None = ...) -> None: ...

class Timer:
    """A time that runs, or does not. When it is up it runs no longer, and its event happens, if its guard holds."""
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
    """What an event does with timers, if the condition holds before it."""
    condition: expression.Expression | None
    left: sct.Plant | None
    starts: MutableSequence[Timer]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, condition: expression.Expression | None = ..., left: sct.Plant | None = ..., starts: Iterable[Timer] = ...) -> None: ...

class Group:
    """Events of which at most one happens in a while."""
    name: str
    span: Span
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., span: Span | None = ...) -> None: ...

class Span:
    """round: one pass over the cancels and triggers, as after a batch or in a tick; tick: from the start of one tick to that of the next."""
    name: str
    round: ClassVar[Span]
    tick: ClassVar[Span]

class Reader:
    """What the state is read for: in an incremental control loop it is asked again after an event that writes what it reads. The features `readers` hold whom an event, or a condition that has changed, concerns, in the order of cancels, triggers, silent events, choices and conditions; they are empty where the control loop is not incremental."""
    name: str
    readers: MutableSequence[Reader]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Condition(Reader):
    """A condition that several guards have in common: a function, or a value that is computed once."""
    value: expression.Expression
    events: MutableSequence[Event]
    def __init__(self, *, value: expression.Expression | None = ..., events: Iterable[Event] = ..., name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Event(Reader):
    """Something that can happen. It may happen where its guard holds; then the effect is made."""
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
    """What can keep an event from happening, in the words of the robot's model. Where none with a condition applies and the guard does not hold, that of synthesis is the reason."""
    kind: Origin
    condition: expression.Expression | None
    text: str
    location: StateVariable | None
    requirement: sct.Requirement | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, kind: Origin | None = ..., condition: expression.Expression | None = ..., text: str | None = ..., location: StateVariable | None = ..., requirement: sct.Requirement | None = ...) -> None: ...

class Role:
    """cancel, trigger: what the controller sends, by the control loop, cancels first; silent: what the control loop performs by itself until none is enabled; data: chooses what a trigger sends; incoming: comes from the robot, the caller performs it; timeout: the time of a timer is up."""
    name: str
    cancel: ClassVar[Role]
    trigger: ClassVar[Role]
    silent: ClassVar[Role]
    data: ClassVar[Role]
    incoming: ClassVar[Role]
    timeout: ClassVar[Role]

class Guard:
    """When an event can happen: where all terms hold. No term is decided before the robot runs, but that a guard which holds nowhere is the term `false`; no two terms are alike."""
    terms: MutableSequence[Term]
    plants: expression.Expression | None
    requirement: expression.Expression | None
    synthesis: expression.Expression | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, terms: Iterable[Term] = ..., plants: expression.Expression | None = ..., requirement: expression.Expression | None = ..., synthesis: expression.Expression | None = ...) -> None: ...

class Term:
    """A part of a guard."""
    condition: expression.Expression
    origins: MutableSequence[Origin]
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, condition: expression.Expression | None = ..., origins: Iterable[Origin] = ...) -> None: ...

class Origin:
    """plants: without it some plant has no edge for the event; requirement: the requirements; synthesis: what synthesis added."""
    name: str
    plants: ClassVar[Origin]
    requirement: ClassVar[Origin]
    synthesis: ClassVar[Origin]

class Effect:
    """What an event changes: all at once, each value read in the state before. The steps are ordered so that they can be made one after the other: nothing is read after it was written, but what `copied` says, and references with `before` read these from a copy."""
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
    """Gives a variable a value."""
    variable: StateVariable
    value: expression.Expression
    def __init__(self, *, variable: StateVariable | None = ..., value: expression.Expression | None = ...) -> None: ...

class Switch(Step):
    """Assignments that depend on the location of a plant: those of the first case whose condition holds."""
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
    """A choice of the data to send: the first alternative whose event is enabled. Chosen anew whenever the model settles, before each silent event and at the end."""
    plant: sct.Plant
    variable: StateVariable | None
    alternatives: MutableSequence[Alternative]
    def __init__(self, *, plant: sct.Plant | None = ..., variable: StateVariable | None = ..., alternatives: Iterable[Alternative] = ..., name: str | None = ..., readers: Iterable[Reader] = ...) -> None: ...

class Alternative:
    """One of the data to choose from."""
    event: Event
    chosen: expression.Expression | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, event: Event | None = ..., chosen: expression.Expression | None = ...) -> None: ...

class VariableReference(expression.Expression):
    """The value of a part of the state."""
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
    """A location of a plant, as a value."""
    location: sct.Location
    def __init__(self, *, location: sct.Location | None = ..., source: Place | None = ...) -> None: ...

class And(expression.Expression):
    """Whether all operands hold. No operand is of the same class or decided, and no two are alike; side effects there are none, so that all or some may be computed."""
    operands: MutableSequence[expression.Expression]
    def __init__(self, *, operands: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Or(expression.Expression):
    """Whether an operand holds. No operand is of the same class or decided, and no two are alike; side effects there are none, so that all or some may be computed."""
    operands: MutableSequence[expression.Expression]
    def __init__(self, *, operands: Iterable[expression.Expression] = ..., source: Place | None = ...) -> None: ...

class Remainder(expression.BinaryExpression):
    """What is left when the left operand is divided by the right one, a positive constant: with the sign of the left operand, as `%` in C. A call of `mod` is one remainder, or where its value may be negative the remainder of one to which the divisor is added."""
    def __init__(self, *, left: expression.Expression | None = ..., right: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Saturation(expression.UnaryExpression):
    """The nearest value within bounds."""
    minimum: int
    maximum: int
    bits: int
    def __init__(self, *, minimum: int | None = ..., maximum: int | None = ..., bits: int | None = ..., operand: expression.Expression | None = ..., source: Place | None = ...) -> None: ...

class Conversion(expression.UnaryExpression, Storage):
    """The same value in another storage, which holds it. Operators on integers compute in the storage that their operands have; a literal has that of what it meets. Comparisons with a literal need no conversion."""
    widens: bool
    def __init__(self, *, widens: bool | None = ..., operand: expression.Expression | None = ..., source: Place | None = ..., bits: int | None = ..., signed: bool | None = ...) -> None: ...
