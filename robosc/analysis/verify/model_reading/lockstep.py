"""Comparison of the text's reading and the plants' reading of a robot, from the initial state on."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import reduce
from itertools import product
from math import prod
from operator import or_
from random import Random
from typing import TYPE_CHECKING, NamedTuple, cast

from robosc.analysis.paths import TraceStep
from robosc.analysis.verify.model_reading.plants import AmbiguousError
from robosc.analysis.wording import words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import (
        Claim,
        Domain,
        Event,
        EventOutcome,
        Literal,
        Machine,
        Restriction,
        Slot,
        Value,
    )
    from robosc.model import expression as ex


#: Cost of evaluating an event, in units of a cache hit.
_COMPUTED = 30
#: Events are cached together while their slots have at most this many joint values.
_TOGETHER = 1000


class DifferenceError(Exception):
    """The readings differ: the explanation, the events that lead there, and those that demonstrate it."""

    def __init__(self, explanation: str, trace: Sequence[TraceStep] = (), onwards: Sequence[TraceStep] = ()) -> None:
        super().__init__(explanation)
        self.explanation = explanation
        self.trace = tuple(trace)
        self.onwards = tuple(onwards)


@dataclass(frozen=True)
class Effort:
    """Limits of the comparison, and its fallbacks.

    Up to `first` states are explored. If there are more, each event is compared for all combinations of the values that
    it reads, reachable or not, up to `values` combinations in total. If these are too many, or a difference may be
    unreachable, up to `states` states are explored (fewer if all of them together take more than `bits` bits), with at
    most `tries` evaluations of an event. An event that has to be computed counts as `_COMPUTED` evaluations. An event
    with more than `inputs` combinations of input values is sampled in each state. The rest is sampled by `random`
    evaluations on a random walk.
    """

    first: int = 100_000
    states: int = 1_000_000
    bits: int = 1 << 28
    tries: int = 50_000_000
    inputs: int = 100_000
    values: int = 500_000
    random: int = 500_000


class ComparisonExtent(NamedTuple):
    """Extent of the comparison: numbers of states and events, whether it is exhaustive, and random steps.

    Without random steps, a comparison that is not exhaustive covers each event in all states, reachable or not.
    """

    states: int
    events: int
    is_whole: bool
    steps: int


class _Pair:
    """An event in both readings, with its effects in the states so far."""

    def __init__(self, text: Event, plants: Event, layout: _SlotLayout, most: int) -> None:
        self.text, self.plants = text, plants
        self.reads = sorted(text.reads | plants.reads)
        self.mask = layout.mask(self.reads)
        self.known: dict[int, tuple[tuple[int, int], ...]] = {}
        self.domains = plants.inputs
        self.is_sampled = prod(map(_size, self.domains.values())) > most
        #: Inputs with which the readings differ in some state, reachable or not.
        self.differing: dict[str, Value] | None = None

    def all_choices(self) -> Iterator[dict[str, Value]]:
        """Yield all combinations of input values."""
        for values in product(*self.domains.values()):
            yield dict(zip(self.domains, values, strict=True))

    def choices(self, random: Random) -> Iterator[dict[str, Value]]:
        """Yield all combinations of input values, or a sample if there are too many."""
        if not self.is_sampled:
            yield from self.all_choices()
        else:
            ends = [(domain[0], domain[-1]) for domain in self.domains.values()]
            for values in product(*ends) if len(ends) < 10 else ():
                yield dict(zip(self.domains, values, strict=True))
            for _ in range(100):
                yield self.choice(random)

    def choice(self, random: Random) -> dict[str, Value]:
        """Return a random value of each input; every other time the inputs with which the readings may differ."""
        if self.differing is not None and random.random() < 0.5:
            return self.differing
        return {name: domain[random.randrange(_size(domain))] for name, domain in self.domains.items()}


class _SlotLayout:
    """States as integers, with some bits for each slot that any condition or event reads."""

    def __init__(self, domains: Mapping[Slot, Domain]) -> None:
        self.domains = domains
        self._places: dict[Slot, tuple[int, int]] = {}
        place = 0
        for slot, domain in domains.items():
            bits = (_size(domain) - 1).bit_length()
            self._places[slot] = place, (1 << bits) - 1
            place += bits
        self.bits = max(place, 1)

    def mask(self, slots: Iterable[Slot]) -> int:
        """Return the bits of some slots."""
        return sum(mask << place for place, mask in (self._places[slot] for slot in slots))

    def value(self, slot: Slot, state: int) -> Value:
        """Return the value of a slot."""
        place, ones = self._places[slot]
        return self.domains[slot][state >> place & ones]

    def change(self, writes: Mapping[Slot, Value]) -> tuple[int, int]:
        """Return the bits to keep and the bits to add for an assignment to slots."""
        preserved, added = -1, 0
        for slot, value in writes.items():
            if slot in self._places:
                place, ones = self._places[slot]
                preserved &= ~(ones << place)
                added |= self.domains[slot].index(value) << place  # type: ignore[arg-type]
        return preserved, added


class _Group:
    """Consecutive pairs that read few slots together: their effects are cached together."""

    def __init__(self, pairs: Sequence[_Pair]) -> None:
        self.pairs = pairs
        self.mask = reduce(or_, (pair.mask for pair in pairs), 0)
        self.known: dict[int, tuple[tuple[int, int], ...]] = {}

    def learn(self, state: int, changes: Iterable[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
        """Cache the changes of the pairs for all states with the same slots; return the effective ones."""
        distinct_changes = tuple(
            (preserved, added)
            for preserved, added in dict.fromkeys(changes)
            if ~preserved & ~self.mask or state & preserved | added != state
        )
        self.known[state & self.mask] = distinct_changes
        return distinct_changes


def _groups(pairs: Iterable[_Pair], layout: _SlotLayout) -> Iterator[_Group]:
    """Yield groups of all pairs, in their order."""
    together: list[_Pair] = []
    slots: set[Slot] = set()
    for pair in pairs:
        if together and prod(_size(layout.domains[slot]) for slot in slots.union(pair.reads)) > _TOGETHER:
            yield _Group(together)
            together, slots = [], set()
        together.append(pair)
        slots.update(pair.reads)
    if together:
        yield _Group(together)


class Lockstep:
    """Comparison of a text with its plants."""

    def __init__(self, text: Machine, plants: Machine, effort: Effort) -> None:
        _same_things(text, plants)
        self._effort = effort
        self._random = Random(0)  # noqa: S311 - the same values on every run
        self._tries = 0
        claims = list(zip(text.conditions, plants.conditions, strict=True))
        slots = {slot for event in (*text.events.values(), *plants.events.values()) for slot in event.reads}
        slots |= {slot for pair in claims for claim in pair for slot in claim.condition.reads}
        self._layout = _SlotLayout({slot: domain for slot, domain in text.domains.items() if slot in slots})
        self._pairs = [
            _Pair(event, plants.events[name], self._layout, effort.inputs) for name, event in text.events.items()
        ]
        self._claims = [
            (claim, other, self._layout.mask(reads), sorted(reads), set[int]())
            for claim, other in claims
            for reads in [claim.condition.reads | other.condition.reads]
        ]
        self._groups = list(_groups(self._pairs, self._layout))
        self._claim_mask = reduce(or_, (mask for _, _, mask, _, _ in self._claims), 0)
        self._claimed_in = set[int]()
        self._initial = self._layout.change(text.initial)[1]
        self._before = {self._initial: self._initial}
        self._waiting = deque(self._before)

    def run(self) -> ComparisonExtent:
        """Compare all states, or as many as the effort allows plus a sample; raise DifferenceError."""
        most = min(self._effort.states, self._effort.bits // self._layout.bits)
        is_sampled = any(pair.is_sampled for pair in self._pairs)
        is_whole = self._explore(min(self._effort.first, most)) and not is_sampled
        steps = 0
        if not is_whole and not self._is_same_everywhere():
            is_whole = self._explore(most) and not is_sampled
            steps = 0 if is_whole else max(1, self._effort.random // len(self._pairs))
        self._wander(steps)
        return ComparisonExtent(len(self._before), len(self._pairs), is_whole, steps)

    def _explore(self, most: int) -> bool:
        """Explore up to `most` states breadth first; return whether these are all."""
        before, waiting = self._before, self._waiting
        while waiting:
            if len(before) > most or self._tries > self._effort.tries:
                return False
            state = waiting.popleft()
            if state & self._claim_mask not in self._claimed_in:
                self._claimed_in.add(state & self._claim_mask)
                self._claimed(state, state)
            self._tries += len(self._pairs)
            for group in self._groups:
                cached = group.known.get(state & group.mask)
                if cached is None:
                    cached = group.learn(state, self._changes(group, state))
                for preserved, added in cached:
                    successor = state & preserved | added
                    if successor not in before:
                        before[successor] = state
                        waiting.append(successor)
        return True

    def _is_same_everywhere(self) -> bool:
        """Return whether no state has a difference; False also if there are too many states to try."""
        left = self._effort.values
        comparisons: list[tuple[Sequence[Slot], _Pair | None, Sequence[Claim]]] = [
            (pair.reads, pair, ()) for pair in self._pairs
        ]
        comparisons += [(reads, None, (claim, other)) for claim, other, _, reads, _ in self._claims]
        for reads, pair, _ in comparisons:
            domains = [self._layout.domains[slot] for slot in reads]
            left -= prod(map(_size, [*domains, *(pair.domains.values() if pair else ())]))
        if left < 0:
            return False
        for reads, pair, claims in comparisons:
            for values in product(*(self._layout.domains[slot] for slot in reads)):
                state = dict(zip(reads, values, strict=True))
                if len({_holds(claim, state) for claim in claims}) > 1:
                    return False
                for inputs in pair.all_choices() if pair else ():
                    try:
                        self._effect(cast("_Pair", pair), state, inputs, ())
                    except DifferenceError:  # The state may be unreachable.
                        cast("_Pair", pair).differing = inputs
                        return False
        return True

    def _wander(self, steps: int) -> None:
        """Follow a random path with random data."""
        state, trace = self._initial, list[TraceStep]()
        for _ in range(steps):
            self._claimed(state, trace)
            possible = []
            for pair in self._pairs:
                inputs = pair.choice(self._random)
                change = self._effect(pair, self._state(pair.reads, state), inputs, trace)
                if change is not None:
                    possible.append((change, _step(pair, inputs)))
            if not possible or len(trace) == 100:
                state, trace = self._initial, []
                continue
            (preserved, added), step = self._random.choice(possible)
            state = state & preserved | added
            trace.append(step)

    def _changes(self, group: _Group, state: int) -> Iterator[tuple[int, int]]:
        """Yield the changes of a group's events in a state."""
        for pair in group.pairs:
            key = state & pair.mask
            if key not in pair.known:
                pair.known[key] = self._compared(pair, state)
            yield from pair.known[key]

    def _compared(self, pair: _Pair, state: int) -> tuple[tuple[int, int], ...]:
        slots = self._state(pair.reads, state)
        changes: dict[tuple[int, int], None] = {}
        for inputs in pair.choices(self._random):
            self._tries += _COMPUTED
            change = self._effect(pair, slots, inputs, state)
            if change is not None:
                changes[change] = None
        return tuple(changes)

    def _state(self, slots: Iterable[Slot], state: int) -> dict[Slot, Value]:
        return {slot: self._layout.value(slot, state) for slot in slots}

    def _effect(
        self, pair: _Pair, slots: Mapping[Slot, Value], inputs: Mapping[str, Value], way: int | Sequence[TraceStep]
    ) -> tuple[int, int] | None:
        """Return the change of an event in both readings; None if it is impossible or forbidden."""
        ours = pair.text.happen(slots, inputs)
        try:
            theirs = pair.plants.happen(slots, inputs)
        except AmbiguousError as error:
            message = f"{error} for {words(pair.plants.element)}{line(error.source)}"
            raise self._difference(message, slots, inputs, way) from error
        message = _unlike(ours, theirs, slots, pair)
        if message:
            raise self._difference(message, slots, inputs, way)
        if ours.refused or ours.forbidden:
            return None
        return self._layout.change(ours.writes)

    def _claimed(self, state: int, way: int | Sequence[TraceStep]) -> None:
        """Compare the conditions of invariants and properties."""
        for claim, other, mask, reads, known in self._claims:
            if state & mask not in known:
                known.add(state & mask)
                slots = self._state(reads, state)
                ours = _holds(claim, slots)
                if ours is not _holds(other, slots):
                    message = f"{claim.what}{line(claim.source)} {'holds' if ours else 'does not hold'} by the text"
                    message += f" and {'does not' if ours else 'does'} in the model{where(slots)}"
                    raise DifferenceError(message, self._way(way))

    def _difference(
        self,
        message: str,
        slots: Mapping[Slot, Value],
        inputs: Mapping[str, Value],
        way: int | Sequence[TraceStep],
    ) -> DifferenceError:
        data = f" with {', '.join(f'{name} = {_text(value)}' for name, value in inputs.items())}" if inputs else ""
        return DifferenceError(f"{message}{where(slots)}{data}", self._way(way))

    def _way(self, way: int | Sequence[TraceStep]) -> list[TraceStep]:
        """Return `way` as a list of steps: for a state, the shortest trace to it."""
        if not isinstance(way, int):
            return list(way)
        steps: list[TraceStep] = []
        while way != self._initial:
            before = self._before[way]
            steps.append(self._between(before, way))
            way = before
        return steps[::-1]

    def _between(self, before: int, after: int) -> TraceStep:
        for pair in self._pairs:
            if any(before & preserved | added == after for preserved, added in pair.known.get(before & pair.mask, ())):
                slots = self._state(pair.reads, before)
                for inputs in pair.choices(Random(0)):  # noqa: S311
                    outcome = pair.text.happen(slots, inputs)
                    if not outcome.refused and not outcome.forbidden:
                        preserved, added = self._layout.change(outcome.writes)
                        if before & preserved | added == after:
                            return _step(pair, inputs)
        raise AssertionError(f"no event leads from {before} to {after}")


