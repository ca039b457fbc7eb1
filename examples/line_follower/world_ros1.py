#!/usr/bin/env python3
"""The simulated world on the topics of ROS 1: sensors and buttons out, `/cmd_vel` in. See `run.py` for the options."""

# ruff: noqa: D102  # the methods are documented at Connection

import sys
import time

import rospy
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Clock
from run import Connection, main
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Empty, Float32


class Ros1(Connection):
    """Topics of ROS 1; rospy receives on threads of its own."""

    def __init__(self, topics, on_command):
        rospy.init_node("world", disable_signals=True)
        types = {"/scan": LaserScan, "/correction": Float32}
        self.clock_publisher = rospy.Publisher("/clock", Clock, queue_size=100)
        self.publishers = {each: rospy.Publisher(each, types.get(each, Empty), queue_size=100) for each in topics}
        rospy.Subscriber(
            "/cmd_vel",
            Twist,
            lambda twist: on_command(twist.linear.x, twist.angular.z),
            queue_size=100,
            tcp_nodelay=True,
        )

    def connected(self):
        return all(each.get_num_connections() > 0 for each in self.publishers.values())

    def clock(self, seconds):
        self.clock_publisher.publish(Clock(rospy.Time.from_sec(seconds)))

    def publish(self, topic, data, seconds):
        if data is None:
            message = Empty()
        elif topic == "/scan":
            message = LaserScan(**self.scan_geometry(), ranges=data)
            message.header.frame_id = "base_scan"
            message.header.stamp = rospy.Time.from_sec(seconds)
        else:
            message = Float32(data)
        self.publishers[topic].publish(message)

    def receive(self, seconds):
        time.sleep(seconds)

    def close(self):
        rospy.signal_shutdown("the scenario has ended")


if __name__ == "__main__":
    sys.exit(main(Ros1, rospy.myargv()[1:]))
