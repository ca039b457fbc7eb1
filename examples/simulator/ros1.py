"""The simulation on topics of ROS 1."""

from __future__ import annotations

import importlib
import threading

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from .connection import EPOCH, Connection, UnknownTypeError

#: Ends of goals.
ENDS = {GoalStatus.SUCCEEDED: "succeeded", GoalStatus.ABORTED: "aborted", GoalStatus.PREEMPTED: "canceled"}


class Ros1(Connection):
    """Topics of ROS 1, received in threads of rospy, and actions."""

    def __init__(self, simulation):
        super().__init__(simulation)
        rospy.init_node("world", disable_signals=True)
        self._clock = rospy.Publisher("/clock", Clock, queue_size=100)
        self._publishers = {}
        for topic, kind in simulation.says.items():
            try:
                self._publishers[topic] = rospy.Publisher(topic, _class(kind), queue_size=100)
            except UnknownTypeError:
                if topic not in simulation.scenario.unheard:
                    raise
        for topic, kind in simulation.hears.items():
            rospy.Subscriber(topic, _class(kind), self._hearer(topic), queue_size=100)
        if simulation.scenario.alive:
            rospy.Subscriber(simulation.scenario.alive, String, lambda _: self.alive(), queue_size=100)
        for service, kind in simulation.answers.items():
            rospy.Service(service, _class(kind, "srv"), self._answerer(service, _class(kind + "Response", "srv")))
        self._starters = {
            name: actionlib.ActionClient(name, _class(kind + "Action")) for name, kind in simulation.goals.items()
        }
        self._handles = []
        self._goals = {}
        self._servers = []
        self._feedback = {}
        self._results = {}
        for action, kind in simulation.serves.items():
            server = actionlib.ActionServer(
                action, _class(kind + "Action"), self._starter(action), self._canceller(action), auto_start=False
            )
            server.start()
            self._servers.append(server)
            self._feedback[action] = _class(kind + "Feedback")
            self._results[action] = _class(kind + "Result")

    def listeners(self, topic):
        """Return the number of listeners of a topic."""
        return self._publishers[topic].get_num_connections() if topic in self._publishers else 0

    def serves(self, name):
        """Return whether the controller serves a service or an action."""
        if name in self._starters:
            starter = self._starters[name]
            return starter.pub_goal.get_num_connections() > 0 and starter.result_sub.get_num_connections() > 0
        try:
            rospy.wait_for_service(name, 0.05)
        except rospy.ROSException:
            return False
        return True

    def order(self, name, data, answered):
        """Call a service of the controller, or send a goal to one of its actions."""
        if name in self._starters:
            goal = _filled(_class(self.simulation.goals[name] + "Goal")(), data)

            def changed(handle):
                if handle.get_comm_state() == actionlib.CommState.DONE:
                    answered(ENDS.get(handle.get_goal_status(), "rejected"))

            self._handles.append(self._starters[name].send_goal(goal, changed))
            return
        kind = self.simulation.calls[name]

        def call():
            request = _filled(_class(kind + "Request", "srv")(), data)
            answered(_plain(rospy.ServiceProxy(name, _class(kind, "srv"))(request)))

        threading.Thread(target=call, daemon=True).start()

    def clock(self, seconds):
        """Publish the time."""
        self._clock.publish(Clock(clock=rospy.Time.from_sec(EPOCH + seconds)))

    def publish(self, topic, data):
        """Send a message."""
        if topic in self._publishers:
            publisher = self._publishers[topic]
            publisher.publish(_filled(publisher.data_class(), data))

    def tell(self, news):
        """Send news of a goal."""
        handle = self._goals[news.goal]
        if news.what == "feedback":
            handle.publish_feedback(_filled(self._feedback[news.action](), news.data))
            return
        result = _filled(self._results[news.action](), news.data)
        if news.what == "succeeded":
            handle.set_succeeded(result)
        elif news.what == "canceled":
            handle.set_canceled(result)
        else:
            handle.set_aborted(result)

    def spin(self, seconds):
        """Wait while the threads of rospy work."""
        rospy.rostime.wallsleep(seconds)

    def close(self):
        """End the connection."""
        self.hang_up()
        rospy.signal_shutdown("the scenario has ended")

    def _hearer(self, topic):
        return lambda message: self.heard(topic, _plain(message))

    def _answerer(self, service, kind):
        return lambda request: _filled(kind(), self.asked(service, _plain(request)))

    def _starter(self, action):
        def start(handle):
            goal = handle.get_goal_id().id
            self._goals[goal] = handle
            if self.simulation.start(action, goal, _plain(handle.get_goal())):
                handle.set_accepted()
            else:
                handle.set_rejected()

        return lambda handle: self.later(lambda: start(handle))

    def _canceller(self, action):
        return lambda handle: self.later(lambda: self.simulation.cancel(action, handle.get_goal_id().id))


def _class(kind, folder="msg"):
    """Return the Python class of a type."""
    package, name = kind.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{folder}"), name)
    except (ImportError, AttributeError):
        raise UnknownTypeError(kind) from None


def _filled(message, data):
    """Set fields of a message."""
    types = dict(zip(message.__slots__, message._slot_types))  # noqa: B905, SLF001  # an interface of rospy
    for name, value in data.items():
        if types[name] == "time":
            value = rospy.Time.from_sec(EPOCH + value)  # noqa: PLW2901
        elif isinstance(value, dict):
            value = _filled(getattr(message, name), value)  # noqa: PLW2901
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            value = [_filled(_class(types[name].rstrip("[]"))(), element) for element in value]  # noqa: PLW2901
        setattr(message, name, value)
    return message


def _plain(message):
    """Return a message as nested dicts."""
    if hasattr(message, "_slot_types"):
        return {name: _plain(getattr(message, name)) for name in message.__slots__}
    return message
