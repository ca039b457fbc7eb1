"""A random walk of the control loop in Python, as a script for the generated engine with the expected output."""

from random import Random

from robosc.engine import ControlLoop, Hooks, Settings
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.domains import domain


class Walk:
    """Random operations; each extends `script` and `said`."""

    def __init__(self, model: sct.SupervisoryControlModel, settings: Settings, seed: int, start: int = 0) -> None:
        """`start` is the initial value of the 32-bit clock, in models with timers."""
        self._start = start
        self.random = Random(seed)  # noqa: S311
        self.script: list[str] = []
        self.said: list[str] = []
        self._happened: list[str] = []
        self._withheld: set[str] = set()
        self.loop = ControlLoop(
            model,
            settings,
            Hooks(lambda event: event not in self._withheld, self._happened.append, self._livelock),
        )
        roles = self.loop.engine.roles
        #: Events in the order of the header.
        data = (event for events in roles.data for event in events)
        order = (*roles.cancels, *roles.triggers, *roles.silent, *data, *roles.incoming, *roles.timeouts)
        self._events = [f"{event.eContainer().name}.{event.name}" for event in order]
        self._by_name = dict(zip(self._events, order, strict=True))
        self._inputs = {
            carried: number
            for number, carried in enumerate(carried for plant in model.plants for carried in plant.inputs)
        }

    def steps(self, number: int) -> None:
        for _ in range(number):
            kinds = ("perform", "perform", "batch", "batch", "batch", "tick", "tick", "settle", "withhold")
            timed = ("wait", "wait", "wait") if self.loop.engine.executed.timers else ()
            kind = self.random.choice((*kinds, *timed))
            getattr(self, kind)()

    def perform(self) -> None:
        possible = [event for event in self._events if self.loop.enabled(event)]
        event = self.random.choice(possible if possible and self.random.random() < 0.8 else self._events)
        data = {}
        for input_ in self._by_name[event].inputs:
            value, number = self._value(input_.type)
            data[input_.name] = value
            self.script.append(f"input {self._inputs[input_]} {number}")
        self.script.append(f"perform {event}")
        self._say("perform", self.loop.perform(event, data))

    def batch(self) -> None:
        self._operate("begin")
        for _ in range(self.random.randint(0, 3)):
            self.perform()
        self._operate("end")

    def wait(self) -> None:
        """Advance the clock, often to the next expiry, and occasionally backward."""
        timers = self.loop.timers
        left = timers.wait or 0
        step = self.random.choice((left, left, left - 1, self.random.randint(0, 3000), -self.random.randint(0, 20)))
        timers.at(timers.now + step)
        self.script.append(f"now {(self._start + timers.now) % 2**32}")
        self.script.append("expire")
        self._say("expire", self.loop.expire() is not None)

    def tick(self) -> None:
        self._operate("tick")

    def settle(self) -> None:
        self._operate("settle")

    def withhold(self) -> None:
        event = self.random.choice(self._events)
        self._withheld ^= {event}
        self.script.append(f"withhold {event}")

    def _operate(self, operation: str) -> None:
        self.script.append(operation)
        getattr(self.loop, operation)()
        self._say(operation, False)

    def _livelock(self) -> None:
        self._happened.append("livelock!")

    def _say(self, operation: str, result: bool) -> None:
        values = [int(value) if isinstance(value, bool) else value for value in self.loop.state.values()]
        enabled = [event for event in self._events if self.loop.enabled(event)]
        timers = self.loop.timers
        wait = 2**32 - 1 if timers.wait is None else timers.wait
        waits = [f"{wait};"] if self.loop.engine.executed.timers else []
        parts = (f"{operation}:", *self._happened, f"= {int(result)};", *waits, *values)
        self.said.append(" ".join(map(str, parts)) + ";" + "".join(f" {number}" for number in enabled))
        self._happened.clear()

    def _value(self, kind: ex.Type) -> tuple[bool | int | str, int]:
        match kind:
            case ex.BooleanType():
                value = self.random.random() < 0.5
                return value, int(value)
            case ex.EnumerationType():
                low, high = domain(kind)
                literal = self.random.choice(list(kind.enumeration.literals)[low : high + 1])
                return literal.name, kind.enumeration.literals.index(literal)
        number = self.random.randint(kind.minimum, kind.maximum)
        return number, number
