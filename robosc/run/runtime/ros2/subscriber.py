"""Subscriptions to the reports of ROS 2 nodes."""

from __future__ import annotations

import os
import threading
from typing import TYPE_CHECKING

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from robosc.run.runtime.core.subscriber import LOOK, WAITING
from robosc.run.runtime.ros2.node import executor, start

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.run.runtime.core.subscriber import Listener


class Ros2Subscriber:
    """Node of ROS 2 that only listens."""

    def __init__(self, heard: Sequence[tuple[Sequence[str], Listener]]) -> None:
        self._node = start(f"robosc_view_{os.getpid()}", [])
        self._heard = heard
        for nodes, listener in heard:
            for node in nodes:
                self._listen(node, listener)
        self._node.create_timer(LOOK, self._look)
        self._closed = threading.Event()
        self._executor = executor()
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the node."""
        self._closed.set()
        self._thread.join(2 * LOOK)
        self._executor.shutdown()
        rclpy.try_shutdown()

    def _spin(self) -> None:
        while not self._closed.is_set():
            self._executor.spin_once(timeout_sec=LOOK)

    def _listen(self, node: str, listener: Listener) -> None:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._node.create_subscription(
            String, f"{node}/definition", lambda text: listener.receive_definition(text.data), latched
        )
        self._node.create_subscription(
            String, f"{node}/state", lambda text: listener.receive_report(text.data), WAITING
        )

    def _look(self) -> None:
        for nodes, listener in self._heard:
            listener.heard(sum(self._node.count_publishers(f"{node}/state") for node in nodes))
