"""ROS 1 part of a peer. The tests import it only by name, in the Python of ROS 1."""

import importlib
import threading
import time

import actionlib
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus
from topics import fill


def _find(kind, folder):
    package, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.{folder}"), name)


ENDS = {GoalStatus.SUCCEEDED: "succeeded", GoalStatus.ABORTED: "aborted", GoalStatus.PREEMPTED: "cancelled"}


class Ros:
    def __init__(self, name):
        rospy.init_node(name, disable_signals=True)
        self.clients = {}

    def stop(self):
        rospy.signal_shutdown("the test has ended")

    def listen(self, topic, kind, callback, latched):  # noqa: ARG002
        rospy.Subscriber(topic, kind, callback, queue_size=10000, tcp_nodelay=True)

    def publisher(self, topic, kind, qos):
        return rospy.Publisher(topic, kind, queue_size=50000, tcp_nodelay=True, latch=qos.get("latched", False))

    def withdraw(self, publisher):
        publisher.unregister()

    def listeners(self, publisher):
        return publisher.get_num_connections()

    def time(self, seconds):
        return rospy.Time.from_sec(seconds)

    def serve(self, name, kind, called):
        service = _find(kind, "srv")

        def handle(request):
            answer = called(request)
            return None if answer is None else fill(service._response_class(), answer)

        rospy.Service(name, service, handle)

    def act(self, name, kind, asked, cancelled):
        goals = {}
        cancels = rospy.Publisher(f"{name}/cancel", GoalID, queue_size=10)
        types = [_find(kind + part, "msg") for part in ("Result", "Feedback")]

        def begin(handle):
            goal = goals[handle.get_goal_id().id] = _Goal(handle, cancels, *types)
            goal.cancelled = cancelled
            asked(goal, handle.get_goal())
            threading.Thread(target=goal.decide, daemon=True).start()

        server = actionlib.ActionServer(
            name,
            _find(kind + "Action", "msg"),
            begin,
            lambda handle: goals[handle.get_goal_id().id].cancel(),
            auto_start=False,
        )
        server.start()

    def call(self, name, kind, fields, answered):
        service = _find(kind, "srv")

        def call():
            rospy.wait_for_service(name)
            try:
                answered(rospy.ServiceProxy(name, service)(fill(service._request_class(), fields)))
            except rospy.ServiceException:
                answered(None)

        threading.Thread(target=call, daemon=True).start()

    def start(self, name, kind, fields, accepted, progress, ended, cancelled):  # noqa: ARG002
        if name not in self.clients:
            self.clients[name] = actionlib.ActionClient(name, _find(kind + "Action", "msg"))
            self.clients[name].wait_for_server()
        said = []

        def accept(yes):
            if not said:
                said.append(yes)
                accepted(yes)

        def follow(handle):
            state = handle.get_comm_state()
            if state == actionlib.CommState.ACTIVE:
                accept(True)
            elif state == actionlib.CommState.DONE:
                how = handle.get_terminal_state()
                accept(how != GoalStatus.REJECTED)
                if how != GoalStatus.REJECTED:
                    ended(ENDS[how], handle.get_result())

        goal = fill(_find(kind + "Goal", "msg")(), fields)
        return self.clients[name].send_goal(goal, follow, lambda _, feedback: progress(feedback))


class _Goal:
    def __init__(self, handle, cancels, result, feedback):
        self.handle = handle
        self.cancels = cancels
        self.result = result
        self.feedback = feedback
        self.accepted = threading.Event()

    def decide(self):
        if self.decision.get():
            self.handle.set_accepted()
            self.accepted.set()
            if self.cancel_requested():
                self.grant()
        else:
            self.handle.set_rejected(text="not now")

    def cancel(self):
        self.do = self.cancelled(self)
        if self.cancel_requested():
            self.grant()

    def cancel_requested(self):
        """Whether the goal is accepted and a client requests its cancellation."""
        return self.handle.get_goal_status().status == GoalStatus.PREEMPTING

    def grant(self):
        if self.do == "grant":
            self.handle.set_canceled()

    def progress(self, fields):
        self.accepted.wait()
        self.handle.publish_feedback(fill(self.feedback(), fields))

    def end(self, how, fields=None):
        self.accepted.wait()
        if how == "open":
            status = GoalStatus(goal_id=self.handle.get_goal_id(), status=GoalStatus.ACTIVE)
            self.handle.action_server.publish_result(status, self.result())
            return
        set_end = {
            "succeeded": self.handle.set_succeeded,
            "aborted": self.handle.set_aborted,
            "cancelled": self.handle.set_canceled,
        }
        set_end[how](fill(self.result(), fields or {}))

    def cancel_elsewhere(self):
        """Cancel the goal from another client."""
        self.accepted.wait()
        self.cancels.publish(GoalID(id=self.handle.get_goal_id().id))
        while not self.cancel_requested():
            time.sleep(0.01)
