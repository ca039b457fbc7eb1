"""A scenario without middleware: the world and the controller, as of `robosc run`, in one process.

Needs robosc. All messages arrive at once, so that all runs of a scenario are identical.
"""

from __future__ import annotations

import json
import tempfile
from itertools import count
from pathlib import Path

import robosc
from robosc.language import configuration as config
from robosc.language.configuration.parameters import controller_parameters, layer_parameters
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.controller import Controller
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.node_data import BLANK
from robosc.run.runtime.core.port import CancelAnswer, GoalOutcome
from robosc.run.runtime.core.settings import SafeMessages, Settings

from .playing import tell
from .simulation import Answer, GoalNews, Order

EXAMPLES = Path(__file__).resolve().parents[1]
OUTCOMES = {"succeeded": GoalOutcome.SUCCEEDED, "canceled": GoalOutcome.CANCELED, "aborted": GoalOutcome.ABORTED}
ZERO = {"x": 0.0, "y": 0.0, "z": 0.0}
#: Fields with defaults.
POSE = {"header": {"frame_id": ""}, "pose": {"position": ZERO, "orientation": {**ZERO, "w": 1.0}}}
DEFAULTS = {
    "Twist": {"linear": ZERO, "angular": ZERO},
    "TwistStamped": {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""},
        "twist": {"linear": ZERO, "angular": ZERO},
    },
    "Int16": {"data": 0},
    "Bool": {"data": False},
    "NavigateToPose": {"pose": POSE},
    "SpeedLimit": {"percentage": False},
}


def play(simulation, until, models=None, kind=Controller, quiet=False):
    """Play a scenario until `until()` holds. Return the controller's log.

    `models` replace the scenario's own models, `kind` replaces the class of the controller.
    """
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "events.jsonl"
        node = connected(simulation, models or load(model_of(simulation.scenario)), log, kind)
        told = 0
        while not until():
            for message in simulation.advance():
                node.take(message)
            node.work()
            if not quiet:
                told = tell(simulation, told)
        node.flush()
        return [json.loads(line) for line in log.read_text(encoding="utf-8").split("\n")[:-1]]


def model_of(scenario):
    """Return the file with a scenario's model."""
    return EXAMPLES / scenario.name / f"{scenario.name}.rscd"


def load(path):
    """Return all models of the robot in a file, with its supervisor."""
    robot = robosc.load(path)
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return robosc.Models(plants, robosc.to_rosgraph(robot), robot)


def connected(simulation, models, log, kind=Controller):
    """Return the controller of the world, with its layer if the scenario has one."""
    scenario = simulation.scenario
    if scenario.controller is None:
        return Node(simulation, models, config_beside(model_of(scenario)), log, kind)
    return SupervisedNode(simulation, models, log)


def config_beside(model):
    """Return the configuration of a model: that of the file beside it, if there is one."""
    path = model.parent / config.FILE_NAME
    return config.read(path) if path.exists() else config.Configuration()


class Node:
    """A controller that is connected only to a simulation."""

    def __init__(self, simulation, models, configuration, log, kind=Controller):
        graph = models.rosgraph
        self._event_loop = EventLoop(lambda: simulation.time)
        self._port = WorldPort(simulation)
        parameters = {
            controller_parameter.name: controller_parameter.default
            for controller_parameter in controller_parameters(graph, configuration, str(log))
        }
        self._controller = kind(graph, Settings(parameters, configuration), self._port, self._event_loop)
        self._subscriptions = {subscription.topic: subscription for subscription in graph.subscriptions}
        self._simulation = simulation
        self._services = {server.identifier: server for server in graph.serviceServers}
        self._actions = {server.identifier: server for server in graph.actionServers}
        self._controller.start()

    def take(self, item):
        """Handle a message, an answer or news of a goal."""
        if isinstance(item, (Answer, GoalNews)):
            self._port.take(item)
        elif isinstance(item, Order):
            self._event_loop.post(lambda: self._order(item))
        elif item.topic in self._subscriptions:
            subscription, message = self._subscriptions[item.topic], Received(item.data)
            self._event_loop.post(lambda: self._controller.receive(subscription, message))

    def _order(self, order):
        """Deliver a call or a goal."""
        client, data = Client(self._simulation, order.name), Received(order.data)
        if order.name in self._services:
            self._controller.services[self._services[order.name]].call(data, client)
            return
        server = self._controller.actions[self._actions[order.name]]
        if server.accepts(data):
            server.begin(client, data)
        else:
            self._simulation.answered(order.name, "rejected")

    def work(self):
        """Run all functions that are due now."""
        while self._event_loop.run_pending() == 0.0:
            pass

    def flush(self):
        """Wait until the log contains all events."""
        self._controller.flush_log()