def _same_things(text: Machine, plants: Machine) -> None:
    """Compare everything that needs no exploration: slots, events and initial values."""
    for slot in dict.fromkeys([*text.domains, *plants.domains]):
        _same_slot(slot, text, plants)
    for name in dict.fromkeys([*text.events, *plants.events]):
        ours, theirs = text.events.get(name), plants.events.get(name)
        if ours is None or theirs is None:
            only = "the model" if ours is None else "the text"
            raise DifferenceError(f"event `{name.name}` of `{name.plant.origin}` is only in {only}")
        _same_event(ours, theirs)
    mine, other = ([claim.what for claim in machine.conditions] for machine in (text, plants))
    if mine != other:
        raise DifferenceError("the invariants and properties of the model are others than those of the text")


def _same_slot(slot: Slot, text: Machine, plants: Machine) -> None:
    here, there = text.domains.get(slot), plants.domains.get(slot)
    slot_words = f"{_called(slot)}{line(text.sources.get(slot))}"
    if here is None or there is None:
        raise DifferenceError(f"{slot_words} is only in {'the model' if here is None else 'the text'}")
    if _kind(here) != _kind(there):
        raise DifferenceError(f"{slot_words} has {_values(here)} by the text, {_values(there)} in the model")
    first, other = text.initial[slot], plants.initial[slot]
    if first != other:
        raise DifferenceError(f"{slot_words} begins at {_text(first)} by the text, at {_text(other)} in the model")
    for location in sorted(text.marked.get(slot, frozenset()) ^ plants.marked.get(slot, frozenset())):
        only = "text" if location in text.marked[slot] else "model"
        raise DifferenceError(f"location `{location}` of {slot_words} is marked only in the {only}")


