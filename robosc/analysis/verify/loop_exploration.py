"""Exploration of the generated control loop side by side with the one in Python."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import product
from math import prod
from random import Random
from typing import TYPE_CHECKING, Any

from robosc.analysis.system import format_count
from robosc.analysis.verify.differences import refute
from robosc.analysis.verify.loop_lockstep import DifferenceError, Lockstep, SavedLoops
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.engine import Settings, cache_results
from robosc.model.semantics.roles import Roles

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from subprocess import Popen

    from robosc.analysis.paths import TraceStep
    from robosc.analysis.verify.c_program import CProgram

    #: Operation on both loops. It returns False, and does nothing, if it has no meaning in their state.
    Operation = Callable[[Lockstep], bool]

PROPERTY = "loop-translation"
#: Settings of the exploration: without reactions, and with quotas that are exhausted at once.
_EXPLORED = (Settings(react_immediately=False), Settings(1, 1, resolution_ms=1))
#: Settings of the random walk. Each is used in `_PARTS` parts, which begin with `_EARLY` batches before the first tick.
_WALKED = (Settings(), Settings(0, 1), Settings(1, 2), Settings(2, 1), Settings(react_immediately=False))
_PARTS, _EARLY = 4, 3
#: Maximum number of input values of an event that are all tried. Otherwise, these are tried: all least, all middle, all
#: greatest.
_VALUES = 4
#: Maximum number of combinations of the data of all commands that are all tried.
_COMBINATIONS = 16
#: Maximum number of queries whether an event is possible. An operation makes one query for each event.
_QUESTIONS = 1_000_000
#: Maximum distance of a value near an end of an input's range.
_NEAR = 3
#: Maximum time in milliseconds that passes if no timer is known to expire.
_LONGEST = 10_000


@dataclass(frozen=True)
class LoopEffort:
    """Maximum numbers of operations (batches, ticks and the like).

    `explored` is the number for the exploration of the loop's states. `walked` is that for the random walk after it.
    Neither exceeds `_QUESTIONS` divided by the number of events.
    """

    explored: int = 60_000
    walked: int = 5_000


def explore_loop(program: CProgram, effort: LoopEffort | None = None) -> Verdict:
    """Return whether the control loop of the compiled C agrees with the one in Python.

    Both loops enter each state that the control loop reaches, and run there all operations that a node can request. If
    there are too many states, the rest is sampled. Random choices are the same on every run.
    """
    effort = effort or LoopEffort()
    most = max(_QUESTIONS // max(len(program.events), 1), 1)
    with cache_results(), program.start_command([program.follower]) as process:
        lockstep = Lockstep(program.model, process)
        try:
            seen = _explored(lockstep, min(effort.explored, most))
            walked = _walked(lockstep, min(effort.walked, most))
        except DifferenceError as error:
            return refute(PROPERTY, str(error), tuple(error.seen))
        finally:
            _end(process)
    evidence = f"{format_count(seen.states, 'state')}, {format_count(seen.operations, 'operation')}"
    if seen.complete:
        return Verdict(PROPERTY, Outcome.PROVED, evidence)
    return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, then {walked:,} at random")


def _end(process: Popen[str]) -> None:
    """Close the input of the process, unless the process has ended."""
    assert process.stdin is not None
    try:
        process.stdin.close()
    except BrokenPipeError:
        return


@dataclass
class _Seen:
    """Numbers of explored states and operations, and whether the exploration is complete."""

    states: int = 0
    operations: int = 0
    complete: bool = True


@dataclass(frozen=True)
class _SearchNode:
    """Saved state of both loops, with its predecessor."""

    saved: SavedLoops
    before: _SearchNode | None = None

    def way(self) -> list[TraceStep]:
        """Return the events from the start to this node."""
        steps: list[TraceStep] = []
        node: _SearchNode | None = self
        while node is not None:
            steps[:0] = node.saved.seen
            node = node.before
        return steps


def _explored(lockstep: Lockstep, operations: int) -> _Seen:
    """Explore all states breadth first. Each setting gets an equal share of the operations."""
    seen = _Seen()
    for part, settings in enumerate(_EXPLORED, 1):
        lockstep.begin(settings)
        lockstep.operate("b")
        _breadth_first(lockstep, seen, operations * part // len(_EXPLORED))
    return seen


def _breadth_first(lockstep: Lockstep, seen: _Seen, operations: int) -> None:
    """Explore the states from the current one; a node is the start of a batch, which has the least history."""
    tried = _operations(lockstep)
    lockstep.keep()
    pending = deque(_SearchNode(start) for start in lockstep.compare())
    reached = {_key(node.saved) for node in pending}
    while pending:
        node = pending.popleft()
        seen.states += 1
        spent = False
        for operation in tried:
            if spent := seen.operations >= operations:
                break
            lockstep.seen.clear()
            lockstep.go_back(node.saved)
            if operation(lockstep):
                seen.operations += 1
                lockstep.operate("b")
                lockstep.keep()
        try:
            successors = lockstep.compare()
        except DifferenceError as error:
            error.seen = [*node.way(), *error.seen]
            raise
        if spent:
            seen.complete = False
            return
        for saved in successors:
            if (key := _key(saved)) not in reached:
                reached.add(key)
                pending.append(_SearchNode(saved, node))


def _key(saved: SavedLoops) -> tuple[Any, ...]:
    """Return a key that is equal for equivalent states: times are relative to the current time."""
    now, up = saved.saved.timers
    times = tuple((number, until - now) for number, until in sorted(up.items()))
    return saved.saved.cells, saved.saved.rest, times, saved.first


def _operations(lockstep: Lockstep) -> list[Operation]:
    """Return the operations to try in each state.

    They are batches, ticks, settling and timers, some with a withheld event. Commands with inputs get different data.
    """
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
    whole = [_operation("be"), *map(_batch, batches), _impossible, _operation("t"), _operation("s")]
    partial = [
        *(_without(event, _operation(name)) for event in own for name in ("t", "s")),
        *(_without(number[event], batch) for event in roles.silent for batch in come),
        *timed,
    ]
    sent = _sent(lockstep)
    if not sent:
        return [*whole, *partial]
    return [
        *(_with_data(data, operation) for operation in whole for data in sent),
        *(_with_data(sent[place % len(sent)], operation) for place, operation in enumerate(partial)),
    ]


def _sent(lockstep: Lockstep) -> list[dict[int, tuple[int, ...]]]:
    """Return data of all commands with inputs, to try one after the other: all combinations if these are few.

    Otherwise, all commands have their first data, their second, and so on, and each has its own where the others have
    their first.
    """
    values = {number: _values(lockstep, number) for number in lockstep.commands}
    if not values:
        return []
    if prod(map(len, values.values())) <= _COMBINATIONS:
        return [dict(zip(values, chosen, strict=True)) for chosen in product(*values.values())]
    first = {number: codes[0] for number, codes in values.items()}
    longest = max(map(len, values.values()))
    together = [{number: codes[turn % len(codes)] for number, codes in values.items()} for turn in range(longest)]
    return together + [{**first, number: chosen} for number, codes in values.items() for chosen in codes[1:]]


def _with_data(data: Mapping[int, tuple[int, ...]], operation: Operation) -> Operation:
    """Return the operation while commands have these data."""

    def operate(both: Lockstep) -> bool:
        both.set_data(data)
        return operation(both)

    return operate


def _values(lockstep: Lockstep, event: int) -> list[tuple[int, ...]]:
    """Return codes for the inputs of an event: all, or the ends and the middle of each."""
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
    """Return an operation that performs these events if the first one is possible."""

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
    """Perform a batch of all events that are not possible."""
    both.operate("b")
    for event, name in enumerate(both.names):
        if not both.loop.enabled(name):
            both.perform(event, _values(both, event)[0])
    both.operate("e")
    return True


def _without(event: int, operation: Operation) -> Operation:
    """Return the operation while an event is withheld."""

    def operate(both: Lockstep) -> bool:
        both.withhold(event)
        done = operation(both)
        both.withhold(event)
        return done

    return operate


def _up(both: Lockstep) -> bool:
    """Let the next timer expire."""
    wait = both.loop.timers.wait
    if wait is not None:
        both.pass_time(wait)
        both.operate("x")
    return wait is not None


def _early(both: Lockstep) -> bool:
    """Let the time pass until just before the next timer expires."""
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
    """Run random operations from the start with each of the settings, and return their number."""
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
            error.seen = ()  # The walk is no shortest trace, so the events so far are not reported.
            raise
    return walk.operations


class _Walk:
    """Random operations that depend on nothing but the model and are the same on every run."""

    def __init__(self, lockstep: Lockstep) -> None:
        self.operations = 0
        self._both = lockstep
        self._random = Random(1)  # noqa: S311  # the same each time
        number = {event: place for place, event in enumerate(lockstep.events)}
        self._incoming = [number[event] for event in Roles(lockstep.model).incoming]

    def step(self) -> None:
        """Run one random operation, mostly after a change of the data of commands."""
        if self._both.commands and self._random.random() < 0.7:
            self._both.set_data(
                {
                    number: tuple(self._code(size - 1) for size in self._both.sizes(number))
                    for number in self._both.commands
                }
            )
        timed = [self._wait] * (3 * self._both.loop.timers.exist)
        batches = [self.batch] * 4
        self._random.choice((*batches, self._tick, self._settle, self._withhold, *timed))()

    def batch(self) -> None:
        """Perform a few events."""
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
        """Withhold one event, or stop withholding the current one."""
        withheld = self._both.withheld or range(len(self._both.events))
        if withheld:
            self._both.withhold(self._random.choice(withheld))

    def _wait(self) -> None:
        """Change the clock, mostly to the next timer or just before it, sometimes backwards; then expire once."""
        timers = self._both.loop.timers
        for number, duration in enumerate(self._both.model.durations):
            length = self._random.choice((duration.shortest, duration.milliseconds, duration.longest))
            self._both.set_duration(number, length)
        steps = [timers.wait or 0, (timers.wait or 0) - 1, self._random.randrange(_LONGEST), -self._random.randrange(9)]
        self._both.pass_time(self._random.choice(steps))
        self._operate("x")

    def _perform(self) -> None:
        """Perform an event, mostly one that the robot can produce now, sometimes any."""
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