class SupervisedNode:
    """A controller that is connected to the world only through its supervisory layer."""

    def __init__(self, simulation, models, log):
        scenario, graph = simulation.scenario, models.rosgraph
        behind = EXAMPLES / scenario.name / scenario.controller
        self._world = simulation
        self._controller = Node(self, load(behind), config_beside(behind), "")
        configuration = config_beside(model_of(scenario))
        parameters = {
            layer_parameter.name: layer_parameter.default
            for layer_parameter in layer_parameters(graph, configuration, str(log))
        }
        self._event_loop = EventLoop(lambda: simulation.time)
        safe = SafeMessages(on_blocked=[find_message(graph, name) for name in configuration.on_blocked])
        self._layer = Layer(graph, Settings(parameters, configuration), WorldPort(simulation), self._event_loop, safe)
        self._subscriptions = {subscription.topic: subscription for subscription in graph.subscriptions}
        self._sendings = {publisher.topic: publisher.sendings[0] for publisher in graph.publishers}
        self._layer.start()

    @property
    def time(self):
        """The world's time."""
        return self._world.time

    def take(self, item):
        """Deliver a message first to the layer, then to the controller."""
        if item.topic in self._subscriptions:
            self._layer.receive(self._subscriptions[item.topic], Received(item.data))
            self._controller.take(item)

    def receive(self, topic, data):
        """Handle a command of the controller, and forward it to the world if the layer permits it."""
        forwarded = self._layer.forwarded(self._sendings[topic], Sent(data))
        if forwarded is not None:
            self._world.receive(topic, plain(forwarded))

    def work(self):
        """Run all functions that are due now."""
        self._event_loop.run_pending()
        self._controller.work()

    def flush(self):
        """Wait until the log contains all events."""
        self._layer.flush_log()


class WorldPort:
    """The middleware of a controller, implemented by the simulation."""

    def __init__(self, simulation):
        self.simulation = simulation
        self._numbers = count(1)
        self._goals = {}

    def now(self):
        """Return the world's time."""
        return self.simulation.time

    def hear(self):
        """Do nothing: all messages have arrived."""

    def create(self, interface, part):
        """Return data to be filled."""
        del part
        return Sent(json.loads(json.dumps(DEFAULTS.get(interface.type, {}))))

    def unset(self, interface, part, path):
        """Return an object without any known fields."""
        del path
        return self.create(interface, part)

    def stamp(self, message, frame):
        """Do nothing: headers need no time here."""

    def wire_types(self, message):
        """Return the types of a message's fields, derived from their values. Missing fields are doubles."""
        return _Types(message)

    def publish(self, publisher, message):
        """Send a message to the world."""
        self.simulation.receive(publisher.topic, plain(message))

    def is_served(self, client):
        """Return whether the world has this server."""
        return client.identifier in self.simulation.serves or client.identifier in self.simulation.answers

    def call(self, client, request, handlers):
        """Call a service of the world."""
        self.simulation.ask(client.identifier, handlers, plain(request))

    def send_goal(self, client, goal, handlers):
        """Send a goal to the world."""
        number = next(self._numbers)
        self._goals[number] = handlers
        if self.simulation.start(client.identifier, number, plain(goal)):
            handlers.accepted()
        else:
            handlers.rejected()
        return Goal(self.simulation, client.identifier, number, handlers)

    def take(self, news):
        """Deliver an answer or news of a goal."""
        if isinstance(news, Answer):
            news.call.answered(Received(news.data))
            return
        handlers = self._goals[news.goal]
        if news.what == "feedback":
            handlers.feedback(Received(news.data))
        else:
            handlers.ended(OUTCOMES[news.what], Received(news.data), "")

    def publish_report(self, name, text):
        """Do nothing: there are no listeners."""

    def report_listeners(self, name):
        """Return 0: there are no listeners."""
        del name
        return 0

    def publish_statuses(self, statuses):
        """Do nothing: there are no listeners."""

    def status_listeners(self):
        """Return 0: there are no listeners."""
        return 0

    def endpoints(self):
        """Return no endpoints: there are no mismatches."""
        return {}

    def serving_nodes(self, _client):
        """Return no nodes: each server is there once."""
        return []

    def calling_nodes(self, _client):
        """Return no nodes: nothing goes around a layer."""
        return []

    def info(self, text):
        """Do nothing: there are no listeners."""

    warn = error = info


