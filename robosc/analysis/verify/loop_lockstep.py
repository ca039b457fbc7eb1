"""Control loops in Python and in generated code that perform the same operations."""

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
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from subprocess import Popen

    from robosc.engine import Settings
    from robosc.engine.control_loop import SavedLoop
    from robosc.model import sct

#: Operations by their letter in the follower's protocol, with their names in messages.
OPERATIONS = {
    "p": "an event",
    "b": "the start of a batch",
    "e": "the end of a batch",
    "t": "a tick",
    "s": "settling",
    "x": "the end of a time",
    "r": "restarting times",
}
#: Start of the clock: it soon wraps from its largest value to 0.
_START = 2**32 - 20_000
_NEVER = 2**32 - 1
#: Number of characters that every pipe holds.
_PORTION = 4096


class DifferenceError(Exception):
    """The loops behaved differently, as the message explains; `seen` are the events before that."""

    def __init__(self, message: str, seen: Sequence[TraceStep]) -> None:
        super().__init__(message)
        self.seen = seen


@dataclass(frozen=True)
class SavedLoops:
    """Saved state of both loops, with the events `seen` until then.

    `number` identifies the state of the generated loop. `first` is the number of the first state that equals it except
    for the clock.
    """

    saved: SavedLoop
    number: int
    first: int
    seen: tuple[TraceStep, ...]


@dataclass(frozen=True)
class _Noted:
    """Script of operations, output of the Python loop for them, and its state afterwards."""

    script: str
    output: list[str]
    saved: SavedLoop
    seen: tuple[TraceStep, ...]


