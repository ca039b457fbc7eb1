"""How long `after` waits, in milliseconds."""

from __future__ import annotations

from fractions import Fraction
from math import isfinite
from typing import TYPE_CHECKING

from robosc.metamodel import robosc
from robosc.semantics.expansion import constant_value

if TYPE_CHECKING:
    from robosc.metamodel import sct
    from robosc.semantics.instances import Instance

#: The shortest and the longest time; times on a clock of 32 bits can be told apart up to some hours more.
SHORTEST, LONGEST = 1, 24 * 24 * 3600 * 1000
_FACTORS = {robosc.TimeUnit.ms: 1, robosc.TimeUnit.s: 1000, robosc.TimeUnit.min: 60_000}


def milliseconds(transition: robosc.TimedTransition, within: Instance | None) -> int | None:
    """The duration in the text of an instance, rounded to a whole number; None where it is no constant number.

    What rounds to less than the shortest time, or is more than the longest, is given as it is.
    """
    value = constant_value(transition.duration, within)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if not isfinite(value):
        return LONGEST + 1
    return int((Fraction(value) * _FACTORS[transition.unit] * 2 + 1) // 2)


def timer_text(timer: sct.Timer) -> str:
    """A timer in words, such as `3 s` or `500 ms without Lidar.scan`."""
    unit, factor = next(
        (unit.name, factor) for unit, factor in reversed(_FACTORS.items()) if timer.milliseconds % factor == 0
    )
    plants = [message.eContainer() for message in timer.without]
    messages = ", ".join(plant.origin or plant.name for plant in plants)
    return f"{timer.milliseconds // factor} {unit}" + (f" without {messages}" if messages else "")
