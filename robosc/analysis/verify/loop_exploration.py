"""Explores the generated control loop side by side with the one in Python."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import product
from math import prod
from random import Random
from typing import TYPE_CHECKING, Any

from robosc.analysis.system import counted
from robosc.analysis.verify.differences import refuted
from robosc.analysis.verify.loop_lockstep import DifferenceError, Kept, Lockstep
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.engine import Settings, remembered
from robosc.semantics.roles import Roles

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from subprocess import Popen

    from robosc.analysis.paths import TraceStep
    from robosc.analysis.verify.c_program import CProgram

    #: What is done with both loops; False where it has no meaning in the state they are in, and was not done.
    Operation = Callable[[Lockstep], bool]

PROPERTY = "loop-translation"
#: The loop is explored under each: without reactions, and with quotas that are used up at once.
_EXPLORED = (Settings(react_immediately=False), Settings(1, 1, resolution_ms=1))
#: It is walked through under each, so often, in a part of its own that begins with some messages before the first tick.
_WALKED = (Settings(), Settings(0, 1), Settings(1, 2), Settings(2, 1), Settings(react_immediately=False))
_PARTS, _EARLY = 4, 3
#: Of an event with more values of its inputs, these are tried: all least, all greatest, all in the middle.
_VALUES = 4
#: An operation asks all events whether they can happen; so many questions are asked in the whole.
_QUESTIONS = 1_000_000
#: So many values are near an end of an input's range.
_NEAR = 3
#: So many milliseconds go by at most where it is not known when something is up.
_LONGEST = 10_000


@dataclass(frozen=True)
class LoopEffort:
    """How many operations (batches, ticks and the like) are tried.

    `explored`: most while the loop's states are explored. `walked`: those of the random walk after it. Neither is more
    than `_QUESTIONS` divided by the number of events.
    """

    explored: int = 60_000
    walked: int = 5_000


def explore_loop(program: CProgram, effort: LoopEffort | None = None) -> Verdict:
    """Whether the control loop of the compiled C does what the one in Python does.

    Both are brought into each state that the loop comes to, and do there what a node can ask of it. Where that is too
    much, the rest is sampled. What is random is the same on every run.
    """
    effort = effort or LoopEffort()
    most = max(_QUESTIONS // max(len(program.events), 1), 1)
    with remembered(), program.running([program.follower]) as process:
        lockstep = Lockstep(program.model, process)
        try:
            seen = _explored(lockstep, min(effort.explored, most))
            walked = _walked(lockstep, min(effort.walked, most))
        except DifferenceError as error:
            return refuted(PROPERTY, str(error), tuple(error.seen))
        finally:
            _end(process)
    evidence = f"{counted(seen.states, 'state')}, {counted(seen.operations, 'operation')}"
    if seen.complete:
        return Verdict(PROPERTY, Outcome.PROVED, evidence)
    return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, then {walked:,} at random")


def _end(process: Popen[str]) -> None:
    """Says that nothing follows, unless the process has ended by itself."""
    assert process.stdin is not None
    try:
        process.stdin.close()
    except BrokenPipeError:
        return


@dataclass
class _Seen:
    """How many states of the loop were looked at, by how many operations, and whether these are all."""

    states: int = 0
    operations: int = 0
    complete: bool = True


@dataclass(frozen=True)
class _Node:
    """Both loops as they were, and how they came there: from where, by what happened."""

    kept: Kept
    before: _Node | None = None

    def way(self) -> list[TraceStep]:
        """What happened from the start on."""
        steps: list[TraceStep] = []
        node: _Node | None = self
        while node is not None:
            steps[:0] = node.kept.seen
            node = node.before
        return steps


def _explored(lockstep: Lockstep, operations: int) -> _Seen:
    """All states breadth first, under each of the settings an equal part of the operations."""
    seen = _Seen()
    for part, settings in enumerate(_EXPLORED, 1):
        lockstep.begin(settings)
        lockstep.operate("b")
        _breadth_first(lockstep, seen, operations * part // len(_EXPLORED))
    return seen


def _breadth_first(lockstep: Lockstep, seen: _Seen, operations: int) -> None:
    """From where both are on. A node stands where a batch has begun, which leaves least of what was before."""
    tried = _operations(lockstep)
    lockstep.keep()
    pending = deque(_Node(kept) for kept in lockstep.compare())
    reached = {_key(node.kept) for node in pending}
    while pending:
        node = pending.popleft()
        seen.states += 1
        spent = False
        for operation in tried:
            if spent := seen.operations >= operations:
                break
            lockstep.seen.clear()
            lockstep.go_back(node.kept)
            if operation(lockstep):
                seen.operations += 1
                lockstep.operate("b")
                lockstep.keep()
        try:
            found = lockstep.compare()
        except DifferenceError as error:
            error.seen = [*node.way(), *error.seen]
            raise
        if spent:
            seen.complete = False
            return
        for kept in found:
            if (key := _key(kept)) not in reached:
                reached.add(key)
                pending.append(_Node(kept, node))


def _key(kept: Kept) -> tuple[Any, ...]:
    """What two states have in common that go on alike: times count from now."""
    now, up = kept.saved.timers
    times = tuple((number, until - now) for number, until in sorted(up.items()))
    return kept.saved.cells, kept.saved.rest, times, kept.first


def _operations(lockstep: Lockstep) -> list[Operation]:
    """What is tried in each state: batches, ticks, settling, with and without events that are withheld, times."""
    roles = Roles(lockstep.model)
    number = {event: place for place, event in enumerate(lockstep.events)}
    alone = [number[event] for event in (*roles.incoming, *roles.timeouts, *roles.cancels, *roles.triggers)]
    batches = [[(place, codes)] for place in alone for codes in _values(lockstep, place)]
    for source in roles.sources:
        together = [[(number[event], _values(lockstep, number[event])[end]) for event in source] for end in (0, -1)]
        batches += together if len(source) > 1 else []
    own = [number[event] for event in (*roles.cancels, *roles.triggers, *roles.silent)]
    come = [_batch([(place, _values(lockstep, place)[0])]) for place in alone]
    timed: list[Operation] = [_up, _early, _backwards, _operation("r")] if lockstep.loop.timers.exist else []
    return [
        _operation("be"),
        *(_batch(batch) for batch in batches),
        _impossible,
        _operation("t"),
        _operation("s"),
        *(_without(event, _operation(name)) for event in own for name in ("t", "s")),
        *(_without(number[event], batch) for event in roles.silent for batch in come),
        *timed,
    ]


def _values(lockstep: Lockstep, event: int) -> list[tuple[int, ...]]:
    """Codes for the inputs of an event: all, or the ends and the middle of each."""
    sizes = lockstep.sizes(event)
    if prod(sizes) <= _VALUES:
        return list(product(*map(range, sizes)))
    return [tuple(0 for _ in sizes), tuple(size // 2 for size in sizes), tuple(size - 1 for size in sizes)]


def _operation(names: str) -> Operation:
    def operate(both: Lockstep) -> bool:
        for name in names:
            both.operate(name)
        return True

    return operate


def _batch(batch: Sequence[tuple[int, tuple[int, ...]]]) -> Operation:
    """These events, where the first is possible."""

    def perform(both: Lockstep) -> bool:
        if not both.loop.enabled(both.names[batch[0][0]]):
            return False
        both.operate("b")
        for event, codes in batch:
            both.perform(event, codes)
        both.operate("e")
        return True

    return perform


def _impossible(both: Lockstep) -> bool:
    """A batch of all that is not possible."""
    both.operate("b")
    for event, name in enumerate(both.names):
        if not both.loop.enabled(name):
            both.perform(event, _values(both, event)[0])
    both.operate("e")
    return True


def _without(event: int, operation: Operation) -> Operation:
    """The operation while an event is withheld."""

    def operate(both: Lockstep) -> bool:
        both.withhold(event)
        done = operation(both)
        both.withhold(event)
        return done

    return operate


def _up(both: Lockstep) -> bool:
    """The next time is up."""
    wait = both.loop.timers.wait
    if wait is not None:
        both.pass_time(wait)
        both.operate("x")
    return wait is not None


def _early(both: Lockstep) -> bool:
    """It is nearly."""
    wait = both.loop.timers.wait
    if wait:
        both.pass_time(wait - 1)
        both.operate("x")
    return bool(wait)


def _backwards(both: Lockstep) -> bool:
    both.pass_time(-1)
    both.operate("t")
    return True


def _walked(lockstep: Lockstep, operations: int) -> int:
    """Random operations from the start on, with the settings in turn; says how many."""
    walk = _Walk(lockstep)
    parts = _WALKED * _PARTS
    for part, settings in enumerate(parts, 1):
        lockstep.seen.clear()
        lockstep.begin(settings)
        for _ in range(_EARLY):
            walk.batch()
        while walk.operations * len(parts) < operations * part:
            walk.step()
            lockstep.keep()
        try:
            lockstep.compare()
        except DifferenceError as error:
            error.seen = ()  # What happened so far is not told: it is no shortest way.
            raise
    return walk.operations


class _Walk:
    """Random operations, the same ones each time; nothing else than the model decides on them."""

    def __init__(self, lockstep: Lockstep) -> None:
        self.operations = 0
        self._both = lockstep
        self._random = Random(1)  # noqa: S311  # the same each time
        number = {event: place for place, event in enumerate(lockstep.events)}
        self._incoming = [number[event] for event in Roles(lockstep.model).incoming]

    def step(self) -> None:
        """One of them."""
        timed = [self._wait] * (3 * self._both.loop.timers.exist)
        batches = [self.batch] * 4
        self._random.choice((*batches, self._tick, self._settle, self._withhold, *timed))()

    def batch(self) -> None:
        """A few events."""
        self._operate("b")
        for _ in range(self._random.randrange(4)):
            self._perform()
        self._operate("e")

    def _operate(self, operation: str) -> None:
        self.operations += 1
        self._both.operate(operation)

    def _tick(self) -> None:
        self._operate("t")

    def _settle(self) -> None:
        self._operate("s")

    def _withhold(self) -> None:
        """Withholds one event, or the one that is withheld no longer."""
        withheld = self._both.withheld or range(len(self._both.events))
        if withheld:
            self._both.withhold(self._random.choice(withheld))

    def _wait(self) -> None:
        """Lets time go by, mostly until something is up or nearly so, and now and then backwards; then asks once."""
        timers = self._both.loop.timers
        for number, duration in enumerate(self._both.model.durations):
            length = self._random.choice((duration.shortest, duration.milliseconds, duration.longest))
            self._both.set_duration(number, length)
        steps = [timers.wait or 0, (timers.wait or 0) - 1, self._random.randrange(_LONGEST), -self._random.randrange(9)]
        self._both.pass_time(self._random.choice(steps))
        self._operate("x")

    def _perform(self) -> None:
        """Mostly something that the robot can do now, now and then anything."""
        both = self._both
        possible = [number for number in self._incoming if both.loop.enabled(both.names[number])]
        if not possible or self._random.random() < 0.1:
            possible = list(range(len(both.events)))
        if possible:
            number = self._random.choice(possible)
            self.operations += 1
            both.perform(number, tuple(self._code(size - 1) for size in both.sizes(number)))

    def _code(self, last: int) -> int:
        near = min(last, _NEAR)
        low, high = self._random.choice(((0, near), (last - near, last), (0, last), (0, last)))
        return self._random.randint(low, high)
