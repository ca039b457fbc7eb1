#!/usr/bin/env python3
"""A small simulated robot for `tests/tools/gate/porter.rscd`: a base on a line, and a person who stands at 1 m.

Arguments: the file for a line of JSON for each received command. The robot reports the person whenever that changes.
"""

import json
import sys
import time
from contextlib import suppress
from pathlib import Path

import rclpy
from geometry_msgs.msg import Twist
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool, Empty, Int16, String
from std_srvs.srv import SetBool

PERIOD = 0.02
PERSON, RANGE = 1.0, 0.5


class Porter:
    def __init__(self, path):
        rclpy.init(args=sys.argv)
        node = self.node = rclpy.create_node("porter")
        self.path = Path(path)
        self.path.touch()
        self.position, self.velocity, self.near = 0.0, 0.0, None
        together = ReentrantCallbackGroup()
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.person = node.create_publisher(Bool, "/person", latched)
        node.create_subscription(Twist, "/cmd_vel", self.drive, 100)
        node.create_subscription(Int16, "/gear", lambda gear: self.record("gear", gear.data), 100)
        node.create_subscription(Empty, "/horn", lambda _: self.record("horn", True), 100)
        node.create_subscription(String, "/text", lambda text: self.record("text", text.data), 100)
        node.create_service(SetBool, "/light", self.light)
        self.server = ActionServer(
            node,
            NavigateToPose,
            "/go_to",
            self.go,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=together,
        )
        node.create_timer(PERIOD, self.step)

    def record(self, name, value):
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps([name, value]) + "\n")

    def drive(self, twist):
        self.velocity = twist.linear.x
        self.record("velocity", twist.linear.x)

    def light(self, request, response):
        self.record("light", request.data)
        response.success = request.data
        return response

    def go(self, goal):
        self.record("go_to", goal.request.pose.pose.position.x)
        while not goal.is_cancel_requested:
            left = goal.request.pose.pose.position.x - self.position
            goal.publish_feedback(NavigateToPose.Feedback(distance_remaining=abs(left)))
            if abs(left) < 0.1:
                goal.succeed()
                return NavigateToPose.Result()
            self.velocity = 0.5 if left > 0 else -0.5
            time.sleep(PERIOD)
        self.velocity = 0.0
        self.record("canceled", True)
        goal.canceled()
        return NavigateToPose.Result()

    def step(self):
        self.position += self.velocity * PERIOD
        near = abs(self.position - PERSON) < RANGE
        if near != self.near:
            self.near = near
            self.person.publish(Bool(data=near))

    def run(self):
        executor = MultiThreadedExecutor(4)
        executor.add_node(self.node)
        with suppress(KeyboardInterrupt, ExternalShutdownException):
            executor.spin()


if __name__ == "__main__":
    Porter(sys.argv[1]).run()
