"""Controller in Python whose engine, calls and messages a scenario can see."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from robosc.model.semantics.roles import assumption_name
from robosc.run.node_tests.drive import DrivenController
from robosc.run.runtime.core.violations import ViolationError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.base.ros_types import Section
    from robosc.model import rosgraph, sct
    from robosc.model.semantics.operators import UnreadableError
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Message
    from robosc.run.scenario_tests.operations import Operations


class ScenarioController(DrivenController):
    """Controller with access to its engine, calls and messages."""

    @property
    def engine(self) -> Any:
        """The engine of the supervised system."""
        return self._control.engine

    def type_of(self, event: sct.Event) -> tuple[rosgraph.Interface, Section]:
        """Return the type of the data that a command sends."""
        sender = self._senders[event]
        return sender.interface, sender.section

    @cached_property
    def violations(self) -> list[str]:
        """The names of the violated assumptions, once for each violation."""
        return []

    def note(self, operations: Operations) -> None:
        """Record the calls of the control loop from now on."""
        self._operations = operations
        operations.attach(self._control)

    def keep_messages(self, lines_so_far: Callable[[], int]) -> None:
        """Keep the messages sent from now on in `messages`, by the position of their line in the log."""
        self._lines_so_far = lines_so_far
        self.messages: dict[int, Any] = {}

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        acted = super()._act(event)
        if event in self._senders:
            self.messages[self._lines_so_far()] = self._senders[event].message
        return acted

    def _perform(
        self,
        event: sct.Event,
        inputs: Sequence[rosgraph.InputAssignment] = (),
        message: Message = None,
        source: sct.Event | None = None,
    ) -> UnreadableError | None:
        fault = super()._perform(event, inputs, message, source)
        if isinstance(fault, ViolationError):
            self.violations += map(assumption_name, fault.assumptions)
        return fault

    def _before(self, name: str) -> bool:
        may_happen = super()._before(name)
        if not may_happen:
            self._operations.withheld(name)
        return may_happen
