"""Messages to and from the synthesis process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


@dataclass(frozen=True)
class Request:
    """A robot's path, the texts that replace files, and the folders for libraries and ROS packages."""

    path: str
    texts: Mapping[str, str]
    libraries: Sequence[str]
    interfaces: Sequence[str]


@dataclass(frozen=True)
class Verdict:
    """Texts for the robot, for its requirements by their lines in its own text, and for its communications.

    `guards` maps a communication, with its component, to the guards of its events, each as `request: guard`.
    """

    robot: str
    requirements: Mapping[str, str]
    guards: Mapping[str, Sequence[str]]
