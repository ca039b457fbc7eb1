"""What listens to a node's reports needs of the middleware."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Seconds between two looks at who is there.
LOOK = 0.5
#: So many reports wait to be heard.
WAITING = 1000


class Listener(Protocol):
    """What is called, from a thread of the middleware's, with what nodes tell."""

    def defined(self, text: str) -> None:
        """A text on `~/definition`."""

    def told(self, text: str) -> None:
        """A text on `~/state`."""

    def heard(self, publishers: int) -> None:
        """How many nodes tell their states: called now and then."""


class Ear(Protocol):
    """What listens, until it is closed."""

    def close(self) -> None:
        """Nothing is heard any more."""


def listen(version: int, heard: Sequence[tuple[Sequence[str], Listener]]) -> Ear:
    """Listens to `~/state` and `~/definition` of nodes whenever they are there, as one node of ROS `version`.

    `heard`: the full names of nodes, and who is called with what these tell. Raises StartError where there is no ROS.
    """
    if version == 1:
        import robosc.runtime.ros1.node  # noqa: PLC0415  # says what is missing, and where it comes from
        from robosc.runtime.ros1.listening import Ros1Ear  # noqa: PLC0415

        return Ros1Ear(heard)
    import robosc.runtime.ros2.node  # noqa: F401, PLC0415
    from robosc.runtime.ros2.listening import Ros2Ear  # noqa: PLC0415

    return Ros2Ear(heard)
