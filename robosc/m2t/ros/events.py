"""What a model says of its events: why they may be forbidden, and which message a setting means."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph, sct


class Reasons:
    """The requirements on each event of a model, and what its supervisor forbids beyond them."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._required: dict[sct.Event, list[str]] = {}
        for requirement in model.requirements:
            if requirement.text:
                self._required.setdefault(requirement.event, []).append(requirement.text)
        guards = model.supervisor.guards if model.supervisor else ()
        self._prevented = {guard.event: guard.explanation for guard in guards if guard.explanation}

    def requirements(self, event: sct.Event) -> list[str]:
        """The requirements on an event."""
        return self._required.get(event, [])

    def explanation(self, event: sct.Event) -> str | None:
        """What would follow if synthesis did not forbid the event; None where it forbids nothing."""
        return self._prevented.get(event)

    def of(self, event: sct.Event) -> list[str]:
        """The requirements on an event, and what synthesis prevents by forbidding it elsewhere."""
        prevented = self.explanation(event)
        return [*self.requirements(event), *([f"synthesis prevents this: {prevented}"] if prevented else [])]


def message_named(graph: rosgraph.RosGraph, name: str) -> rosgraph.Sending | None:
    """The message that the node sends by this name, or by `Component.name`; None where there is none, or several."""
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    found = [sending for sending in sendings if name in (sending.name, sending.event.eContainer().origin)]
    return found[0] if len(found) == 1 else None
