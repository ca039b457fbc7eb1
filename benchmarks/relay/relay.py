"""Forward the messages of a guarded base unchanged, with the quality of service of its supervisory layer.

python3 relay.py
"""

import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

try:
    from rclpy.experimental import EventsExecutor as Executor
except ImportError:
    from rclpy.executors import SingleThreadedExecutor as Executor


def main():
    rclpy.init()
    node = rclpy.create_node("plain_relay")
    for kind, source, target, received in (
        (Twist, "~/controller/cmd_vel", "~/cmd_vel", 10),
        (LaserScan, "/scan", "~/controller/scan", qos_profile_sensor_data),
        (Bool, "/emergency_stop", "~/controller/emergency_stop", 10),
    ):
        publisher = node.create_publisher(kind, target, 10)
        node.create_subscription(kind, source, publisher.publish, received)
    executor = Executor()
    executor.add_node(node)
    executor.spin()


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        sys.exit(0)
