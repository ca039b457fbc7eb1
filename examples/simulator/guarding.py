"""A guard in front of a random agent: the layer of `robosc run --layer`, without ROS, and a judge.

The judge is written by hand and does not use the model. It checks each command of the agent twice: a command that must
not pass does not reach the world, and a command that may pass reaches it with the expected data. Needs robosc.
"""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass, field
from itertools import count

from robosc.language.configuration.parameters import layer_parameters
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.cancel_requests import GoalTimes
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.port import CancelAnswer, Failure, GoalOutcome
from robosc.run.runtime.core.proxies import ActionProxy, ProxiedGoal, ServiceProxy
from robosc.run.runtime.core.settings import SafeMessages, Settings

from .engine import OUTCOMES, Received, Sent, WorldPort, config_beside, load, plain
from .playing import said
from .restless import GUARDED, restless
from .simulation import Answer, GoalNews, Message

#: The share of the agent's turns in which it cancels a running goal instead.
CANCELS = 0.05
#: The share of steps after which the agent sends other commands.
CHANGES = 0.03
#: The shares of steps in which it sends a message, a goal or call, and a second one before the first has ended.
MESSAGES, GOALS, SECOND_GOALS = 0.6, 0.15, 0.03
CANCEL_ANSWERS = {True: CancelAnswer.ACCEPTED, False: CancelAnswer.TERMINATED, None: CancelAnswer.REFUSED}


class Guard:
    """The layer of a model between an agent and a world."""

    def __init__(self, world, models, configuration):
        graph = models.rosgraph
        self._event_loop = EventLoop(lambda: world.time)
        self._port = WorldPort(world)
        values = {parameter.name: parameter.default for parameter in layer_parameters(graph, configuration, "")}
        settings = Settings(values, configuration)
        safe = SafeMessages(on_blocked=[find_message(graph, name) for name in configuration.on_blocked])
        self._layer = Layer(graph, settings, self._port, self._event_loop, safe)
        self._world = world
        self._subscriptions = {subscription.topic: subscription for subscription in graph.subscriptions}
        self._publishers = {publisher.topic: publisher for publisher in graph.publishers}
        self._services = {
            client.identifier: ServiceProxy(
                self._port, self._event_loop, client, self._layer, settings.seconds("service_timeout_ms")
            )
            for client in graph.serviceClients
        }
        self._actions = {}
        for client in graph.actionClients:
            timeout = settings.seconds("action_timeout_ms")
            proxy = WorldActionProxy(self._port, self._event_loop, client, self._layer, GoalTimes(timeout, timeout))
            self._actions[client.identifier] = self._layer.goals[client.cancel] = proxy
        self._layer.start()
        self.work()

    def take(self, item):
        """Handle a message, an answer or news of a goal from the world."""
        if isinstance(item, Answer):
            self._port.take(item)
        elif isinstance(item, GoalNews):
            self._actions[item.action].take(item)
        elif isinstance(item, Message) and item.topic in self._subscriptions:
            self._layer.receive(self._subscriptions[item.topic], Received(item.data))
        self.work()

    def send(self, name, data):
        """Handle a command of the agent. The guard offers nothing for commands that it does not know."""
        if name in self._publishers:
            publisher = self._publishers[name]
            forwarded = self._layer.forwarded(publisher.sendings[0], Sent(data))
            if forwarded is not None:
                self._port.publish(publisher, forwarded)
        elif name in self._services:
            self._services[name].call(Sent(data), Caller())
        elif name in self._actions:
            self._actions[name].begin(data)
        self.work()

    def work(self):
        """Run all functions that are due now."""
        while self._event_loop.run_pending() == 0.0:
            pass


class Caller:
    """The agent as the caller of a service, which ignores the answer."""

    def give(self, response=None):
        """Take the response."""


