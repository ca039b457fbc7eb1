"""Controller in Python whose engine, calls and messages a scenario can see."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.run.node_tests.drive import DrivenController

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.base.ros_types import Section
    from robosc.model import rosgraph, sct
    from robosc.run.runtime.core.json_text import Json
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

    @property
    def violations(self) -> list[str]:
        """The names of the violated assumptions, once for each violation."""
        return self._violations.names

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

    def _before(self, name: str) -> bool:
        may_happen = super()._before(name)
        if not may_happen:
            self._operations.withheld(name)
        return may_happen
