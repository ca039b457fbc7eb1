"""`duration`: how long `after` waits, and where it needs `without`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.definitions import behaviours, common_transitions, of_kind, transitions
from robosc.checks.libraries import meanings
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc
from robosc.semantics.durations import LONGEST, SHORTEST, milliseconds

if TYPE_CHECKING:
    from collections.abc import Iterator


@rule("duration")
def duration(base: rsc.Base) -> Iterator[Finding]:
    """A time is from 1 ms to 24 days long; outside of states it is the silence of a message."""
    for component, behaviour in behaviours(base):
        for transition in of_kind(rsc.TimedTransition, common_transitions(behaviour.automaton)):
            if not transition.without:
                yield Finding(
                    transition,
                    f"every state of `{component.name}` has this `after`, and a time that runs in all of them never"
                    " starts anew, expected `without` and a message",
                    "write it in the state whose time is meant, or `after … without message`",
                )
    for meaning in meanings(base):
        for transition in of_kind(rsc.TimedTransition, [transition for _, transition in transitions(meaning)]):
            (value,) = meaning.values(transition.duration)
            found = None if value is None else milliseconds(transition, meaning.made)
            if found is not None and not SHORTEST <= found <= LONGEST:
                yield meaning.finding(
                    transition.duration or transition,
                    f"this time is {'longer than 24 days' if found > LONGEST else 'shorter than 1 ms'}, expected"
                    " 1 ms to 24 days",
                    "the units are `ms`, `s` and `min`",
                )
