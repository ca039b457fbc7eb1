"""Listens to what nodes of ROS 1 tell of themselves."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import rospy
from rosgraph import Master, MasterException
from std_msgs.msg import String

from robosc.runtime.core.listening import LOOK, WAITING
from robosc.runtime.ros1.node import start

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.listening import Listener


class Ros1Subscriber:
    """A node of ROS 1 that only listens, from when there is a master on."""

    def __init__(self, heard: Sequence[tuple[Sequence[str], Listener]]) -> None:
        self._heard = heard
        self._closed = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def close(self) -> None:
        """Ends the node."""
        self._closed.set()
        if rospy.core.is_initialized():
            rospy.signal_shutdown("the page is closed")

    def _run(self) -> None:
        # rospy itself would wait for the master where nothing can interrupt it, and say so each time.
        while not _has_master():
            if self._closed.wait(LOOK):
                return
        start("robosc_view", [], anonymous=True)
        states = [(listener, [_listen(node, listener) for node in nodes]) for nodes, listener in self._heard]
        while not self._closed.wait(LOOK):
            for listener, subscribers in states:
                listener.heard(sum(state.get_num_connections() for state in subscribers))


def _has_master() -> bool:
    try:
        return bool(Master("/robosc_view").getPid())
    except (OSError, MasterException):
        return False


def _listen(node: str, listener: Listener) -> Any:
    rospy.Subscriber(f"{node}/definition", String, lambda message: listener.defined(message.data))
    return rospy.Subscriber(f"{node}/state", String, lambda message: listener.told(message.data), queue_size=WAITING)
