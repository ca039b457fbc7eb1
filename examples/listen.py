"""Print the messages on topics of ROS 2 as they arrive, until Ctrl-C.

    python listen.py TOPIC...

For the wheels of ROS 2, which have no `ros2 topic echo`. The publishers determine the types.
"""

import sys
from importlib import import_module

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy


def listen(node, name):
    """Subscribe with the quality of service that the publishers offer. Return whether there are publishers."""
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
    """Subscribe to each topic once it has a publisher, and print its messages."""
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
