"""Listens to what running nodes report, over the ROS that is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.listening import Listener, ReportSubscriber


def listen(heard: Sequence[tuple[Sequence[str], Listener]]) -> ReportSubscriber:
    """Listen to `~/state` and `~/definition` of nodes whenever they are there, as one node of ROS 2.

    `heard`: the full names of nodes, each with the listener that is called with their reports. Raises StartError where
    there is no ROS.
    """
    import robosc.runtime.ros2.node  # noqa: F401, PLC0415  # says what is missing
    from robosc.runtime.ros2.listening import Ros2Subscriber  # noqa: PLC0415

    return Ros2Subscriber(heard)
