"""The values of a node's parameters, and the messages that are sent whatever is required of them."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.configuration import Configuration
    from robosc.configuration.parameters import Parameter, Value
    from robosc.metamodel import rosgraph


def check(parameter: Parameter, value: object) -> Value:
    """A value for the parameter. Raises ValueError, in words for the user, where it does not fit."""
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

    A controller sends `on_shutdown` when it stops the robot and `on_withheld` when a command's data can't be sent. A
    layer sends one of `on_blocked` when it blocks it after it forwarded one.
    """

    on_shutdown: Sequence[rosgraph.Sending] = ()
    on_withheld: Sequence[rosgraph.Sending] = ()
    on_blocked: Sequence[rosgraph.Sending] = ()


@dataclass(frozen=True)
class Settings:
    """How one node runs: the values of its parameters, and the configuration."""

    parameters: Mapping[str, Value]
    configuration: Configuration

    def number(self, name: str) -> int:
        """A parameter that is a whole number."""
        value = self.parameters[name]
        assert isinstance(value, int)
        return value

    def seconds(self, name: str) -> float:
        """A parameter that counts milliseconds, in seconds."""
        return self.number(name) / 1000