def _same_event(ours: Event, theirs: Event) -> None:
    event_words = words(theirs.element)
    place = "" if " in line " in event_words else line(ours.element)
    if (ours.controllable, ours.kind) != (theirs.controllable, theirs.kind):
        other = f"{'' if theirs.controllable else 'un'}controllable in the model, of kind {theirs.kind}"
        raise DifferenceError(f"{event_words}{place} is {other}")
    if ours.timer != theirs.timer:
        raise DifferenceError(f"{event_words}{place} has another time or place in the model")
    for name, domain in ours.inputs.items():
        if theirs.inputs[name] != domain:
            there = _values(theirs.inputs[name])
            raise DifferenceError(
                f"`{name}` of {event_words}{place} has {_values(domain)} by the text, {there} in the model"
            )


def _unlike(ours: EventOutcome, theirs: EventOutcome, slots: Mapping[Slot, Value], pair: _Pair) -> str:
    """Return how two readings of an event in a state differ, as text; empty if they agree."""
    mine, other = _changed(ours, slots), _changed(theirs, slots)
    if (bool(ours.refused), bool(ours.forbidden), mine) == (bool(theirs.refused), bool(theirs.forbidden), other):
        return ""
    event_words = words(pair.plants.element)
    if bool(ours.refused) != bool(theirs.refused):
        if ours.refused:
            return f"{event_words} can happen in the plants, and not by the text{line(ours.refused.source)}"
        lines = _lines(taken.source for taken in ours.taken) or line(pair.text.element)
        return f"{event_words} can happen by the text{lines}, and not in the plants"
    if bool(ours.forbidden) != bool(theirs.forbidden):
        restriction: Restriction | None = ours.forbidden or theirs.forbidden
        assert restriction is not None
        who = ("the text", "the model") if ours.forbidden else ("the model", "the text")
        return f"{event_words} is forbidden by {who[0]}{line(restriction.source)}, and not by {who[1]}"
    for slot in dict.fromkeys([*mine, *other]):
        if mine.get(slot) != other.get(slot):
            lines = _lines(taken.source for taken in ours.taken if slot in taken.writes) or line(pair.text.element)
            difference = f"{_becomes(slot, mine)} by the text{lines}, and {_becomes(slot, other)} in the plants"
            return f"after {event_words}, {_called(slot)} {difference}"
    raise AssertionError("they do not differ")


