"""Forward the messages of a guarded base unchanged, with the quality of service of its supervisory layer.

python3 relay.py
"""

import signal

import rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

try:
    from rclpy.experimental import EventsExecutor as Executor
except ImportError:
    from rclpy.executors import SingleThreadedExecutor as Executor


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
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
    while True:
        executor.spin_once(timeout_sec=0.1)


if __name__ == "__main__":
    main()
