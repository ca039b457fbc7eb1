#!/usr/bin/env python3
"""A controller without knowledge of the supervisory layer, with the names of `tests/m2t/layer/usher.rscd`.

It executes the commands on `/do` (a JSON object: a name and a value) and publishes all its inputs on `/told`. After
each `/stop` it sends a speed at once, which a supervisor that has received the stop must block.
"""

import json
import sys
import threading
from contextlib import suppress

import rclpy
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Empty, Float32, Int16, String
from std_srvs.srv import SetBool

GREETING = "here I am"


class Driver:
    def __init__(self):
        rclpy.init(args=sys.argv)
        node = self.node = rclpy.create_node("driver")
        lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.told = node.create_publisher(String, "/told", 100)
        self.speed = node.create_publisher(Float32, "/speed", 100)
        self.label = node.create_publisher(String, "label", lasting)
        self.label.publish(String(data=GREETING))
        self.light = node.create_client(SetBool, "/lamp/light")
        self.action = ActionClient(node, NavigateToPose, "/go_to")
        node.create_subscription(Empty, "/stop", lambda _: self.stopped(), 100)
        node.create_subscription(Empty, "/resume", lambda _: self.tell("resume", True), 10)
        node.create_subscription(LaserScan, "/scan", lambda message: self.tell("scan", len(message.ranges)), 10)
        node.create_subscription(Int16, "battery", lambda message: self.tell("battery", message.data), 10)
        node.create_subscription(String, "/do", lambda message: self.do(*json.loads(message.data)), 100)

    def tell(self, what, value):
        self.told.publish(String(data=json.dumps([what, value])))

    def stopped(self):
        self.speed.publish(Float32(data=9.0))
        self.tell("stop", True)

    def do(self, what, value):
        if what == "speed":
            self.speed.publish(Float32(data=value))
        elif what == "light":
            self.light.call_async(SetBool.Request(data=value)).add_done_callback(
                lambda answer: self.tell("light", answer.result().success)
            )
        elif what == "go_to":
            goal = NavigateToPose.Goal()
            goal.pose.pose.position.x = value
            self.action.send_goal_async(goal, self.on_feedback).add_done_callback(self.on_answer)
        elif what == "cancel":
            self.goal.cancel_goal_async().add_done_callback(self.on_cancelling)
        elif what == "server":
            threading.Thread(target=lambda: self.tell("server", self.action.wait_for_server())).start()

    def on_answer(self, answer):
        goal = answer.result()
        if not goal.accepted:
            self.tell("go_to", "REJECTED")
            return
        self.goal = goal
        goal.get_result_async().add_done_callback(self.on_result)

    def on_result(self, answer):
        names = {4: "SUCCEEDED", 5: "CANCELED", 6: "ABORTED"}
        self.tell("go_to", names[answer.result().status])

    def on_cancelling(self, answer):
        if answer.result().return_code == answer.result().ERROR_REJECTED:
            self.tell("cancel", "REJECTED")

    def on_feedback(self, message):
        self.tell("feedback", message.feedback.distance_remaining)

    def run(self):
        with suppress(KeyboardInterrupt, ExternalShutdownException):
            rclpy.spin(self.node)


if __name__ == "__main__":
    Driver().run()
