"""Rule `unnamed-answer` on services and actions that the controller serves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.commands import events_of
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import ENDING_ANSWERS, SERVED, port_event_of, provided_event, sending_event
from robosc.model.semantics.naming import escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model import expression as ex
    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.instances import Instance

    _Use = tuple[ex.Located, rsc.CommunicationReference, PortEvent | None, Instance | None]


@rule("unnamed-answer")
def unnamed_answer(base: rsc.Base) -> Iterator[Finding]:
    """Each statement on an answer of the controller is about one that a transition of the robot names."""
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    reported = set()
    for element, reference, row, within in _uses(base):
        port = known.port(reference, within)
        if port is None or row is None or not isinstance(port.communication, SERVED) or element in reported:
            continue
        possible = known.possible_events(port)
        # Every end of a goal has the data of the response.
        is_data = isinstance(element.eContainer(), rsc.ProvideStatement) and row.kind in ENDING_ANSWERS
        if row not in possible and not (is_data and any(other.kind in ENDING_ANSWERS for other in possible)):
            reported.add(element)
            named = f"{row.name} {row.preposition} {escape_keyword(port.communication.name)}"
            yield Finding(
                element,
                f"`{named}` never happens: no transition of the robot names it",
                f"write `on {named}` in a state of a component, or leave this out",
            )


def _uses(base: rsc.Robot) -> Iterator[_Use]:
    """Yield each event that a statement names, with its place and the instance whose text contains it."""
    known = instances(base)
    for required in known.statements(rsc.CommunicationRequirement):
        for reference in required.element.target.communicationTypes if required.element.target else ():
            yield reference, reference, sending_event(reference.communicationType), required.within
    for provided in known.statements(rsc.ProvideStatement):
        named = provided.element.communicationType
        if named is not None:
            yield named, named, provided_event(provided.element), provided.within
    for statement in known.statements(rsc.StatedDefinition):
        for event in _named(statement.element):
            if event.communicationType is not None:
                yield event, event.communicationType, port_event_of(event), statement.within


def _named(statement: rsc.StatedDefinition) -> list[rsc.EventReference]:
    """Return the events that an order, a count, a requirement automaton or an assumption names."""
    if isinstance(statement, rsc.Assumption):
        return list(statement.target.events) if statement.target else []
    return events_of(statement) if isinstance(statement, rsc.Requirement) else []
