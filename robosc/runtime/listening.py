"""Listens to what running nodes report, over the ROS that is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.listening import Listener, ReportSubscriber


def listen(version: int, heard: Sequence[tuple[Sequence[str], Listener]]) -> ReportSubscriber:
    """Listens to `~/state` and `~/definition` of nodes whenever they are there, as one node of ROS `version`.

    `heard`: the full names of nodes, and who is called with what these tell. Raises StartError where there is no ROS.
    """
    if version == 1:
        import robosc.runtime.ros1.node  # noqa: PLC0415  # says what is missing, and where it comes from
        from robosc.runtime.ros1.listening import Ros1Subscriber  # noqa: PLC0415

        return Ros1Subscriber(heard)
    import robosc.runtime.ros2.node  # noqa: F401, PLC0415
    from robosc.runtime.ros2.listening import Ros2Subscriber  # noqa: PLC0415

    return Ros2Subscriber(heard)