class Client:
    """A client of the controller: its call, or its goal."""

    is_answered = True

    def __init__(self, simulation, name):
        self._simulation, self._name = simulation, name

    def give(self, response=None):
        """Take the response of a service."""
        self._simulation.answered(self._name, {} if response is None else plain(response))

    def feed_back(self, feedback):
        """Ignore feedback."""

    def end(self, outcome, result):
        """Take the end of a goal."""
        del result
        self._simulation.answered(self._name, str(outcome))


class Goal:
    """A goal that the world executes."""

    def __init__(self, simulation, action, number, handlers):
        self._simulation, self._action, self._number, self._handlers = simulation, action, number, handlers

    def cancel(self):
        """Request the world to cancel the goal. A goal that has ended can no longer be canceled."""
        accepted = self._simulation.cancel(self._action, self._number)
        self._handlers.cancel_answered(CancelAnswer.ACCEPTED if accepted else CancelAnswer.TERMINATED)

    def is_canceling(self):
        """Return False: a canceled goal ends at once."""
        return False

    def is_gone(self):
        """Return False: the world never leaves."""
        return False


class Received:
    """Data in the form of ROS: fields are attributes, with defaults for missing ones."""

    def __init__(self, data):
        self._data = data

    def __getattr__(self, name):
        if name.startswith("_"):
            # A copy of an object requests these attributes before it has data.
            raise AttributeError(name)
        return _received(self._data[name]) if name in self._data else BLANK


def _received(value):
    if isinstance(value, dict):
        return Received(value)
    return [_received(element) for element in value] if isinstance(value, list) else value


class Sent:
    """Data to be filled in the form of ROS. An access creates a missing nested field."""

    def __init__(self, data):
        self.__dict__["_data"] = data

    def __getattr__(self, name):
        if name.startswith("_"):
            # A copy of an object requests these attributes before it has data.
            raise AttributeError(name)
        value = self._data.setdefault(name, {})
        return Sent(value) if isinstance(value, dict) else value

    def __setattr__(self, name, value):
        self._data[name] = value

    def __copy__(self):
        return Sent(dict(self._data))


def plain(value):
    """Return data as nested dicts, including received data that is forwarded in it."""
    if isinstance(value, (Sent, Received)):
        return plain(value._data)  # noqa: SLF001  # a class of this module
    return {name: plain(part) for name, part in value.items()} if isinstance(value, dict) else value


class _Types(dict):
    """The types of a message's fields. Whole numbers have 16 bits."""

    def __init__(self, message):
        super().__init__((name, _type(value)) for name, value in plain(message).items())

    def __missing__(self, name):
        return "float64"


def _type(value):
    if isinstance(value, list):
        return f"{_type(value[0]) if value else 'float64'}[]"
    names = {dict: "some/Object", str: "string", bool: "bool", int: "int16"}
    return names.get(type(value), "float64")
