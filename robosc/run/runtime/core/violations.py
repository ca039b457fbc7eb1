"""Violations of assumptions: events that the robot causes although an assumption excludes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import assumption_name, assumption_text, assumptions, component_name, event_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.engine import Engine
    from robosc.model import sct


class ViolationError(UnreadableError):
    """Event against assumptions. It counts as an event whose data cannot be read."""

    def __init__(self, assumptions: Sequence[sct.Plant]) -> None:
        super().__init__(f"violates `{'` and `'.join(map(assumption_text, assumptions))}`")
        self.assumptions = assumptions


class Violations:
    """Violations since the node started; `stop`: the first one stops the robot.

    `assumptions` are the violated ones, in the order of their first violation.
    """

    def __init__(self, engine: Engine, *, stop: bool) -> None:
        self._engine = engine
        self.stop = stop
        self.exist = bool(assumptions(engine.model))
        self.assumptions: dict[sct.Plant, None] = {}
        self._by_component: dict[str, dict[sct.Plant, None]] = {}
        self._halted = False

    def check(self, event: sct.Event) -> ViolationError | None:
        """Return the violation of an event that is about to happen; None if no assumption excludes it."""
        violated = self._engine.violated_assumptions(event_name(event)) if self.exist else []
        if not violated:
            return None
        known = self._by_component.setdefault(component_name(event), {})
        for assumption in violated:
            self.assumptions[assumption] = known[assumption] = None
        return ViolationError(violated)

    @property
    def stopped(self) -> bool:
        """Whether a violation has stopped the robot."""
        return self.stop and bool(self.assumptions)

    def take_halt(self) -> bool:
        """Return whether to stop the robot now. The answer is positive once, after the first violation."""
        halted, self._halted = self._halted, self.stopped
        return self._halted and not halted

    def of(self, component: str) -> list[str]:
        """Return the names of the assumptions that events of a component have violated."""
        return list(map(assumption_name, self._by_component.get(component, ())))
