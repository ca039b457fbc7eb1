"""What goes to the process of synthesis and comes from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


@dataclass(frozen=True)
class Request:
    """A robot's path, the texts that stand in place of files, and the folders for libraries and ROS packages."""

    path: str
    texts: Mapping[str, str]
    libraries: Sequence[str]
    interfaces: Sequence[str]


@dataclass(frozen=True)
class Verdict:
    """What to say of the robot, of its requirements by their lines in its own text, and of its communication.

    `guards` has, by the communication with its component, what allows its events, each as `request: guard`.
    """

    robot: str
    requirements: Mapping[str, str]
    guards: Mapping[str, Sequence[str]]
