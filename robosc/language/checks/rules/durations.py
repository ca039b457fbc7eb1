"""Rule `duration`: range of the times of `after`, and the need for `without`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.definitions import behaviours, common_transitions, of_kind, transitions
from robosc.language.checks.edits import Replacement
from robosc.language.checks.libraries import instances, meanings
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.durations import (
    LONGEST,
    SHORTEST,
    UNITS,
    bounds,
    milliseconds,
    set_milliseconds,
    set_on_robot,
)
from robosc.model.semantics.typing import DOUBLE, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.libraries import Meaning
    from robosc.model.semantics.instances import InstanceParameter

_TOO_SHORT, _TOO_LONG, _EXPECTED = "shorter than 1 ms", "longer than 24 days", "1 ms to 24 days"
_UNITS = "the units are `ms`, `s` and `min`"


@rule("duration")
def duration(base: rsc.Base) -> Iterator[Finding]:
    """Every time is between 1 ms and 24 days; outside of states, a time must be the silence of a message."""
    for component, behaviour in behaviours(base):
        for transition in of_kind(rsc.TimedTransition, common_transitions(behaviour.automaton)):
            if not transition.without:
                yield Finding(
                    transition,
                    f"every state of `{component.name}` has this `after`, so its time never restarts,"
                    " expected `without` and a message",
                    "write it in the intended state, or write `after … without message`",
                )
    for meaning in meanings(base):
        for transition in of_kind(rsc.TimedTransition, [transition for _, transition in transitions(meaning)]):
            access = set_on_robot(transition.duration)
            if access is not None:
                yield from _set(transition, instances(base).parameter(access, meaning.instance), meaning)
                continue
            (value,) = meaning.values(transition.duration)
            length = None if value is None else milliseconds(transition, meaning.instance)
            if length is not None and not SHORTEST <= length <= LONGEST:
                yield meaning.finding(
                    transition.duration or transition,
                    f"this time is {_TOO_LONG if length > LONGEST else _TOO_SHORT}, expected {_EXPECTED}",
                    _UNITS,
                )


def _set(transition: rsc.TimedTransition, owned: InstanceParameter, meaning: Meaning) -> Iterator[Finding]:
    """Report a time from a parameter without a range, or with a range that leaves the limits."""
    parameter, unit = owned.parameter, transition.unit.name
    low, high = bounds(parameter, owned.instance)
    if low is not None and high is not None:
        shortest, longest = (set_milliseconds(bound, UNITS[transition.unit]) for bound in (low, high))
        if shortest < SHORTEST or longest > LONGEST:
            fault = _TOO_SHORT if shortest < SHORTEST else _TOO_LONG
            message = f"`{parameter.name}` may be set to {low}..{high} {unit}, some of it {fault}, expected {_EXPECTED}"
            yield meaning.finding(transition.duration or transition, message, f"narrow its range; {_UNITS}")
    elif meaning.instance is None and parameter.lowest is None and declared_type(parameter.type) == DOUBLE:
        yield Finding(
            transition.duration or transition,
            f"parameter `{parameter.name}` has no range, expected one within {_EXPECTED}",
            Replacement(
                f"write a range, such as `parameter {parameter.name}: double(0.5..10.0) = …`",
                "double(0.5..10.0)",
                parameter.type,
                is_choice=True,
            ),
        )
