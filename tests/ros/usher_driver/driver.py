#!/usr/bin/env python3
"""A controller of ROS 1 or 2 that knows of no supervisory layer, with the names of `tests/m2t/layer/usher.rscd`.

It does what `/do` tells it (a JSON object: a name and a value) and tells on `/told` what it hears. Whenever it hears
`/stop` it sends a speed at once, which a supervisor that has heard of the stop does not let pass.
"""
# ruff: noqa: PLC0415  # which ROS is there is known when it runs

import json
import os
import sys
import threading
from contextlib import suppress

GREETING = "here I am"


class Ros1:
    def __init__(self):
        import actionlib
        import rospy
        from nav2_msgs.msg import NavigateToPoseAction, NavigateToPoseGoal
        from sensor_msgs.msg import LaserScan
        from std_msgs.msg import Empty, Float32, Int16, String
        from std_srvs.srv import SetBool

        self.rospy, self.goal_type = rospy, NavigateToPoseGoal
        rospy.init_node("driver")
        self.told = rospy.Publisher("/told", String, queue_size=100)
        self.speed = rospy.Publisher("/speed", Float32, queue_size=100)
        self.label = rospy.Publisher("label", String, queue_size=10, latch=True)
        self.label.publish(GREETING)
        self.light = rospy.ServiceProxy("/lamp/light", SetBool)
        self.action = actionlib.ActionClient("/go_to", NavigateToPoseAction)
        self.goals = []  # one that nobody keeps is forgotten
        rospy.Subscriber("/stop", Empty, lambda _: self.stopped())
        rospy.Subscriber("/resume", Empty, lambda _: self.tell("resume", True))
        rospy.Subscriber("/scan", LaserScan, lambda message: self.tell("scan", len(message.ranges)))
        rospy.Subscriber("battery", Int16, lambda message: self.tell("battery", message.data))
        rospy.Subscriber("/do", String, lambda message: self.do(*json.loads(message.data)), queue_size=100)

    def tell(self, what, value):
        self.told.publish(json.dumps([what, value]))

    def stopped(self):
        self.speed.publish(9.0)
        self.tell("stop", True)

    def do(self, what, value):
        if what == "speed":
            self.speed.publish(value)
        elif what == "light":
            threading.Thread(target=self.call, args=[value]).start()
        elif what == "go_to":
            goal = self.goal_type()
            goal.pose.pose.position.x = value
            self.goals.append(self.action.send_goal(goal, self.on_transition, self.on_feedback))
        elif what == "cancel":
            self.goals[-1].cancel()
        elif what == "server":
            threading.Thread(target=lambda: self.tell("server", self.action.wait_for_server())).start()

    def call(self, value):
        try:
            self.tell("light", self.light(value).success)
        except self.rospy.ServiceException:
            self.tell("light", "failed")

    def on_transition(self, goal):
        from actionlib import CommState, TerminalState

        if goal.get_comm_state() == CommState.DONE:
            self.tell("go_to", TerminalState.to_string(goal.get_terminal_state()).replace("PREEMPTED", "CANCELED"))

    def on_feedback(self, goal, feedback):  # noqa: ARG002
        self.tell("feedback", feedback.distance_remaining)

    def run(self):
        self.rospy.spin()


class Ros2:
    def __init__(self):
        import rclpy
        from nav2_msgs.action import NavigateToPose
        from rclpy.action import ActionClient
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from sensor_msgs.msg import LaserScan
        from std_msgs.msg import Empty, Float32, Int16, String
        from std_srvs.srv import SetBool

        self.rclpy, self.goal_type, self.string = rclpy, NavigateToPose.Goal, String
        self.float, self.switch = Float32, SetBool.Request
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
        self.told.publish(self.string(data=json.dumps([what, value])))

    def stopped(self):
        self.speed.publish(self.float(data=9.0))
        self.tell("stop", True)

    def do(self, what, value):
        if what == "speed":
            self.speed.publish(self.float(data=value))
        elif what == "light":
            self.light.call_async(self.switch(data=value)).add_done_callback(
                lambda answer: self.tell("light", answer.result().success)
            )
        elif what == "go_to":
            goal = self.goal_type()
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
        from rclpy.executors import ExternalShutdownException

        with suppress(KeyboardInterrupt, ExternalShutdownException):
            self.rclpy.spin(self.node)


if __name__ == "__main__":
    (Ros2 if os.environ.get("ROS_VERSION") == "2" or "--ros-args" in sys.argv else Ros1)().run()
