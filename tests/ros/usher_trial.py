"""The robot behind the supervisory layer of `tests/m2t/layer/usher.rscd`, and the orders to its controller.

Run as `usher_trial.py RESULTS`, beside the layer and its controller. After each step it records the messages to the
robot and to the controller, the blocked commands, and the states of the layer.
"""

import json
import sys
import threading
import time
from pathlib import Path

import rclpy
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import SetBool
from topics import connect

LAYER = "/usher_layer"
#: Seconds for a quick operation on a machine with twenty other busy programs.
PATIENCE = 120


class Robot:
    """Service and action servers of the robot, with configurable answers, and the messages that it received."""

    def __init__(self):
        self.received = []
        self.answers = True
        self.answering = threading.Event()
        self.answering.set()
        self.accepts = True
        self.deciding = threading.Event()  # set while the robot answers goals and requests to cancel
        self.deciding.set()
        self.deaf = False  # whether it continues a goal in spite of a cancel
        self.ending = None  # end of the current goal, or None
        self.lock = threading.Lock()
        self.node = rclpy.create_node("robot")
        self.group = ReentrantCallbackGroup()
        self.node.create_service(SetBool, "/lamp/light", self.on_call, callback_group=self.group)
        self.goal = None
        self.serve()
        self.executor = MultiThreadedExecutor(8)
        self.executor.add_node(self.node)
        threading.Thread(target=self.executor.spin, daemon=True).start()

    def note(self, what, value):
        with self.lock:
            self.received.append([what, value])

    def light(self, value):
        self.note("light", value)
        self.answering.wait(PATIENCE)
        return self.answers

    def serve(self):
        self.action = ActionServer(
            self.node,
            NavigateToPose,
            "/go_to",
            self.execute,
            callback_group=self.group,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
        )

    def leave(self):
        self.action.destroy()
        self.executor.wake()  # the executor still holds the server

    def on_call(self, request, response):
        response.success = self.light(request.data)
        return response

    def on_goal(self, goal):
        self.note("go_to", goal.pose.pose.position.x)
        self.deciding.wait(PATIENCE)
        return GoalResponse.ACCEPT if self.accepts else GoalResponse.REJECT

    def on_cancel(self, goal):  # noqa: ARG002
        self.note("cancel", True)
        self.deciding.wait(PATIENCE)
        return CancelResponse.REJECT if self.deaf else CancelResponse.ACCEPT

    def execute(self, goal):
        self.ending, self.goal = None, goal
        while self.ending is None and not goal.is_cancel_requested:
            time.sleep(0.01)
        if goal.is_cancel_requested:
            goal.canceled()
        elif self.ending == "SUCCEEDED":
            goal.succeed()
        else:
            goal.abort()
        return NavigateToPose.Result()

    def say(self, distance):
        self.goal.publish_feedback(NavigateToPose.Feedback(distance_remaining=distance))

    def end(self, how):
        self.ending = how


