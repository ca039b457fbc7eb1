"""Parameter values of a node, and the messages that it sends regardless of requirements."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.language.configuration.parameters import Parameter, Value
    from robosc.model import rosgraph


def check(parameter: Parameter, value: object) -> Value:
    """Return the value converted for the parameter. Raises ValueError, worded for the user, if it does not fit."""
    expected = type(parameter.default)
    if expected is float and type(value) is int:
        value = float(value)
    if type(value) is not expected or not isinstance(value, (bool, int, float, str)):
        names = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
        raise ValueError(f"{parameter.name} is {value!r}, not {names[expected]}")
    if isinstance(value, float) and not isfinite(value):
        raise ValueError(f"{parameter.name} is {value}, not finite")
    if parameter.bounds is not None and isinstance(value, (int, float)):
        low, high = parameter.bounds
        if not low <= value <= high:
            raise ValueError(f"{parameter.name} is {value}, not between {low} and {high}")
    return value


@dataclass(frozen=True)
class SafeMessages:
    """Messages that are sent in spite of requirements.

    A controller sends `on_shutdown` when it stops the robot, and `on_withheld` when a command's data can't be sent. A
    layer sends a message of `on_blocked` when it blocks that message after it forwarded one.
    """

    on_shutdown: Sequence[rosgraph.Sending] = ()
    on_withheld: Sequence[rosgraph.Sending] = ()
    on_blocked: Sequence[rosgraph.Sending] = ()


@dataclass(frozen=True)
class Settings:
    """Settings of one node: the values of its parameters, and the configuration."""

    parameters: Mapping[str, Value]
    configuration: Configuration

    def number(self, name: str) -> int:
        """Return the value of an integer parameter."""
        value = self.parameters[name]
        assert isinstance(value, int)
        return value

    def seconds(self, name: str) -> float:
        """Return the value of a parameter in milliseconds, converted to seconds."""
        return self.number(name) / 1000
