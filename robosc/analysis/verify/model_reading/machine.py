"""Common form of both readings of a robot: slots with values, events that change them, conditions on them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.model.semantics.evaluation import Program

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.model import expression as ex

    #: Values of a slot or an input: names of locations or literals, booleans, or integers.
    Domain: TypeAlias = tuple[bool | str, ...] | range
    Value: TypeAlias = bool | int | str

BOOLEANS: Domain = (False, True)
#: Kinds of the plants of services and actions that others call.
SERVERS = ("serviceServer", "actionServer")


class Plant(NamedTuple):
    """Identity of a plant: its kind, and its component or communication, or a requirement's number."""

    kind: str
    origin: str


class Slot(NamedTuple):
    """A variable of a plant, or, without a name, the location of the plant."""

    plant: Plant
    variable: str = ""


class At(NamedTuple):
    """Condition that a plant is in a location."""

    slot: Slot
    location: str


class EventInput(NamedTuple):
    """Input of the event, by its name in the plants."""

    name: str


class Literal(str):
    """Value of an enum, by its name."""

    __slots__ = ()


#: Meaning of a reference in an expression.
Meaning: TypeAlias = Slot | At | EventInput | Literal


class EventName(NamedTuple):
    """Identity of an event: its plant, and its name there."""

    plant: Plant
    name: str


def choice_of(name: EventName) -> Plant:
    """Return the plant that chooses the data of an event. All ends of a goal for the controller share theirs."""
    is_feedback = name.name == "c_feedback"
    return Plant("data", f"{name.plant.origin}.feedback" if is_feedback else name.plant.origin)


class Condition(NamedTuple):
    """Expression to compute, with the slots that it reads."""

    compute: Callable[[Mapping[Slot, Value], Mapping[str, Value]], Any]
    reads: frozenset[Slot]


class EventEffect(NamedTuple):
    """Changes of an event, and their source in the text or in the plants."""

    writes: Mapping[Slot, Value]
    source: ex.Located | None


@dataclass
class Participant:
    """Participant in an event: a function from state and inputs to changes; None if it refuses the event.

    `component` is the plant of the component that has these transitions, None if no component has them.
    """

    step: Callable[[Mapping[Slot, Value], Mapping[str, Value]], EventEffect | None]
    reads: frozenset[Slot]
    source: ex.Located | None
    component: Plant | None = None


class Restriction(NamedTuple):
    """Requirement on an event; it allows the event if its condition has the value `value`."""

    condition: Condition
    value: bool
    source: ex.Located | None


class Length(NamedTuple):
    """Length of a timer in milliseconds.

    If a parameter of the robot sets it, `parameter` is its name and `unit` the milliseconds of one unit. `shortest` and
    `longest` are then the limits of the length.
    """

    milliseconds: int
    parameter: str = ""
    unit: int = 1
    shortest: int | None = None
    longest: int | None = None


class Timer(NamedTuple):
    """A timer, the location in which it runs (if any), and the messages that restart it."""

    length: Length
    location: str | None
    without: frozenset[EventName]


class EventOutcome(NamedTuple):
    """Result of an event: the participant that refuses it, the requirement that forbids it, or its changes."""

    refused: Participant | None
    forbidden: Restriction | None
    taken: Sequence[EventEffect]

    @property
    def writes(self) -> dict[Slot, Value]:
        """All changes."""
        return {slot: value for taken in self.taken for slot, value in taken.writes.items()}


@dataclass
class Event:
    """An event with its participants and requirements; `element` is its source.

    In the reading of the text, `parts` are the expressions over the event's data that its inputs replace.
    """

    kind: str
    controllable: bool
    element: Any = None
    participants: list[Participant] = field(default_factory=list)
    restrictions: list[Restriction] = field(default_factory=list)
    inputs: dict[str, Domain] = field(default_factory=dict)
    parts: dict[str, ex.Expression] = field(default_factory=dict)
    timer: Timer | None = None

    @property
    def reads(self) -> frozenset[Slot]:
        """Slots that the result of the event depends on."""
        slots = [participant.reads for participant in self.participants]
        return frozenset().union(*slots, *(restriction.condition.reads for restriction in self.restrictions))

    def happen(self, state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventOutcome:
        """Return the result of the event in a state with some inputs."""
        taken: list[EventEffect] = []
        for participant in self.participants:
            step = participant.step(state, inputs)
            if step is None:
                return EventOutcome(participant, None, ())
            taken.append(step)
        for restriction in self.restrictions:
            if bool(restriction.condition.compute(state, inputs)) is not restriction.value:
                return EventOutcome(None, restriction, ())
        return EventOutcome(None, None, taken)


@dataclass
class Machine:
    """A reading of a robot: slots with their values and initial values, marked locations, events, conditions.

    `conditions` are those of invariants and properties. Only the reading of the text has `topics`, the ROS name of each
    communication, `order`, the plants of communications and components in the order of the text, `provided`, the
    `provide` statements of each choice of data with their constant data, and `assumed`, the conditions of the
    assumptions about each event.
    """

    domains: dict[Slot, Domain] = field(default_factory=dict)
    initial: dict[Slot, Value] = field(default_factory=dict)
    marked: dict[Slot, frozenset[str]] = field(default_factory=dict)
    events: dict[EventName, Event] = field(default_factory=dict)
    conditions: list[Claim] = field(default_factory=list)
    sources: dict[Slot, ex.Located] = field(default_factory=dict)
    topics: dict[Plant, str] = field(default_factory=dict)
    order: list[Plant] = field(default_factory=list)
    provided: dict[Plant, list[ProvidedConstant]] = field(default_factory=dict)
    assumed: dict[EventName, dict[Plant, Condition]] = field(default_factory=dict)


class ProvidedConstant(NamedTuple):
    """A `provide` statement. `inputs` are the values that the command's inputs have with its data.

    An input is missing if this reading does not compute it. `inputs` is None if the data are not constant.
    """

    statement: ex.Located
    inputs: Mapping[str, Value] | None


class Claim(NamedTuple):
    """Condition of an invariant or a property, to compare in all states."""

    what: str
    condition: Condition
    value: bool
    source: ex.Located | None


def compile_condition(expression: ex.Expression, meaning: Callable[[ex.Expression], Meaning]) -> Condition:
    """Return an expression as a condition; `meaning` resolves its references."""
    reads: set[Slot] = set()

    def reader(reference: ex.Expression) -> Callable[..., Any]:
        target = meaning(reference)
        if isinstance(target, At):
            slot, location = target
            reads.add(slot)
            return lambda state, _: state[slot] == location
        if isinstance(target, Slot):
            reads.add(target)
            return lambda state, _: state[target]
        if isinstance(target, EventInput):
            name = target.name
            return lambda _, inputs: inputs[name]
        return lambda *_: target

    program = Program[Any](expression, reader)
    return Condition(program, frozenset(reads))


def saturate(value: Any, domain: Domain) -> Value:
    """Return the value of a slot after an assignment; an integer saturates at its range."""
    if isinstance(domain, range):
        return min(max(int(value), domain.start), domain.stop - 1)
    result: Value = value
    return result
