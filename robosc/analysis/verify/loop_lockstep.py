"""The control loop in Python and the generated one, doing the same things one after the other."""

from __future__ import annotations

import signal
import sys
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING, Any

from robosc.analysis.paths import TraceStep
from robosc.analysis.verify.c_program import TEXT
from robosc.engine import ControlLoop, Hooks
from robosc.engine.state import Domain
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from subprocess import Popen

    from robosc.engine import Settings
    from robosc.engine.control_loop import SavedLoop
    from robosc.metamodel import sct

#: What an operation is called by the follower, and by us.
OPERATIONS = {
    "p": "an event",
    "b": "the start of a batch",
    "e": "the end of a batch",
    "t": "a tick",
    "s": "settling",
    "x": "the end of a time",
    "r": "starting times anew",
}
#: Where the clock starts: it soon wraps from its largest value to 0.
_START = 2**32 - 20_000
_NEVER = 2**32 - 1
#: So many characters fit into every pipe.
_PORTION = 4096


class DifferenceError(Exception):
    """The loops did different things, as the message says; `seen` is what happened before."""

    def __init__(self, message: str, seen: Sequence[TraceStep]) -> None:
        super().__init__(message)
        self.seen = seen


@dataclass(frozen=True)
class Kept:
    """Both loops as they were, and what was `seen` until then.

    The generated one has a number; another that is like it but for the time of the clock is the first of its kind.
    """

    saved: SavedLoop
    number: int
    first: int
    seen: tuple[TraceStep, ...]


@dataclass(frozen=True)
class _Noted:
    """The operations, what the Python loop said in them, and how it is then."""

    script: str
    said: list[str]
    saved: SavedLoop
    seen: tuple[TraceStep, ...]


