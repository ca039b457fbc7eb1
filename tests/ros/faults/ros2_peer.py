"""ROS 2 part of a peer. The tests import it only by name, in the Python of ROS 2."""

import importlib
import threading
import time
from queue import Queue

import rclpy
from action_msgs.msg import GoalInfo, GoalStatus
from action_msgs.srv import CancelGoal
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from topics import fill


def _find(kind, folder):
    package, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.{folder}"), name)


ENDS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_ABORTED: "aborted",
    GoalStatus.STATUS_CANCELED: "cancelled",
}


class Ros:
    def __init__(self, name):
        rclpy.init()
        self.node = rclpy.create_node(name)
        self.group = ReentrantCallbackGroup()
        self.clients = {}
        # Only calls and goals wait for decisions of the test. Several threads cost several times as much CPU time.
        self.executor = MultiThreadedExecutor(num_threads=8) if name == "server" else SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.actions = None
        self.mistaken = False
        self.spinning = threading.Thread(target=self._spin, daemon=True)
        self.spinning.start()

    def _spin(self):
        try:
            self.executor.spin()
        except ExternalShutdownException:
            return

    def stop(self):
        self.executor.shutdown(timeout_sec=2)
        self.spinning.join(2)
        # Otherwise the ROS graph would list the servers for another 20 s.
        if self.actions is not None:
            self.actions.destroy()
        self.node.destroy_node()
        rclpy.shutdown()

    def listen(self, topic, kind, callback, latched):
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        self.node.create_subscription(kind, topic, callback, QoSProfile(depth=10000, durability=durability))
        self.executor.wake()

    def publisher(self, topic, kind, qos):
        profile = QoSProfile(depth=qos.get("depth", 10))
        if qos.get("best_effort"):
            profile.reliability = ReliabilityPolicy.BEST_EFFORT
        if qos.get("latched"):
            profile.durability = DurabilityPolicy.TRANSIENT_LOCAL
        return self.node.create_publisher(kind, topic, profile)

    def withdraw(self, publisher):
        self.node.destroy_publisher(publisher)

    def listeners(self, publisher):
        return publisher.get_subscription_count()

    def asked_for(self, topic):
        return [
            subscription.qos_profile.reliability.name
            for subscription in self.node.get_subscriptions_info_by_topic(topic)
        ]

    def time(self, seconds):
        return Time(nanoseconds=int(seconds * 1e9)).to_msg()

    def serve(self, name, kind, called):
        def handle(request, response):
            return fill(response, called(request))

        self.node.create_service(_find(kind, "srv"), name, handle, callback_group=self.group)
        self.executor.wake()

    def act(self, name, kind, asked, cancelled):
        action = _find(kind, "action")
        waiting = Queue()
        goals = {}
        cancel_all = self.node.create_client(CancelGoal, f"{name}/_action/cancel_goal", callback_group=self.group)

        def decide(request):
            goal = _Goal(action, cancel_all)
            asked(goal, request)
            if not goal.decision.get():
                return GoalResponse.REJECT
            waiting.put(goal)
            return GoalResponse.ACCEPT

        def accept(handle):
            goal = goals[bytes(handle.goal_id.uuid)] = waiting.get()
            goal.handle, goal.server = handle, server
            goal.accepted.set()
            handle.execute()

        def cancel(handle):
            goal = goals[bytes(handle.goal_id.uuid)]
            if goal.foreign:
                return CancelResponse.ACCEPT
            do = cancelled(goal)
            if do == "grant":
                goal.ends.put(("cancelled", {}))
            return CancelResponse.REJECT if do == "refuse" else CancelResponse.ACCEPT

        server = self.actions = _Server(
            self,
            self.node,
            action,
            name,
            execute_callback=lambda handle: goals[bytes(handle.goal_id.uuid)].run(),
            goal_callback=decide,
            handle_accepted_callback=accept,
            cancel_callback=cancel,
            callback_group=self.group,
        )
        self.executor.wake()

    def call(self, name, kind, fields, answered):
        service = _find(kind, "srv")
        if name not in self.clients:
            self.clients[name] = self.node.create_client(service, name)
            self.clients[name].wait_for_service()

        def send():
            answer = self.clients[name].call_async(fill(service.Request(), fields))
            answer.add_done_callback(lambda future: answered(future.result()))

        self._do(send)

    def _do(self, send):
        """Send in the thread of the executor: a response must not overtake the record of its request in rclpy."""
        self.executor.create_task(send)
        self.executor.wake()

    def start(self, name, kind, fields, *, accepted, progress, ended, cancelled):
        action = _find(kind, "action")
        if name not in self.clients:
            self.clients[name] = ActionClient(self.node, action, name)
            self.clients[name].wait_for_server()
        sent = _Sent(self._do, cancelled)

        def decided(future):
            sent.handle = future.result()
            if sent.handle.accepted:
                sent.handle.get_result_async().add_done_callback(finished)
            accepted(sent.handle.accepted)

        def finished(future):
            ended(ENDS[future.result().status], future.result().result)

        def send():
            answer = self.clients[name].send_goal_async(
                fill(action.Goal(), fields), feedback_callback=lambda message: progress(message.feedback)
            )
            answer.add_done_callback(decided)

        self._do(send)
        return sent


class _Sent:
    """A goal that a client sent to the node under test."""

    def __init__(self, do, cancelled):
        self.do = do
        self.cancelled = cancelled

    def cancel(self):
        def send():
            answer = self.handle.cancel_goal_async()
            answer.add_done_callback(lambda future: self.cancelled(bool(future.result().goals_canceling)))

        self.do(send)


class _Server(ActionServer):
    """Action server with capabilities that no library offers."""

    def __init__(self, ros, *arguments, **options):
        super().__init__(*arguments, **options)
        self._ros = ros

    async def _execute_cancel_request(self, request_header_and_message):
        header, request = request_header_and_message
        if not self._ros.mistaken:
            await super()._execute_cancel_request(request_header_and_message)
            return
        self._cancel_callback(self._goal_handles[bytes(request.goal_info.goal_id.uuid)])
        other = GoalInfo()
        other.goal_id.uuid = [7] * 16
        self._handle.send_cancel_response(header, CancelGoal.Response(goals_canceling=[other]))

    def send_open_result(self, identifier):
        """Answer the clients that wait for a goal's result with the status of a running goal."""
        response = self._action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_EXECUTING)
        self._result_futures[bytes(identifier.uuid)].set_result(response)


class _Goal:
    def __init__(self, action, cancel_all):
        self.action = action
        self.cancel_all = cancel_all
        self.accepted = threading.Event()
        self.ends = Queue()
        self.foreign = False

    def run(self):
        how, fields = self.ends.get()
        if how == "cancelled":
            while not self.handle.is_cancel_requested:
                time.sleep(0.001)
            self.handle.canceled()
        elif how == "aborted":
            self.handle.abort()
        else:
            self.handle.succeed()
        return fill(self.action.Result(), fields)

    def progress(self, fields):
        self.accepted.wait()
        self.handle.publish_feedback(fill(self.action.Feedback(), fields))

    def end(self, how, fields=None):
        self.accepted.wait()
        if how == "open":
            self.server.send_open_result(self.handle.goal_id)
            return
        if how == "cancelled" and not self.handle.is_cancel_requested:
            self.cancel_elsewhere()
        self.ends.put((how, fields or {}))

    def cancel_elsewhere(self):
        """Cancel all goals from another client, because only a client can cancel a goal."""
        self.accepted.wait()
        self.foreign = True
        self.cancel_all.call(CancelGoal.Request())
