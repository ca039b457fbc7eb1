"""Listens to what nodes of ROS 1 tell of themselves."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import rospy
from std_msgs.msg import String

from robosc.runtime.core.listening import LOOK, WAITING
from robosc.runtime.ros1.node import start

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.listening import Listener


class Ros1Ear:
    """A node of ROS 1 that only listens."""

    def __init__(self, heard: Sequence[tuple[Sequence[str], Listener]]) -> None:
        start("robosc_view", [], anonymous=True)
        self._states = [(listener, [_listen(node, listener) for node in nodes]) for nodes, listener in heard]
        self._closed = threading.Event()
        threading.Thread(target=self._look, daemon=True).start()

    def close(self) -> None:
        """Ends the node."""
        self._closed.set()
        rospy.signal_shutdown("the page is closed")

    def _look(self) -> None:
        while not self._closed.is_set():
            for listener, states in self._states:
                listener.heard(sum(state.get_num_connections() for state in states))
            self._closed.wait(LOOK)


def _listen(node: str, listener: Listener) -> Any:
    rospy.Subscriber(f"{node}/definition", String, lambda message: listener.defined(message.data))
    return rospy.Subscriber(f"{node}/state", String, lambda message: listener.told(message.data), queue_size=WAITING)
