"""Prints what is published on topics of ROS 2, each message as it comes, until Ctrl-C.

    python listen.py TOPIC...

For the wheels of ROS 2, which have no `ros2 topic echo`. Types are those that the publishers have.
"""

import sys
from importlib import import_module

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy


def listen(node, name):
    """Subscribes to a topic as its publishers offer it. Returns whether there is any yet."""
    publishers = node.get_publishers_info_by_topic(name)
    if not publishers:
        return False
    package, _, kind = publishers[0].topic_type.split("/")
    latched = all(found.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for found in publishers)
    reliable = all(found.qos_profile.reliability == ReliabilityPolicy.RELIABLE for found in publishers)
    quality = QoSProfile(
        depth=100,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
    )
    message = getattr(import_module(f"{package}.msg"), kind)

    def show(data):
        sys.stdout.write(f"{name}: {getattr(data, 'data', data)}\n")
        sys.stdout.flush()

    node.create_subscription(message, name, show, quality)
    return True


def main(topics):
    """Listens to topics, to each as soon as somebody publishes on it."""
    rclpy.init()
    node = rclpy.create_node("listen")
    waiting = [topic if topic.startswith("/") else f"/{topic}" for topic in topics]
    try:
        while True:
            waiting = [name for name in waiting if not listen(node, name)]
            rclpy.spin_once(node, timeout_sec=0.2)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