def _changed(outcome: EventOutcome, slots: Mapping[Slot, Value]) -> dict[Slot, Value]:
    """Return the writes that change a value."""
    return {slot: value for slot, value in outcome.writes.items() if slots.get(slot, None) != value}


def _becomes(slot: Slot, writes: Mapping[Slot, Value]) -> str:
    if slot not in writes:
        return "stays as it was"
    return f"is {_text(writes[slot])}" if slot.variable else f"is in `{writes[slot]}`"


def _holds(claim: Claim, slots: Mapping[Slot, Value]) -> bool:
    return bool(claim.condition.compute(slots, {})) is claim.value


def _step(pair: _Pair, inputs: Mapping[str, Value]) -> TraceStep:
    event = pair.plants.element
    return TraceStep(f"{event.eContainer().name}.{event.name}", dict(inputs))


def _size(domain: Domain) -> int:
    return domain.stop - domain.start if isinstance(domain, range) else len(domain)


def _kind(domain: Domain) -> object:
    """Return the domain without the order of locations and literals."""
    return domain if isinstance(domain, range) else frozenset(domain)


def _values(domain: Domain) -> str:
    if isinstance(domain, range):
        return f"values from {domain.start} to {domain.stop - 1}"
    return "values " + ", ".join(map(_text, domain)) if domain else "no values"


def _text(value: Value | Literal) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _called(slot: Slot) -> str:
    kind, origin = slot.plant
    owner = f"requirement automaton {origin}" if kind == "requirement" else f"`{origin}`"
    if slot.variable:
        return f"`{origin}.{slot.variable}`" if kind != "requirement" else f"the count of {owner}"
    return f"the data of {owner}" if kind == "data" else owner


def where(slots: Mapping[Slot, Value]) -> str:
    """Return values of slots as a condition of the language, without unnamed requirement automata."""
    conditions = [
        f"{slot.plant.origin}.{slot.variable} = {_text(value)}" if slot.variable else f"{slot.plant.origin}.{value}"
        for slot, value in slots.items()
        if slot.plant.kind != "requirement"
    ]
    return f" where `{' and '.join(conditions)}`" if conditions else ""


def line(source: ex.Located | None) -> str:
    """Return the line of an element, in parentheses."""
    return f" (line {source.source.span.line})" if source is not None and source.source is not None else ""


def _lines(sources: Iterable[ex.Located | None]) -> str:
    numbers = sorted({part.source.span.line for part in sources if part is not None and part.source is not None})
    return f" (line{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))})" if numbers else ""