class Trial:
    def __init__(self, results):
        self.ros = connect("2", "trial")
        self.robot = Robot()
        self.results, self.steps = results, {}
        self.told, self.blocked, self.states = [], [], []
        self.labels = []
        self.charge = 80
        self.do = self.ros.publisher("/do", "std_msgs/String")
        self.stop = self.ros.publisher("/stop", "std_msgs/Empty")
        self.resume = self.ros.publisher("/resume", "std_msgs/Empty")
        self.battery = self.ros.publisher("/battery", "std_msgs/Int16")
        self.scan = self.ros.publisher("/scan", "sensor_msgs/LaserScan")
        self.ros.listen("/told", "std_msgs/String", lambda message: self.tell(*json.loads(message.data)))
        self.ros.listen("/speed", "std_msgs/Float32", lambda message: self.robot.note("speed", round(message.data, 3)))
        self.ros.listen(
            f"{LAYER}/blocked", "std_msgs/String", lambda message: self.blocked.append(json.loads(message.data))
        )
        self.ros.listen(
            f"{LAYER}/state", "std_msgs/String", lambda message: self.states.append(json.loads(message.data))
        )

    def tell(self, what, value):
        """Record a message from the controller, except repeated answers to the question about the server."""
        if [what, value] != ["server", True] or not self.steps:
            self.told.append([what, value])

    def wait(self, condition, what):
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                raise TimeoutError(f"{what}; {self.seen()}")
            self.ros.receive(0.02)

    def heard(self, *expected):
        """Wait until the controller has published a message."""
        self.wait(lambda: list(expected) in self.told, f"the controller tells {expected}")

    def got(self, *expected):
        """Wait until the robot has received a message."""
        self.wait(lambda: list(expected) in self.robot.received, f"the robot receives {expected}")

    def was_blocked(self, name, count=1):
        """Wait until the layer has blocked a command a number of times."""
        self.wait(lambda: sum(entry["name"] == name for entry in self.blocked) >= count, f"{name} is blocked")

    def happened(self, event, since=0):
        """Wait until the layer has reported an event."""
        self.wait(lambda: any(event in state["transitions"] for state in self.states[since:]), f"{event} happens")

    def charged(self, charge):
        """Publish the charge of the battery, and wait until the controller receives it."""
        self.charge = charge
        self.battery(data=charge)
        self.heard("battery", charge)

    def ask(self, what, value=True):
        self.do(data=json.dumps([what, value]))

    def seen(self):
        return {"robot": list(self.robot.received), "controller": list(self.told), "blocked": list(self.blocked)}

    def step(self, name):
        """End a step after all its messages have arrived; a last message passes layer and controller behind them."""
        told, states = len(self.told), len(self.states)
        last = ["battery", self.charge]
        self.battery(data=self.charge)
        self.wait(lambda: last in self.told[told:], "the last message of a step is told")
        self.happened("message_battery.u_response", states)
        self.ros.receive(0.2)  # ROS does not preserve order across topics
        self.told.pop(max(at for at, entry in enumerate(self.told) if entry == last))
        self.steps[name] = {**self.seen(), "states": list(self.states)}
        for received in (self.robot.received, self.told, self.blocked, self.states):
            del received[:]

    def run(self):
        self.wait(self.ros.heard, "everyone is there")
        for _ in range(60):
            self.ask("server")
            self.battery(data=self.charge)
            self.ros.receive(0.5)
            if {"server", "battery"} <= {topic for topic, _ in self.told}:  # earlier messages may have been lost
                break
        self.heard("server", True)
        self.heard("battery", self.charge)
        self.ros.listen("label", "std_msgs/String", lambda message: self.labels.append(message.data), latched=True)
        self.step("start")
        for step in (
            self.messages,
            self.services,
            self.goals,
            self.cancels,
            self.failures,
            self.late_servers,
        ):
            step()
        self.wait(lambda: self.labels, "what was sent before anyone listened")
        self.steps["labels"] = self.labels
        self.steps["qualities"] = self.qualities()
        Path(self.results).write_text(json.dumps(self.steps))

    def qualities(self):
        """Return the reliability of the layer's subscriptions and publishers with a configured quality of service."""
        inside, feedback = f"{LAYER}/controller", "/go_to/_action/feedback"
        ends = {
            "hears": (self.ros.node.get_subscriptions_info_by_topic, [f"{inside}/speed", "/resume", feedback]),
            "sends": (self.ros.node.get_publishers_info_by_topic, ["/speed", f"{inside}/resume", inside + feedback]),
        }
        return {
            does: [
                finding.qos_profile.reliability.name
                for topic in topics
                for finding in found(topic)
                if finding.node_name == LAYER[1:]
            ]
            for does, (found, topics) in ends.items()
        }

    def messages(self):
        self.ask("speed", 0.5)
        self.got("speed", 0.5)
        self.charged(80)
        self.step("allowed")
        self.scan(ranges=[0.5])
        self.heard("scan", 1)
        self.step("short")
        self.scan(ranges=[0.5, 0.75])
        self.heard("scan", 2)
        self.step("long")
        self.charged(10)
        self.ask("speed", 0.75)
        self.was_blocked("Drive.speed")
        self.step("low")
        self.charged(80)
        for count in range(20):
            self.stop()
            self.was_blocked("Drive.speed", count + 1)
            self.resume()
            self.heard("resume", True)
            del self.told[:]
        self.step("stops")

    def services(self):
        self.ask("light")
        self.heard("light", True)
        self.step("light")
        self.robot.answers = False
        self.ask("light")
        self.heard("light", False)
        self.step("no light")
        self.robot.answering.clear()
        self.ask("light")
        self.got("light", True)
        self.ask("light", False)
        self.was_blocked("Lamp.light")
        self.robot.answers = True
        self.robot.answering.set()
        self.heard("light", True)
        self.step("two calls")
        self.stop()
        self.heard("stop", True)
        self.was_blocked("Drive.speed")
        self.ask("light")
        self.was_blocked("Lamp.light")
        self.ask("go_to", 1.0)
        self.was_blocked("Navigation.go_to")
        self.heard("go_to", "REJECTED")
        self.resume()
        self.heard("resume", True)
        self.step("forbidden")

    def goals(self):
        self.start(1.0)
        self.robot.say(0.5)
        self.heard("feedback", 0.5)
        self.ask("go_to", 2.0)
        self.was_blocked("Navigation.go_to")
        self.heard("go_to", "REJECTED")
        self.robot.end("SUCCEEDED")
        self.heard("go_to", "SUCCEEDED")
        self.step("succeeded")
        self.start(3.0)
        self.robot.end("ABORTED")
        self.heard("go_to", "ABORTED")
        self.step("aborted")
        self.robot.accepts = False
        self.ask("go_to", 4.0)
        self.heard("go_to", "REJECTED")
        self.robot.accepts = True
        self.step("rejected")

    def cancels(self):
        self.start(5.0)
        self.ask("cancel")
        self.got("cancel", True)
        self.heard("go_to", "CANCELED")
        self.step("cancelled by the controller")
        self.start(6.0)
        self.stop()
        self.got("cancel", True)
        self.heard("go_to", "CANCELED")
        self.was_blocked("Drive.speed")
        self.resume()
        self.heard("resume", True)
        self.step("cancelled by the layer")
        self.start(7.0)
        self.robot.end("SUCCEEDED")
        self.heard("go_to", "SUCCEEDED")
        self.step("the next goal")

    def failures(self):
        self.robot.answering.clear()
        self.ask("light")
        self.got("light", True)
        self.wait(lambda: ["light", False] in self.told, "the call fails")
        self.step("late")
        self.robot.answering.set()
        self.ask("light", False)
        self.heard("light", True)
        self.step("the next call")

    def late_servers(self):
        self.leave_with(8.0)
        self.stop()
        self.happened("action_go_to.c_cancel")
        self.robot.serve()
        self.was_blocked("Drive.speed")
        self.resume()
        self.heard("resume", True)
        self.ended()
        self.ros.receive(1.0)
        self.step("cancelled before there is a server")
        self.robot.deciding.clear()
        self.ask("go_to", 10.0)
        self.ros.receive(3.0)
        self.robot.deciding.set()
        self.got("cancel", True)
        self.ended()
        self.step("accepted too late")
        self.robot.deaf = True
        self.start(11.0)
        self.stop()
        self.got("cancel", True)
        self.was_blocked("Drive.speed")
        self.resume()
        self.heard("resume", True)
        self.robot.end("SUCCEEDED")
        self.ended()
        self.step("a cancel that the robot refuses")
        self.start(12.0)
        self.robot.deciding.clear()
        self.stop()
        self.happened("action_go_to.c_cancel")
        self.ask("cancel")
        self.heard("cancel", "REJECTED")
        self.resume()
        self.heard("resume", True)
        self.robot.deciding.set()
        self.robot.end("SUCCEEDED")
        self.ended()
        self.step("cancels that the robot does not answer")

    def leave_with(self, place):
        """Destroy the action server of the robot, then let the controller send a goal."""
        self.robot.leave()
        self.ros.receive(0.5)
        self.ask("go_to", place)
        self.happened("action_go_to.c_trigger")

    def ended(self):
        """Wait until the controller knows the end of its goal."""
        self.wait(lambda: "go_to" in [topic for topic, _ in self.told], "the goal ends")

    def start(self, place):
        self.robot.goal = None
        self.ask("go_to", place)
        self.wait(lambda: self.robot.goal is not None, "the goal is accepted")
        self.ros.receive(0.3)


if __name__ == "__main__":
    Trial(*sys.argv[1:]).run()
