"""What both readings of a robot come to: slots that hold values, events that change them, conditions on them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.semantics.evaluation import Program

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.metamodel import expression as ex

    #: The values of a slot or an input: names of locations or literals, booleans, or whole numbers.
    Domain: TypeAlias = tuple[bool | str, ...] | range
    Value: TypeAlias = bool | int | str

BOOLEANS: Domain = (False, True)


class Plant(NamedTuple):
    """What a plant stands for: its kind, and the component or communication; of requirements the number."""

    kind: str
    origin: str


class Slot(NamedTuple):
    """A variable of a plant, or, without a name, the location that the plant is in."""

    plant: Plant
    variable: str = ""


class At(NamedTuple):
    """That a plant is in a location."""

    slot: Slot
    location: str


class Told(NamedTuple):
    """An input of the event, by its name among the plants."""

    name: str


class Literal(str):
    """A value of an enum, by its name."""

    __slots__ = ()


#: What a reference in an expression means.
Meaning: TypeAlias = Slot | At | Told | Literal


class EventName(NamedTuple):
    """An event: its plant, and its name there."""

    plant: Plant
    name: str


class Condition(NamedTuple):
    """An expression to compute, with the slots that it reads."""

    compute: Callable[[Mapping[Slot, Value], Mapping[str, Value]], Any]
    reads: frozenset[Slot]


class Taken(NamedTuple):
    """What an event changes, and the part of the text or of the plants that says so."""

    writes: Mapping[Slot, Value]
    source: ex.Located | None


@dataclass
class Participant:
    """What takes part in an event: for a state and inputs what it changes; None where it does not let it happen.

    `component` is the plant of the component whose transitions these are, None where they are no component's.
    """

    step: Callable[[Mapping[Slot, Value], Mapping[str, Value]], Taken | None]
    reads: frozenset[Slot]
    source: ex.Located | None
    component: Plant | None = None


class Restriction(NamedTuple):
    """A requirement on an event, which lets it happen where its condition has the wanted value."""

    condition: Condition
    wanted: bool
    source: ex.Located | None


class Length(NamedTuple):
    """How long a time lasts, in milliseconds.

    Where a parameter of the robot sets it: its name, how many milliseconds one of it is, the least and the greatest.
    """

    milliseconds: int
    parameter: str = ""
    unit: int = 1
    shortest: int | None = None
    longest: int | None = None


class Timer(NamedTuple):
    """A time, the location in which it runs, if in one, and the messages that start it anew."""

    length: Length
    location: str | None
    without: frozenset[EventName]


class Outcome(NamedTuple):
    """What an event does: what does not let it happen, what forbids it, and what it changes where nothing does."""

    refused: Participant | None
    forbidden: Restriction | None
    taken: Sequence[Taken]

    @property
    def writes(self) -> dict[Slot, Value]:
        """All that is changed."""
        return {slot: value for taken in self.taken for slot, value in taken.writes.items()}


@dataclass
class Event:
    """An event with all that takes part in it and all that restricts it; `element` says where it comes from."""

    kind: str
    controllable: bool
    element: Any = None
    participants: list[Participant] = field(default_factory=list)
    restrictions: list[Restriction] = field(default_factory=list)
    inputs: dict[str, Domain] = field(default_factory=dict)
    timer: Timer | None = None

    @property
    def reads(self) -> frozenset[Slot]:
        """The slots on which it depends what the event does."""
        found = [participant.reads for participant in self.participants]
        return frozenset().union(*found, *(restriction.condition.reads for restriction in self.restrictions))

    def happen(self, state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> Outcome:
        """What it does in a state with some inputs."""
        taken: list[Taken] = []
        for participant in self.participants:
            step = participant.step(state, inputs)
            if step is None:
                return Outcome(participant, None, ())
            taken.append(step)
        for restriction in self.restrictions:
            if bool(restriction.condition.compute(state, inputs)) is not restriction.wanted:
                return Outcome(None, restriction, ())
        return Outcome(None, None, taken)


@dataclass
class Machine:
    """A reading of a robot: its slots with their values and the first one, what is marked, events, conditions.

    `conditions` are those of invariants and properties, by what they are called. Only the reading of the text has
    `topics`, the ROS name of each communication, and `order`, the plants of communications and components in the order
    of the text.
    """

    domains: dict[Slot, Domain] = field(default_factory=dict)
    initial: dict[Slot, Value] = field(default_factory=dict)
    marked: dict[Slot, frozenset[str]] = field(default_factory=dict)
    events: dict[EventName, Event] = field(default_factory=dict)
    conditions: list[Claim] = field(default_factory=list)
    sources: dict[Slot, ex.Located] = field(default_factory=dict)
    topics: dict[Plant, str] = field(default_factory=dict)
    order: list[Plant] = field(default_factory=list)


class Claim(NamedTuple):
    """A condition that an invariant or a property has for all states."""

    what: str
    condition: Condition
    wanted: bool
    source: ex.Located | None


def compiled(expression: ex.Expression, meaning: Callable[[ex.Expression], Meaning]) -> Condition:
    """An expression whose references mean so."""
    reads: set[Slot] = set()

    def reader(reference: ex.Expression) -> Callable[..., Any]:
        found = meaning(reference)
        if isinstance(found, At):
            slot, location = found
            reads.add(slot)
            return lambda state, _: state[slot] == location
        if isinstance(found, Slot):
            reads.add(found)
            return lambda state, _: state[found]
        if isinstance(found, Told):
            name = found.name
            return lambda _, inputs: inputs[name]
        return lambda *_: found

    program = Program[Any](expression, reader)
    return Condition(program, frozenset(reads))


def fitting(value: Any, domain: Domain) -> Value:
    """What a slot holds after it is given a value: of an integer out of its range the nearest bound."""
    if isinstance(domain, range):
        return min(max(int(value), domain.start), domain.stop - 1)
    held: Value = value
    return held