class WorldActionProxy(ActionProxy):
    """An action that the layer offers the agent in place of the world's."""

    _numbers = count(1)

    def begin(self, data):
        """Handle a goal of the agent."""
        self._receive_goal(ProxiedGoal(next(self._numbers), Sent(data)), Sent(data))

    def take(self, news):
        """Handle news of a goal."""
        goal = self._at_hand(news.goal)
        if news.what == "feedback":
            self._receive_feedback(news.goal, Received(news.data))
        elif goal is not None:
            self._receive_end(goal, OUTCOMES.get(news.what, GoalOutcome.LOST), Received(news.data))

    def _is_served(self, goal):
        del goal
        return True

    def _send(self, goal):
        if self._port.simulation.start(self._action.identifier, goal.identifier, plain(goal.request)):
            self._accept(goal)
        else:
            self._event_loop.post(lambda: self._give_up(goal, Failure.REJECTED, "rejected"))
        return True

    def _send_cancel(self, goal):
        answer = CANCEL_ANSWERS[self._port.simulation.cancel(self._action.identifier, goal.identifier)]
        self._event_loop.post(lambda: self._cancel_answered(goal, answer))

    def _is_canceling(self, goal):
        del goal
        return False

    def _end(self, goal):
        """Do nothing: the agent ignores the end of its goal."""


@dataclass
class Tally:
    """The fate of an agent's commands, by topic, service or action."""

    reached: Counter = field(default_factory=Counter)
    changed: Counter = field(default_factory=Counter)
    withheld: Counter = field(default_factory=Counter)
    #: Stops that the guard sent in place of commands, and goals that it canceled.
    stops: int = 0
    canceled: int = 0
    faults: list = field(default_factory=list)

    @property
    def commands(self):
        """The number of commands of the agent."""
        return self.reached.total() + self.withheld.total()


class Boundary:
    """The world as the guard sees it. Records all that reaches the world."""

    answers = property(lambda self: self._world.answers)
    serves = property(lambda self: self._world.serves)
    time = property(lambda self: self._world.time)

    def __init__(self, world):
        self._world = world
        self.arrived = []
        #: Goals that run, by their action, and the actions whose goal is being canceled.
        self.goals, self.canceled = {}, []

    def receive(self, topic, data):
        """Forward a message."""
        self.arrived.append((topic, data))
        self._world.receive(topic, data)

    def ask(self, service, call, data):
        """Forward a call."""
        self.arrived.append((service, data))
        self._world.ask(service, call, data)

    def start(self, action, goal, data):
        """Forward a goal. Return whether the world accepts it."""
        self.arrived.append((action, data))
        accepted = self._world.start(action, goal, data)
        if accepted:
            self.goals[action] = goal
        return accepted

    def cancel(self, action, goal):
        """Forward a request to cancel a goal."""
        self.canceled.append(action)
        return self._world.cancel(action, goal)