class Lockstep:
    """Both loops of one model. Events are told by their number, in the order of the model, data by codes.

    `operate`, `perform`, `withhold`, `pass_time` and the like are done by the Python loop at once, `keep` notes how it
    is then. `compare` lets the generated one do all of that, too, and raises DifferenceError where it did something
    else. Whoever compares after many operations waits for the other process once.
    """

    def __init__(self, model: sct.SupervisoryControlModel, follower: Popen[str]) -> None:
        self.model = model
        self.names = [event_name(event) for plant in model.plants for event in plant.events]
        self.events = [event for plant in model.plants for event in plant.events]
        inputs = [parameter for plant in model.plants for parameter in plant.inputs]
        self._inputs = {parameter: (number, Domain(parameter.type)) for number, parameter in enumerate(inputs)}
        self._numbers = {name: number for number, name in enumerate(self.names)}
        self._follower = follower
        self._script: list[str] = []
        self._said: list[str] = []
        self._noted: list[_Noted] = []
        self._happened: list[str] = []
        #: What is told of each state that was seen.
        self._codes: dict[tuple[int, ...], str] = {}
        self._withheld: set[str] = set()
        #: What happened since whoever reads this cleared it.
        self.seen: list[TraceStep] = []
        #: The event that is performed, and with which data.
        self._performed: tuple[str, Mapping[str, Any]] = ("", {})

    def begin(self, settings: Settings) -> None:
        """Both begin anew."""
        self._withheld.clear()
        hooks = Hooks(lambda event: event not in self._withheld, self._after, lambda: self._happened.append("!"))
        self.loop = ControlLoop(self.model, settings, hooks)
        self.loop.timers.at(_START)
        self.loop.timers.restart()
        numbers = (settings.events_per_tick, settings.reactions_per_tick, int(settings.react_immediately))
        self._script.append(f"n {' '.join(map(str, numbers))} {settings.resolution_ms} {_START}")

    def _after(self, event: str) -> None:
        self._happened.append(str(self._numbers[event]))
        performed, data = self._performed
        self.seen.append(TraceStep(event, data if event == performed else {}))

    def operate(self, operation: str) -> None:
        """One of the operations that take nothing."""
        self._script.append(operation)
        result = False
        match operation:
            case "b":
                self.loop.begin()
            case "e":
                self.loop.end()
            case "t":
                self.loop.tick()
            case "s":
                self.loop.settle()
            case "x":
                result = self.loop.expire() is not None
            case "r":
                self.loop.timers.restart()
        self._say(operation, result)

    def sizes(self, number: int) -> list[int]:
        """How many values each input of an event has."""
        return [domain.high - domain.low + 1 for domain in self._domains(number)]

    def _domains(self, number: int) -> list[Domain]:
        return [self._inputs[parameter][1] for parameter in self.events[number].inputs]

    def perform(self, number: int, codes: tuple[int, ...]) -> None:
        """Performs an event, with a code for each of its inputs."""
        data = {}
        for parameter, code in zip(self.events[number].inputs, codes, strict=True):
            place, domain = self._inputs[parameter]
            data[parameter.name] = domain.shown(domain.low + code)
            self._script.append(f"i {place} {code}")
        self._script.append(f"p {number}")
        self._performed = self.names[number], data
        result = self.loop.perform(self.names[number], data)
        self._performed = "", {}
        self._say("p", result)

    def withhold(self, number: int) -> None:
        """Withholds an event, or, where it is withheld, no longer."""
        self._withheld ^= {self.names[number]}
        self._script.append(f"w {number}")

    @property
    def withheld(self) -> list[int]:
        """The numbers of the events that are withheld."""
        return sorted(self._numbers[name] for name in self._withheld)

    def set_duration(self, number: int, milliseconds: int) -> None:
        """How long a time lasts that is set on the robot."""
        self.loop.timers.set_duration(self.model.durations[number], milliseconds)
        self._script.append(f"d {number} {milliseconds}")

    def pass_time(self, milliseconds: int) -> None:
        """Lets so much time go by, or go back."""
        timers = self.loop.timers
        timers.at(timers.now + milliseconds)
        self._script.append(f"c {timers.now % 2**32}")

    def go_back(self, kept: Kept) -> None:
        """Both are as they were when this was kept."""
        self.loop.restore(kept.saved)
        self._script.append(f"g {kept.number}")

    def keep(self) -> None:
        """Both keep how they are, to `go_back` there."""
        self._script.append("k")
        self._noted.append(_Noted("\n".join([*self._script, ""]), self._said, self.loop.saved, tuple(self.seen)))
        self._script, self._said = [], []

    def compare(self) -> list[Kept]:
        """Lets the generated loop do what the Python one did; says what was kept since the last comparison."""
        noted, self._noted = self._noted, []
        kept: list[Kept] = []
        while len(kept) < len(noted):
            kept += self._compared(noted[len(kept) :])
        return kept

    def _compared(self, noted: Sequence[_Noted]) -> list[Kept]:
        """The first of these, as many as the pipe takes at once: nobody reads there while we write."""
        pipe, answers = self._follower.stdin, self._follower.stdout
        assert pipe is not None
        assert answers is not None
        lengths = accumulate(len(operations.script) for operations in noted)
        portion = noted[: max(sum(length <= _PORTION for length in lengths), 1)]
        try:
            pipe.write("".join(operations.script for operations in portion))
            pipe.flush()
        except BrokenPipeError:
            pass  # What it has said tells how far it came.
        kept = []
        for operations in portion:
            answer = answers.readline()
            if not answer:
                raise DifferenceError(self._end(operations.said), operations.seen)
            *theirs, numbers = answer.split(";")
            for our_answer, their_answer in zip(operations.said, theirs, strict=True):
                if our_answer != their_answer:
                    raise DifferenceError(self._difference(our_answer, their_answer), operations.seen)
            number, first = map(int, numbers.split())
            kept.append(Kept(operations.saved, number, first, operations.seen))
        return kept

    def _say(self, operation: str, result: bool) -> None:
        state = self.loop.state
        codes = self._codes.get(state.cells)
        if codes is None:
            values = zip(state.cells, state.layout.domains, strict=True)
            codes = self._codes[state.cells] = "".join(f" {value - domain.low}" for value, domain in values)
        said = [operation, *self._happened, "= 1" if result else "= 0"]
        if self.loop.timers.exist:
            wait = self.loop.timers.wait
            said.append(str(_NEVER if wait is None else wait))
        self._said.append(" ".join(said) + codes)
        self._happened.clear()

    def _difference(self, ours: str, theirs: str) -> str:
        events = [", ".join(self._told(line)) or "nothing happens" for line in (theirs, ours)]
        if events[0] == events[1]:
            events = ["the state is another one, or the time of the next call", "not"]
        where = OPERATIONS.get(ours[0], "")
        return f"in the control loop of {TEXT}, at {where}: {events[0]}; in that of the model: {events[1]}"

    def _told(self, line: str) -> list[str]:
        words = line.partition("=")[0].split()[1:]
        known = (word.isdigit() and int(word) < len(self.names) for word in words)
        return [
            f"`{self.names[int(word)]}`" if is_event else "a livelock" if word == "!" else "an event of another number"
            for word, is_event in zip(words, known, strict=True)
        ]

    def _end(self, said: Sequence[str]) -> str:
        status = self._follower.wait()
        endless = sys.platform != "win32" and status == -signal.SIGALRM
        how = "does not come to an end" if endless else f"ends with status {status}"
        where = ", ".join(OPERATIONS[line[0]] for line in said) or "the start"
        return f"the control loop of {TEXT} {how}, at one of these: {where}"
