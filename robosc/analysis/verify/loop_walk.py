"""A walk of the control loop in Python, as a script for the generated one and with what that is to say."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from robosc.engine import ControlLoop, Hooks, Settings
from robosc.engine.state import Domain
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import sct

#: So often each is tried, in a part of the walk of its own, which begins with some messages before the first tick.
_PARTS, _EARLY = 4, 3
_SETTINGS = (Settings(), Settings(0, 1), Settings(1, 2), Settings(2, 1), Settings(react_immediately=False))
#: So many values are near an end of an input's range.
_NEAR = 3
#: So many milliseconds go by at most where it is not known when something is up.
_LONGEST = 10_000
_OPERATIONS = {
    "b": "the start of a batch",
    "e": "the end of a batch",
    "t": "a tick",
    "s": "settling",
    "x": "the end of a time",
}


class LoopWalk:
    """Random operations of the control loop, the same ones each time; nothing else than the model decides on them.

    Events, inputs and cells are told as their position in the model, values as their code. `script` is what `follow`
    in the explorer reads; `said` has what it is to say of each operation: a letter, what happened (`!`: a livelock),
    whether the event did, in models with times when the next is up, and the state after it.
    """

    def __init__(self, model: sct.SupervisoryControlModel, operations: int) -> None:
        self.script: list[str] = []
        self.said: list[str] = []
        self._random = Random(1)  # noqa: S311  # the same each time
        self._model = model
        self._names = [event_name(event) for plant in model.plants for event in plant.events]
        self._events = [event for plant in model.plants for event in plant.events]
        self._incoming: list[int] = []
        inputs = [parameter for plant in model.plants for parameter in plant.inputs]
        self._inputs = {parameter: (number, Domain(parameter.type)) for number, parameter in enumerate(inputs)}
        numbers = {name: number for number, name in enumerate(self._names)}
        parts = _SETTINGS * _PARTS
        for part, settings in enumerate(parts, 1):
            self._begin(settings, numbers)
            for _ in range(_EARLY):
                self._batch()
            while len(self.said) * len(parts) < operations * part:
                timed = [self._wait] * (3 * bool(self._loop.engine.executed.timers))
                batches = [self._batch] * 4
                self._random.choice((*batches, self._tick, self._settle, self._withhold, *timed))()

    def _begin(self, settings: Settings, numbers: dict[str, int]) -> None:
        self._happened: list[str] = []
        self._withheld: set[str] = set()
        hooks = Hooks(
            lambda event: event not in self._withheld,
            lambda event: self._happened.append(str(numbers[event])),
            lambda: self._happened.append("!"),
        )
        self._loop = ControlLoop(self._model, settings, hooks)
        self._incoming = [numbers[event_name(event)] for event in self._loop.engine.roles.incoming]
        react = int(settings.react_immediately)
        self.script.append(f"n {settings.events_per_tick} {settings.reactions_per_tick} {react}")

    def _batch(self) -> None:
        self._operate("b")
        for _ in range(self._random.randrange(4)):
            self._perform()
        self._operate("e")

    def _tick(self) -> None:
        self._operate("t")

    def _settle(self) -> None:
        self._operate("s")

    def _withhold(self) -> None:
        """Withholds one event, or the one that is withheld no longer."""
        withheld = sorted(self._withheld) or self._names
        if withheld:
            name = self._random.choice(withheld)
            self._withheld ^= {name}
            self.script.append(f"w {self._names.index(name)}")

    def _wait(self) -> None:
        """Lets time go by, mostly until something is up or nearly so, and now and then backwards; then asks once."""
        timers = self._loop.timers
        for number, duration in enumerate(self._model.durations):
            length = self._random.choice((duration.shortest, duration.milliseconds, duration.longest))
            timers.set_duration(duration, length)
            self.script.append(f"d {number} {length}")
        steps = [timers.wait or 0, (timers.wait or 0) - 1, self._random.randrange(_LONGEST), -self._random.randrange(9)]
        timers.at(max(timers.now + self._random.choice(steps), 0))
        self.script.append(f"c {timers.now % 2**32}")
        self.script.append("x")
        self._say("x", self._loop.expire() is not None)

    def _perform(self) -> None:
        """Mostly something that the robot can do now, now and then anything."""
        possible = [number for number in self._incoming if self._loop.enabled(self._names[number])]
        if not possible or self._random.random() < 0.1:
            possible = list(range(len(self._events)))
        if possible:
            number = self._random.choice(possible)
            data = {}
            for parameter in self._events[number].inputs:
                place, domain = self._inputs[parameter]
                code = self._code(domain.high - domain.low)
                data[parameter.name] = domain.shown(domain.low + code)
                self.script.append(f"i {place} {code}")
            self.script.append(f"p {number}")
            self._say("p", self._loop.perform(self._names[number], data))

    def _code(self, last: int) -> int:
        near = min(last, _NEAR)
        low, high = self._random.choice(((0, near), (last - near, last), (0, last), (0, last)))
        return self._random.randint(low, high)

    def _operate(self, operation: str) -> None:
        self.script.append(operation)
        {"b": self._loop.begin, "e": self._loop.end, "t": self._loop.tick, "s": self._loop.settle}[operation]()
        self._say(operation, False)

    def _say(self, operation: str, result: bool) -> None:
        state = self._loop.state
        codes = (value - domain.low for value, domain in zip(state.cells, state.layout.domains, strict=True))
        timers = self._loop.timers
        wait = [2**32 - 1 if timers.wait is None else timers.wait] * timers.exist
        self.said.append(" ".join(map(str, (operation, *self._happened, "=", int(result), *wait, *codes))))
        self._happened.clear()

    def difference(self, theirs: list[str], text: str) -> str | None:
        """What is different in what the generated loop says, if anything."""
        for number, ours in enumerate(self.said):
            told = theirs[number] if number < len(theirs) else ""
            if told != ours:
                at = _OPERATIONS.get(ours[0], "an event")
                events = [", ".join(self._told(line)) or "nothing happens" for line in (told, ours)]
                if events[0] == events[1]:
                    events = ["the state is another one, or the time of the next call", "not"]
                return f"in the control loop of {text}, at {at}: {events[0]}; in that of the model: {events[1]}"
        return None

    def _told(self, line: str) -> Iterator[str]:
        for word in line.partition("=")[0].split()[1:]:
            known = word.isdigit() and int(word) < len(self._names)
            yield f"`{self._names[int(word)]}`" if known else "a livelock"