class Trial:
    """A random agent behind a guard, in a world, before a judge. The same seed gives the same trial."""

    def __init__(self, world, judge, models, configuration, seed=0):
        self.world, self._judge = world, judge
        #: Names of the commands that the agent sends at present.
        self._active = [*judge.commands]
        self._random = random.Random(f"agent/{seed}")  # noqa: S311  # not used for security
        self._boundary = Boundary(world)
        self._guard = Guard(self._boundary, models, configuration)
        #: Whether the guard sends a stop when it blocks the next command of a topic.
        self._stoppable = dict.fromkeys(judge.replaced, False)
        #: Actions whose goal the guard has canceled.
        self._ending = set()
        self.tally = Tally()

    def run(self, commands, until=lambda: False):
        """Let the agent send a number of commands, or fewer if `until()` holds. Return the tally."""
        while self.tally.commands < commands and not until():
            items = self.world.advance()
            self._judge.time = self.world.time
            self._guard.work()
            self._check_goals()
            for item in items:
                self._deliver(item)
            for name in self._choose():
                if self.tally.commands < commands:
                    self._act(name)
            danger = self.world.danger()
            if danger:
                self._fault(danger)
        return self.tally

    def _deliver(self, item):
        """Deliver a message, an answer or news of a goal to the judge and to the guard."""
        self._boundary.arrived.clear()
        if isinstance(item, Message):
            self._judge.receive(item.topic, item.data)
        elif isinstance(item, Answer):
            self._judge.answer(item.service, item.data)
        elif isinstance(item, GoalNews) and self._boundary.goals.get(item.action) == item.goal:
            if item.what != "feedback":
                del self._boundary.goals[item.action]
                self._ending.discard(item.action)
            self._judge.tell(item.action, item.what, item.data)
        self._guard.take(item)
        for name, data in self._boundary.arrived:
            self._fault(f"{name} with {data} reaches the world without a command")
        self._check_goals()

    def _choose(self):
        """Return the commands that the agent sends now. It sends some commands for a while, then others."""
        if self._random.random() < CHANGES:
            self._active = [name for name in self._judge.commands if self._random.random() < 0.6]
        weights = self._judge.weights
        return [name for name in self._active if self._random.random() < self._share(name) * weights.get(name, 1.0)]

    def _share(self, name):
        if name in self._judge.running:
            return SECOND_GOALS
        return GOALS if name in self.world.serves or name in self.world.answers else MESSAGES

    def _act(self, name):
        """Let the agent send a command, or cancel a goal."""
        if self._boundary.goals and self._random.random() < CANCELS:
            action = self._random.choice(sorted(self._boundary.goals))
            self.world.cancel(action, self._boundary.goals[action])
            return
        data = self._judge.commands[name](self._random, self.world.time)
        outcomes = self._judge.expect(name, data)
        self._boundary.arrived.clear()
        self._guard.send(name, data)
        if self._compare(name, data, outcomes, [*self._boundary.arrived]):
            self._judge.send(name, data, opens=name in self.world.answers or name in self.world.serves)
            if name in self.world.serves and name not in self._boundary.goals:
                self._judge.tell(name, "rejected", {})
        self._check_goals()

    def _compare(self, name, data, outcomes, arrived):
        """Compare what reached the world with the permitted outcomes. Return whether the command passed."""
        stop = [(name, self._judge.replaced[name])] if name in self._stoppable else []
        withheld = stop if self._stoppable.get(name) else []
        possible = [withheld if outcome is None else [(name, outcome)] for outcome in outcomes]
        matching = [outcome is not None for outcome, it in zip(outcomes, possible, strict=True) if it == arrived]
        if not matching:
            self._fault(f"{name} with {data}: {arrived} reaches the world, expected {possible}")
        passed = matching[0] if matching else bool(arrived)
        self._stoppable.update({name: passed} if stop else {})
        self.tally.stops += not passed and bool(arrived)
        self.tally.changed[name] += passed and arrived[-1:] != [(name, data)]
        (self.tally.reached if passed else self.tally.withheld)[name] += 1
        return passed

    def _check_goals(self):
        """Check that the guard cancels the goals that must end, and no others."""
        for action in self._boundary.canceled:
            if action not in self._ending:
                self.tally.canceled += 1
                self._ending.add(action)
                if self._judge.must_end(action) is False:
                    self._fault(f"the goal of {action} is canceled without need")
        self._boundary.canceled.clear()
        for action in self._boundary.goals:
            if action not in self._ending and self._judge.must_end(action):
                self._fault(f"the goal of {action} is not canceled")

    def _fault(self, words):
        self.tally.faults.append(f"at {self.world.time:.2f}: {words}; {self._judge.known()}")


def guard_scenario(name, seed=0, models=None):
    """Return a random agent behind the guard of a scenario; `models` replace those of the guard."""
    world, judge = restless(name, seed)
    path = GUARDED[name].model
    return Trial(world, judge, models or load(path), config_beside(path), seed)


def report(name, tally):
    """Print the fate of the commands. Return the exit status: 1 if the judge objects."""
    said(
        f"{name}: {tally.commands} commands, {tally.reached.total()} passed ({tally.changed.total()} changed), "
        f"{tally.withheld.total()} blocked, {tally.stops} stops, {tally.canceled} goals canceled, "
        f"{len(tally.faults)} faults"
    )
    for command in sorted({*tally.reached, *tally.withheld}):
        said(f"  {command}: {tally.reached[command]} passed, {tally.withheld[command]} blocked")
    for fault in tally.faults[:5]:
        said(f"  {fault}")
    return 1 if tally.faults else 0
