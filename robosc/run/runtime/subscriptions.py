"""Subscriptions to the reports of running nodes, with the installed ROS."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.run.runtime.core.subscriber import Listener, ReportSubscriber


def listen(heard: Sequence[tuple[Sequence[str], Listener]]) -> ReportSubscriber:
    """Subscribe to `~/state` and `~/definition` of nodes as they appear, as one node of ROS 2.

    `heard`: pairs of full node names and the listener that is called with their reports. Raises StartError if there is
    no ROS.
    """
    import robosc.run.runtime.ros2.node  # noqa: F401, PLC0415  # reports what is missing
    from robosc.run.runtime.ros2.subscriber import Ros2Subscriber  # noqa: PLC0415

    return Ros2Subscriber(heard)
