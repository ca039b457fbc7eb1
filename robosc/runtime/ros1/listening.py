"""Listens to what nodes of ROS 1 tell of themselves."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import rospy
from std_msgs.msg import String

from robosc.runtime.core.listening import LOOK, WAITING
from robosc.runtime.ros1.node import start

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.listening import Listener


class Ros1Ear:
    """A node of ROS 1 that only listens."""

    def __init__(self, nodes: Sequence[str], listener: Listener) -> None:
        start("robosc_view", [], anonymous=True)
        self._listener = listener
        self._closed = threading.Event()
        for name in nodes:
            rospy.Subscriber(f"{name}/definition", String, lambda message: listener.defined(message.data))
        self._states = [
            rospy.Subscriber(f"{name}/state", String, lambda message: listener.told(message.data), queue_size=WAITING)
            for name in nodes
        ]
        threading.Thread(target=self._look, daemon=True).start()

    def close(self) -> None:
        """Ends the node."""
        self._closed.set()
        rospy.signal_shutdown("the page is closed")

    def _look(self) -> None:
        while not self._closed.is_set():
            self._listener.heard(sum(state.get_num_connections() for state in self._states))
            self._closed.wait(LOOK)
