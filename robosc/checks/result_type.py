"""`result-type` (thesis 4.5.2)."""

from collections.abc import Iterator

from robosc.checks.automata import behaviours, transitions
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc
from robosc.semantics.communication import event_names
from robosc.semantics.naming import written

_FROM = {"response", "error", "feedback", "cancel"}


@rule("result-type")
def result_type(base: rsc.Base) -> Iterator[Finding]:
    """A transition names an event that its communication has."""
    for _, behaviour in behaviours(base):
        for transition in transitions(behaviour.automaton):
            if not isinstance(transition, rsc.ResultTransition) or transition.communicationType is None:
                continue
            communication = transition.communicationType.communicationType
            event, allowed = str(transition.resultType), event_names(communication)
            if communication is not None and event not in allowed:
                forms = [f"on {name} {_preposition(name)} {written(communication.name)}" for name in allowed]
                yield Finding(
                    transition,
                    f"{_describe(communication)} has no {event}, expected {_enumeration(allowed)}",
                    f"write {_enumeration(forms)}",
                )


def _describe(communication: rsc.CommunicationType) -> str:
    direction = f"{communication.direction} " if isinstance(communication, rsc.Message) else ""
    return f"{direction}{type(communication).__name__.lower()} `{communication.name}`"


def _preposition(event: str) -> str:
    return "from" if event in _FROM else "to"


def _enumeration(words: list[str]) -> str:
    *others, last = (f"`{word}`" for word in words)
    return f"{', '.join(others)} or {last}" if others else last
