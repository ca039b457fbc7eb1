"""Why events may be forbidden, in the words of the robot's model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import sct


class Reasons:
    """What stands in a model about each of its events."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._required: dict[sct.Event, list[str]] = {}
        for each in model.requirements:
            if each.text:
                self._required.setdefault(each.event, []).append(each.text)
        guards = model.supervisor.guards if model.supervisor else ()
        self._prevented = {each.event: each.explanation for each in guards if each.explanation}

    def requirements(self, event: sct.Event) -> list[str]:
        """The requirements on an event."""
        return self._required.get(event, [])

    def of(self, event: sct.Event) -> list[str]:
        """The requirements on an event, and what synthesis prevents by forbidding it elsewhere."""
        prevented = self._prevented.get(event)
        return [*self.requirements(event), *([f"synthesis prevents this: {prevented}"] if prevented else [])]
