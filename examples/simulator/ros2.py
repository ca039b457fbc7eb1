"""The simulation on topics of ROS 2."""

from __future__ import annotations

import importlib
import threading
from contextlib import suppress

import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Time
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from .connection import EPOCH, Connection, UnknownTypeError

#: Ends of goals.
ENDS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_ABORTED: "aborted",
    GoalStatus.STATUS_CANCELED: "canceled",
}


class Ros2(Connection):
    """Topics and actions of ROS 2, received during waits. Lidars are best effort, as in most drivers."""

    def __init__(self, simulation):
        super().__init__(simulation)
        rclpy.init()
        self._node = rclpy.create_node("world")
        self._clock = self._node.create_publisher(Clock, "/clock", 100)
        self._publishers = {}
        for topic, kind in simulation.says.items():
            quality = qos_profile_sensor_data if kind.startswith("sensor_msgs/") else 100
            try:
                self._publishers[topic] = self._node.create_publisher(_class(kind), topic, quality)
            except UnknownTypeError:
                if topic not in simulation.scenario.unheard:
                    raise
        for topic, kind in simulation.hears.items():
            self._node.create_subscription(_class(kind), topic, self._hearer(topic), 100)
        if simulation.scenario.alive:
            self._node.create_subscription(String, simulation.scenario.alive, lambda _: self.alive(), 100)
        self._goals = []
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._servers = [self._server(action, kind) for action, kind in simulation.serves.items()]
        self._callers = {
            name: self._node.create_client(_class(kind, "srv"), name) for name, kind in simulation.calls.items()
        }
        self._starters = {
            name: ActionClient(self._node, _class(kind, "action"), name) for name, kind in simulation.goals.items()
        }
        self._answerers = _Answerers(self, simulation.answers) if simulation.answers else None

    def listeners(self, topic):
        """Return the number of listeners of a topic."""
        return self._publishers[topic].get_subscription_count() if topic in self._publishers else 0

    def serves(self, name):
        """Return whether the controller serves a service or an action."""
        if name in self._callers:
            return self._callers[name].service_is_ready()
        return self._starters[name].server_is_ready()

    def order(self, name, data, answered):
        """Call a service of the controller, or send a goal to one of its actions."""
        if name in self._callers:
            caller = self._callers[name]
            future = caller.call_async(_filled(caller.srv_type.Request(), data))
            future.add_done_callback(lambda done: answered(_plain(done.result())))
            return

        def decided(done):
            handle = done.result()
            if handle.accepted:
                handle.get_result_async().add_done_callback(lambda ended: answered(ENDS[ended.result().status]))
            else:
                answered("rejected")

        goal = _filled(_class(self.simulation.goals[name], "action").Goal(), data)
        self._starters[name].send_goal_async(goal).add_done_callback(decided)

    def clock(self, seconds):
        """Publish the time."""
        self._clock.publish(Clock(clock=_time(seconds)))

    def publish(self, topic, data):
        """Send a message."""
        if topic in self._publishers:
            publisher = self._publishers[topic]
            publisher.publish(_filled(publisher.msg_type(), data))

    def tell(self, news):
        """Send news of a goal."""
        goal = self._goals[news.goal]
        if news.what == "feedback":
            goal.handle.publish_feedback(_filled(goal.kind.Feedback(), news.data))
        else:
            # Not earlier: rclpy would wait for the end of a goal in a busy loop, before all other work.
            goal.handle.execute(lambda _: goal.ended(news.what, news.data))

    def spin(self, seconds):
        """Let rclpy handle one item."""
        self._executor.spin_once(timeout_sec=seconds)

    def close(self):
        """End the connection."""
        self.hang_up()
        for server in self._servers:
            server.destroy()
        self._node.destroy_node()
        rclpy.try_shutdown()
        if self._answerers:
            self._answerers.join()

    def _hearer(self, topic):
        return lambda message: self.heard(topic, _plain(message))

    def _server(self, action, name):
        kind = _class(name, "action")

        def ask(request):
            # This request comes before the goal has a handle.
            accepted = self.simulation.start(action, len(self._goals), _plain(request))
            return GoalResponse.ACCEPT if accepted else GoalResponse.REJECT

        def accepted(handle):
            self._goals.append(_Goal(handle, kind))

        def cancel(handle):
            number = next(number for number, goal in enumerate(self._goals) if goal.handle is handle)
            return CancelResponse.ACCEPT if self.simulation.cancel(action, number) else CancelResponse.REJECT

        return ActionServer(
            self._node,
            kind,
            action,
            lambda _: kind.Result(),
            goal_callback=ask,
            handle_accepted_callback=accepted,
            cancel_callback=cancel,
        )


class _Answerers:
    """The services, in a separate node. A thread waits for each answer, because rclpy cannot send an answer later."""

    def __init__(self, connection, services):
        self._connection = connection
        self._node = rclpy.create_node("world_services")
        for service, kind in services.items():
            callback, group = self._answerer(service), MutuallyExclusiveCallbackGroup()
            self._node.create_service(_class(kind, "srv"), service, callback, callback_group=group)
        self._executor = MultiThreadedExecutor(len(services) + 1)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def join(self):
        """Wait until all threads have ended, after the shutdown of rclpy."""
        self._thread.join()

    def _spin(self):
        with suppress(ExternalShutdownException):
            self._executor.spin()

    def _answerer(self, service):
        return lambda request, response: _filled(response, self._connection.asked(service, _plain(request)))


class _Goal:
    """An accepted goal."""

    def __init__(self, handle, kind):
        self.handle = handle
        self.kind = kind

    def ended(self, how, data):
        """End the goal and return its result."""
        {"succeeded": self.handle.succeed, "canceled": self.handle.canceled, "aborted": self.handle.abort}[how]()
        return _filled(self.kind.Result(), data)


def _class(kind, folder="msg"):
    """Return the Python class of a type."""
    package, name = kind.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{folder}"), name)
    except (ImportError, AttributeError):
        raise UnknownTypeError(kind) from None


def _time(seconds):
    whole, rest = divmod(round((EPOCH + seconds) * 1e9), 10**9)
    return Time(sec=whole, nanosec=rest)


def _filled(message, data):
    """Set fields of a message."""
    types = message.get_fields_and_field_types()
    for name, value in data.items():
        if types[name] == "builtin_interfaces/Time":
            value = _time(value)  # noqa: PLW2901
        elif isinstance(value, dict):
            value = _filled(getattr(message, name), value)  # noqa: PLW2901
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            kind = _class(types[name].partition("<")[2].rstrip(">"))
            value = [_filled(kind(), element) for element in value]  # noqa: PLW2901
        setattr(message, name, value)
    return message


def _plain(message):
    """Return a message as nested dicts."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: _plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    return message
