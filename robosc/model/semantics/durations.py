"""Durations of `after` in milliseconds."""

from __future__ import annotations

from fractions import Fraction
from math import floor, isfinite
from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.expansion import constant_value

if TYPE_CHECKING:
    from robosc.model import sct
    from robosc.model.semantics.instances import Instance

#: Shortest and longest duration in milliseconds. A 32-bit clock distinguishes times that are a few hours further apart.
SHORTEST, LONGEST = 1, 24 * 24 * 3600 * 1000
#: Milliseconds of each unit.
UNITS = {robosc.TimeUnit.ms: 1, robosc.TimeUnit.s: 1000, robosc.TimeUnit.min: 60_000}


def set_on_robot(duration: ex.Expression | None) -> robosc.Access | None:
    """Return the access to the parameter that sets a duration. None if the duration is a constant expression."""
    if isinstance(duration, robosc.Access) and isinstance(duration.item, robosc.Parameter):
        return duration
    return None


def bounds(parameter: robosc.Parameter, within: Instance | None) -> tuple[float | None, float | None]:
    """Return the lowest and highest value of a numeric parameter. None for bounds that the text does not give."""
    declared = parameter.type if within is None else within.data_type(parameter.type)
    if isinstance(declared, robosc.IntegerDataType):
        return declared.minimum, declared.maximum
    low, high = (constant_value(bound, within) for bound in (parameter.lowest, parameter.highest))
    return (low, high) if isinstance(low, float) and isinstance(high, float) else (None, None)


def set_milliseconds(value: float, unit: int) -> int:
    """Return a parameter's value in milliseconds; `unit` is the number of milliseconds of its unit.

    Rounds in the same way as `duration_ms` of the generated nodes.
    """
    return floor(value * unit + 0.5)


def milliseconds(transition: robosc.TimedTransition, within: Instance | None) -> int | None:
    """Return the duration in milliseconds, rounded, in the text of an instance. None if it is no constant number.

    Does not limit the result: it may be below the shortest or above the longest duration.
    """
    value = constant_value(transition.duration, within)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if not isfinite(value):
        return LONGEST + 1
    return int((Fraction(value) * UNITS[transition.unit] * 2 + 1) // 2)


def duration_text(duration: sct.Duration) -> str:
    """Return the parameter and unit of a duration that is set on the robot, such as `Base.pause s`."""
    unit = next(unit.name for unit, factor in UNITS.items() if factor == duration.unit)
    return f"{duration.parameter} {unit}"


def timer_text(timer: sct.Timer) -> str:
    """Return a timer in words, such as `3 s`, `pause s` or `500 ms without Lidar.scan`."""
    if timer.duration is not None:
        length = duration_text(timer.duration)
    else:
        assert timer.milliseconds is not None
        factors = reversed(UNITS.items())
        unit, factor = next((unit.name, factor) for unit, factor in factors if timer.milliseconds % factor == 0)
        length = f"{timer.milliseconds // factor} {unit}"
    plants = [message.eContainer() for message in timer.without]
    messages = ", ".join(plant.origin or plant.name for plant in plants)
    return length + (f" without {messages}" if messages else "")
