"""Record of a controller's calls of its control loop, to repeat them with the generated loop."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.loop_lockstep import DifferenceError, Lockstep
from robosc.base.diagnostics import Span
from robosc.engine.state import Domain
from robosc.run.scenario_tests.reading import Line

if TYPE_CHECKING:
    from robosc.analysis.verify.c_program import CProgram
    from robosc.base.diagnostics import Diagnostic
    from robosc.engine import ControlLoop, Settings

#: Calls of a loop without arguments, with their names in the follower.
_CALLS = {"begin": "b", "end": "e", "tick": "t", "expire": "x"}


@dataclass
class _Operation:
    name: str
    line: Line
    now: int
    arguments: tuple[Any, ...] = ()
    withheld: set[str] = field(default_factory=set)


class Operations:
    """Calls of one control loop, each with the line of the scenario that caused it."""

    def __init__(self) -> None:
        self.line = Line("", Span(1, 1, 1, 1))
        self._operations: list[_Operation] = []
        self._depth = 0

    def attach(self, loop: ControlLoop) -> None:
        """Record the calls of a loop from now on, without those that a call makes itself."""
        self._settings: Settings = loop.settings
        for name in (*_CALLS, "perform"):
            self._note(loop, name, loop)
        self._note(loop.timers, "restart", loop)

    def _note(self, owner: Any, name: str, loop: ControlLoop) -> None:
        call = getattr(owner, name)

        def noted(*arguments: Any) -> Any:
            if self._depth == 0:
                self._operations.append(_Operation(name, self.line, loop.timers.now, arguments))
            self._depth += 1
            try:
                return call(*arguments)
            finally:
                self._depth -= 1

        setattr(owner, name, noted)

    def withheld(self, event: str) -> None:
        """Record that an event is withheld in the present call."""
        if self._operations:
            self._operations[-1].withheld.add(event)

    def compare(self, program: CProgram) -> Diagnostic | None:
        """Return a finding for the first call after which the generated loop differs, else None."""
        with program.start_command([program.follower]) as process:
            lockstep = Lockstep(program.model, process)
            lockstep.begin(self._settings)
            began = lockstep.loop.timers.now
            for operation in self._operations:
                passed = began + operation.now - lockstep.loop.timers.now
                if passed and lockstep.loop.timers.exist:
                    lockstep.pass_time(passed)
                for number in lockstep.withheld:
                    if lockstep.names[number] not in operation.withheld:
                        lockstep.withhold(number)
                for name in sorted(operation.withheld):
                    number = lockstep.names.index(name)
                    if number not in lockstep.withheld:
                        lockstep.withhold(number)
                self._repeat(lockstep, operation)
                lockstep.keep()
                try:
                    lockstep.compare()
                except DifferenceError as error:
                    return operation.line.fault(f"{error}")
        return None

    @staticmethod
    def _repeat(lockstep: Lockstep, operation: _Operation) -> None:
        if operation.name == "perform":
            event, *data = operation.arguments
            number = lockstep.names.index(event)
            values = data[0] or {} if data else {}
            domains = [(parameter.name, Domain(parameter.type)) for parameter in lockstep.events[number].inputs]
            codes = (domain.internal(values[name]) - domain.low if name in values else 0 for name, domain in domains)
            lockstep.perform(number, tuple(codes))
        else:
            lockstep.operate({**_CALLS, "restart": "r"}[operation.name])
