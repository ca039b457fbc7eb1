"""Choices of a user for a new robot."""

from __future__ import annotations

import re
from dataclasses import dataclass

from robosc.model.semantics.naming import ROBOSC_KEYWORDS, snake_case

_ROBOT = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")
_COMMUNICATION = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")


@dataclass(frozen=True)
class RobotName:
    """Name of a robot as the user writes it."""

    name: str

    @property
    def robot(self) -> str:
        """The robot's name as the model writes it: `MyRobot` for `my_robot`."""
        return camel(self.name)

    @property
    def stem(self) -> str:
        """The robot's name in snake case, for its folder and files."""
        return snake_case(self.robot)


@dataclass(frozen=True)
class Choices(RobotName):
    """A robot's name, its ROS (1 or 2), and the names of its inputs and outputs.

    `sensors` are messages that report whether `command` may be sent; while it may not, `stop` is sent. `service` is
    called once, before anything else. With `twist`, both commands are velocities.
    """

    ros: int = 2
    sensors: tuple[str, ...] = ("clear",)
    command: str = "drive"
    stop: str | None = "halt"
    service: str | None = None
    twist: bool = False

    @property
    def package(self) -> str:
        """The name of the generated ROS package, its node and executable."""
        return f"{self.stem}_controller"

    @property
    def commands(self) -> list[str]:
        """The messages that the controller sends."""
        return [self.command, *([self.stop] if self.stop else [])]

    def fault(self) -> str | None:
        """Return the fault of a name with a hint, or None if all names are valid."""
        fault = robot_fault(self.name)
        if fault:
            return fault
        names = [*self.sensors, *self.commands, *([self.service] if self.service else [])]
        for name in names:
            if not _COMMUNICATION.fullmatch(name):
                return f"`{name}` cannot name a message or service: use lowercase letters, digits and single `_`"
            if name in ROBOSC_KEYWORDS:
                return f"`{name}` is a keyword: use another name"
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice:
            return f"`{twice}` is used twice: use different names"
        components = [camel(name) for name in self.sensors]
        alike = next((name for name in self.sensors if components.count(camel(name)) > 1), None)
        return f"`{alike}` is too similar to another name: use another name" if alike else None


def robot_fault(name: str) -> str | None:
    """Return the fault of a robot's name with a hint, or None if it is valid."""
    if _ROBOT.fullmatch(name):
        return None
    return f"`{name}` cannot name a robot: use letters, digits and single `_`, such as `Porter`"


def camel(name: str) -> str:
    """Return the name without underscores and with capitalized words: `StopButton` for `stop_button`."""
    return "".join(word[:1].upper() + word[1:] for word in name.split("_"))
