"""Requirements on commands, and places of findings about the instances of a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.model import robosc as rsc
from robosc.model.semantics.communication import port_event_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model import expression as ex
    from robosc.model.semantics.instances import Instance, Instances, PortInstance, Statement


class Places:
    """Places of findings about instances: in the robot's own text, or at the import of a library's component."""

    def __init__(self, base: rsc.Base) -> None:
        self._base = base
        self._reported: set[tuple[ex.Located, rsc.CommunicationType]] = set()

    def new(
        self, element: ex.Located, instance: Instance | None, communication: rsc.CommunicationType
    ) -> ex.Located | None:
        """Return the place of a finding about an element of an instance; None if the place has one already.

        A place has at most one finding for each communication.
        """
        place = element if instance is None or instance.unit is self._base else instance.component
        if (place, communication) in self._reported:
            return None
        self._reported.add((place, communication))
        return place


class CommandCondition(NamedTuple):
    """Condition of a requirement on commands: they are allowed only if it has the value `value`."""

    requirement: rsc.Requirement
    restricted: set[PortInstance | None]
    condition: ex.Expression
    within: Instance | None
    value: bool


def command_conditions(known: Instances) -> Iterator[CommandCondition]:
    """Yield the conditions of requirements on starting commands, including those of requirement automata."""
    for required in known.statements(rsc.CommunicationRequirement):
        if required.element.condition is not None:
            value = not isinstance(required.element, rsc.DisablesRequirement)
            restricted = commands_of(required, known)
            yield CommandCondition(required.element, restricted, required.element.condition, required.within, value)
    for automaton in known.statements(rsc.AutomatonRequirement):
        events = events_of(automaton.element)
        requests = [reference for reference in events if kind_of(reference) == rsc.ResultType.request]
        restricted = {known.port(reference.communicationType, automaton.within) for reference in requests}
        for state in automaton.element.states:
            for guard in (transition.guard for transition in state.transitions):
                if guard is not None:
                    yield CommandCondition(automaton.element, restricted, guard, automaton.within, value=True)


def events_of(requirement: rsc.Requirement) -> list[rsc.EventReference]:
    """Return the events that an order, a count or a requirement automaton names."""
    match requirement:
        case rsc.AutomatonRequirement():
            return [transition.event for state in requirement.states for transition in state.transitions]
        case rsc.OrderRequirement() | rsc.CountRequirement():
            named = [*(requirement.target.events if requirement.target else ()), requirement.anchor]
            return [reference for reference in named if reference is not None]
    return []


def commands_of(requirement: Statement[rsc.CommunicationRequirement], known: Instances) -> set[PortInstance | None]:
    """Return the commands that a requirement restricts."""
    target = requirement.element.target
    named = target.communicationTypes if target else ()
    return {known.port(reference, requirement.within) for reference in named}


def kind_of(reference: rsc.EventReference) -> rsc.ResultType | None:
    """Return the event that a reference names or implies."""
    if isinstance(reference, rsc.NamedEvent):
        return reference.resultType
    implied = port_event_of(reference)
    return None if implied is None or not implied.name else getattr(rsc.ResultType, implied.name)
