#!/usr/bin/env python3
"""The simulated world on the topics of ROS 2: sensors and buttons out, `/cmd_vel` in. See `run.py` for the options."""

# ruff: noqa: D102  # the methods are documented at Connection

import sys
import time

import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Twist
from rclpy.qos import qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from rosgraph_msgs.msg import Clock
from run import Connection, main
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Empty, Float32


class Ros2(Connection):
    """Topics of ROS 2, received while we wait."""

    def __init__(self, topics, on_command):
        rclpy.init()
        self.node = rclpy.create_node("world")
        types = {"/scan": (LaserScan, qos_profile_sensor_data), "/correction": (Float32, 100)}
        self.clock_publisher = self.node.create_publisher(Clock, "/clock", 100)
        self.publishers = {each: self.node.create_publisher(*self.kind(types, each)) for each in topics}
        self.node.create_subscription(Twist, "/cmd_vel", lambda twist: on_command(twist.linear.x, twist.angular.z), 100)

    @staticmethod
    def kind(types, topic):
        message, quality = types.get(topic, (Empty, 100))
        return message, topic, quality

    def connected(self):
        return all(each.get_subscription_count() > 0 for each in self.publishers.values())

    @staticmethod
    def stamp(seconds):
        whole, rest = divmod(round(seconds * 1e9), 10**9)
        return Time(sec=whole, nanosec=rest)

    def clock(self, seconds):
        self.clock_publisher.publish(Clock(clock=self.stamp(seconds)))

    def publish(self, topic, data, seconds):
        if data is None:
            message = Empty()
        elif topic == "/scan":
            message = LaserScan(**self.scan_geometry(), ranges=data)
            message.header.frame_id = "base_scan"
            message.header.stamp = self.stamp(seconds)
        else:
            message = Float32(data=data)
        self.publishers[topic].publish(message)

    def receive(self, seconds):
        until = time.monotonic() + seconds
        while rclpy.ok():
            rclpy.spin_once(self.node, timeout_sec=max(0.0, until - time.monotonic()))
            if time.monotonic() >= until:
                return

    def close(self):
        self.node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main(Ros2, remove_ros_args(sys.argv)[1:]))