class Lockstep:
    """Both loops of one model. Events are identified by number in the order of the model, data by codes.

    The Python loop performs `operate`, `perform`, `withhold`, `pass_time` and the like at once; `keep` records its
    state. `compare` makes the generated loop do the same, and raises DifferenceError if the results differ. Compare
    after many operations: each comparison waits for the other process once.
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
        self._output: list[str] = []
        self._noted: list[_Noted] = []
        self._happened: list[str] = []
        #: Text of the codes of each state so far.
        self._codes: dict[tuple[int, ...], str] = {}
        self._withheld: set[str] = set()
        #: Numbers of the commands with inputs.
        self.commands = [number for number, event in enumerate(self.events) if event.controllable and event.inputs]
        #: Data of these commands, which both callers set right before a command.
        self._data: dict[str, Mapping[str, Any]] = {}
        #: Events since the caller last cleared the list.
        self.seen: list[TraceStep] = []
        #: Event that is being performed, with its data.
        self._performed: tuple[str, Mapping[str, Any]] = ("", {})

    def begin(self, settings: Settings) -> None:
        """Start both loops again."""
        self._withheld.clear()
        hooks = Hooks(self._before, self._after, lambda: self._happened.append("!"))
        self.loop = ControlLoop(self.model, settings, hooks)
        self.loop.timers.at(_START)
        self.loop.timers.restart()
        numbers = (settings.events_per_tick, settings.reactions_per_tick, int(settings.react_immediately))
        self._script.append(f"n {' '.join(map(str, numbers))} {settings.resolution_ms} {_START}")
        self.set_data({number: tuple(0 for _ in self.sizes(number)) for number in self.commands})

    def _before(self, event: str) -> bool:
        if event in self._withheld:
            return False
        if event in self._data:
            self.loop.engine.set_inputs(event, self._data[event])
        return True

    def _after(self, event: str) -> None:
        self._happened.append(str(self._numbers[event]))
        performed, data = self._performed
        self.seen.append(TraceStep(event, self._data.get(event, data if event == performed else {})))

    def operate(self, operation: str) -> None:
        """Run an operation without arguments."""
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
        """Return the number of values of each input of an event."""
        return [domain.high - domain.low + 1 for domain in self._domains(number)]

    def _domains(self, number: int) -> list[Domain]:
        return [self._inputs[parameter][1] for parameter in self.events[number].inputs]

    def perform(self, number: int, codes: tuple[int, ...]) -> None:
        """Perform an event, with a code for each of its inputs."""
        data = self._values(number, codes)
        for parameter, code in zip(self.events[number].inputs, codes, strict=True):
            self._script.append(f"i {self._inputs[parameter][0]} {code}")
        self._script.append(f"p {number}")
        self._performed = self.names[number], data
        result = self.loop.perform(self.names[number], data)
        self._performed = "", {}
        self._say("p", result)

    def _values(self, number: int, codes: tuple[int, ...]) -> dict[str, Any]:
        """Return the values of an event's inputs by their names."""
        return {
            parameter.name: domain.external(domain.low + code)
            for parameter, domain, code in zip(self.events[number].inputs, self._domains(number), codes, strict=True)
        }

    def set_data(self, data: Mapping[int, tuple[int, ...]]) -> None:
        """Set the data of commands from now on, with a code for each of their inputs."""
        for number, codes in data.items():
            self._data[self.names[number]] = self._values(number, codes)
            for parameter, code in zip(self.events[number].inputs, codes, strict=True):
                self._script.append(f"v {number} {self._inputs[parameter][0]} {code}")

    def withhold(self, number: int) -> None:
        """Withhold an event, or stop withholding it."""
        self._withheld ^= {self.names[number]}
        self._script.append(f"w {number}")

    @property
    def withheld(self) -> list[int]:
        """Numbers of the withheld events."""
        return sorted(self._numbers[name] for name in self._withheld)

    def set_duration(self, number: int, milliseconds: int) -> None:
        """Set a duration that the robot configures."""
        self.loop.timers.set_duration(self.model.durations[number], milliseconds)
        self._script.append(f"d {number} {milliseconds}")

    def pass_time(self, milliseconds: int) -> None:
        """Advance the clock, or turn it back if `milliseconds` is negative."""
        timers = self.loop.timers
        timers.at(timers.now + milliseconds)
        self._script.append(f"c {timers.now % 2**32}")

    def go_back(self, saved: SavedLoops) -> None:
        """Restore both loops to a saved state."""
        self.loop.restore(saved.saved)
        self._script.append(f"g {saved.number}")

    def keep(self) -> None:
        """Save the state of both loops for `go_back`."""
        self._script.append("k")
        self._noted.append(_Noted("\n".join([*self._script, ""]), self._output, self.loop.saved, tuple(self.seen)))
        self._script, self._output = [], []

    def compare(self) -> list[SavedLoops]:
        """Run the generated loop, compare it with the Python loop, and return the states saved since the last time."""
        noted, self._noted = self._noted, []
        states: list[SavedLoops] = []
        while len(states) < len(noted):
            states += self._compared(noted[len(states) :])
        return states

    def _compared(self, noted: Sequence[_Noted]) -> list[SavedLoops]:
        """Compare as many of the first operations as fit into the pipe.

        Neither process reads while we write, so a larger text would block both.
        """
        pipe, answers = self._follower.stdin, self._follower.stdout
        assert pipe is not None
        assert answers is not None
        lengths = accumulate(len(operations.script) for operations in noted)
        portion = noted[: max(sum(length <= _PORTION for length in lengths), 1)]
        try:
            pipe.write("".join(operations.script for operations in portion))
            pipe.flush()
        except BrokenPipeError:
            pass  # Its output shows the last operation that it completed.
        states = []
        for operations in portion:
            answer = answers.readline()
            if not answer:
                raise DifferenceError(self._end(operations.output), operations.seen)
            *theirs, numbers = answer.split(";")
            for our_answer, their_answer in zip(operations.output, theirs, strict=True):
                if our_answer != their_answer:
                    raise DifferenceError(self._difference(our_answer, their_answer), operations.seen)
            number, first = map(int, numbers.split())
            states.append(SavedLoops(operations.saved, number, first, operations.seen))
        return states

    def _say(self, operation: str, result: bool) -> None:
        state = self.loop.state
        codes = self._codes.get(state.cells)
        if codes is None:
            values = zip(state.cells, state.layout.domains, strict=True)
            codes = self._codes[state.cells] = "".join(f" {value - domain.low}" for value, domain in values)
        words = [operation, *self._happened, "= 1" if result else "= 0"]
        if self.loop.timers.exist:
            wait = self.loop.timers.wait
            words.append(str(_NEVER if wait is None else wait))
        self._output.append(" ".join(words) + codes)
        self._happened.clear()

    def _difference(self, ours: str, theirs: str) -> str:
        events = [", ".join(self._answer(line)) or "nothing happens" for line in (theirs, ours)]
        if events[0] == events[1]:
            events = ["the state is another one, or the time of the next call", "not"]
        where = OPERATIONS.get(ours[0], "")
        return f"in the control loop of {TEXT}, at {where}: {events[0]}; in that of the model: {events[1]}"

    def _answer(self, line: str) -> list[str]:
        words = line.partition("=")[0].split()[1:]
        known = (word.isdigit() and int(word) < len(self.names) for word in words)
        return [
            f"`{self.names[int(word)]}`" if is_event else "a livelock" if word == "!" else "an event of another number"
            for word, is_event in zip(words, known, strict=True)
        ]

    def _end(self, lines: Sequence[str]) -> str:
        status = self._follower.wait()
        endless = sys.platform != "win32" and status == -signal.SIGALRM
        how = "does not come to an end" if endless else f"ends with status {status}"
        where = ", ".join(OPERATIONS[line[0]] for line in lines) or "the start"
        return f"the control loop of {TEXT} {how}, at one of these: {where}"
