"""A running scenario: time passes, devices act and sense, people press buttons, and all of it is recorded."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from itertools import chain

from .devices import GO_ON, Button
from .scenario import set_going
from .world import STEP

POSE_PERIOD = 0.1


@dataclass(frozen=True)
class Message:
    """A message on a topic, as a mapping from fields to values."""

    topic: str
    data: dict


@dataclass(frozen=True)
class GoalNews:
    """A message of an action server to the client of a goal: feedback, succeeded, canceled, aborted."""

    action: str
    goal: object
    what: str
    data: dict


@dataclass(frozen=True)
class Answer:
    """The answer of a service to a call. `call` identifies the call."""

    service: str
    call: object
    data: dict


@dataclass(frozen=True)
class Order:
    """A call of a service of the controller, or a goal for one of its actions, by its name."""

    name: str
    data: dict


@dataclass(frozen=True)
class Happening:
    """An event for the picture: its time, the robot's place, and a description."""

    time: float
    x: float
    y: float
    words: str


class Noise:
    """Errors of sensors from a seed: the same on each machine, bounded, with small errors more often."""

    def __init__(self, seed, name):
        self._random = random.Random(f"{seed}/{name}")  # noqa: S311  # not used for security

    def up_to(self, most):
        """Return a source of errors of at most `most`."""
        return lambda: (self._random.random() + self._random.random() - 1) * most


class Simulation:
    """A scenario from its start.

    `advance` runs one step of time and returns the messages that are sent. `receive`, `ask`, `start` and `cancel`
    handle input between the steps. `ended` is true after the script, `reached` once the scenario's goal was reached.
    """

    def __init__(self, scenario, seed=0):
        self.scenario = scenario
        self.world = scenario.world()
        noise = Noise(seed, scenario.name)
        self.button = Button()
        self.devices = [self.button, *scenario.sensors(noise), *scenario.devices(self.world, noise)]
        #: Publications and subscriptions, services and actions, with their types.
        self.says = {topic: kind for device in self.devices for topic, kind in device.says.items()}
        self.says.update(scenario.people)
        self.hears = {topic: kind for device in self.devices for topic, kind in device.hears.items()}
        self.answers = {service: kind for device in self.devices for service, kind in device.answers.items()}
        self.serves = {action: kind for device in self.devices for action, kind in device.serves.items()}
        #: Services and actions of the controller that people and programs call, with their types.
        self.calls, self.goals = scenario.calls, scenario.goals
        self.ended = False
        self.reached_at = None
        self.happenings = []
        #: Data on the topics, and poses of the robot, to evaluate the run.
        self.record = []
        #: The paths of the robot, the ball and the person.
        self.ways = {"robot": [], "ball": [], "person": []}
        #: All pillars, including temporary ones.
        self.pillars = []
        self._said = []
        self._script = chain(set_going(self), scenario.script(self))
        self._waiting = None
        self._wait_until(next(self._script))
        self._trace()

    @property
    def time(self):
        """Seconds since the start."""
        return self.world.time

    @property
    def reached(self):
        """Whether the goal has been reached."""
        return self.reached_at is not None

    def device(self, kind):
        """Return the device of a class."""
        return next(device for device in self.devices if isinstance(device, kind))

    @property
    def areas(self):
        """The marked areas of the floor at this time."""
        return [*self.world.areas, *(area for device in self.devices for area in device.areas())]

    def advance(self):
        """Run one step of time. Return the messages, answers and news of goals that are sent after it."""
        for device in self.devices:
            device.act(self.world)
        self.world.step()
        for device in self.devices:
            for words in device.news():
                self.happens(words)
        self._play()
        news = self._sense()
        if self._due(POSE_PERIOD):
            self._trace()
        if not self.reached and self.scenario.reached(self):
            self.reached_at = self.time
            self.happens("the goal is reached")
        return [*_taken(self._said), *news]

    def _sense(self):
        """Let the devices send whose period has passed. Return their answers and the news of goals."""
        for device in self.devices:
            if self._due(device.period):
                for topic, data in device.say(self.world):
                    self.say(topic, data)
        news = [
            GoalNews(action, *event)
            for device in self.devices
            for action in device.serves
            for event in _taken(device.events)
        ]
        for new in news:
            if new.what != "feedback":
                self._note(new.action, new.what)
        answers = [Answer(*answer) for device in self.devices if device.answers for answer in _taken(device.given)]
        for answer in answers:
            self._note(answer.service, answer.data)
        return [*answers, *news]

    def receive(self, topic, data):
        """Handle a command of a controller, or a button that another node presses."""
        self._note(topic, data)
        self._deliver(topic, data)

    def ask(self, service, call, data):
        """Accept a call of a service. The answer with the same `call` comes later."""
        self._note(service, data)
        next(device for device in self.devices if service in device.answers).ask(self.world, service, call)

    def start(self, action, goal, data):
        """Accept or reject a goal, which `goal` identifies from now on. Return whether it is accepted."""
        self._note(action, data)
        return self._server(action).accept(self.world, goal, data)

    def cancel(self, action, goal):
        """Request the end of a goal. Return whether it will end."""
        self._note(action, "cancel")
        return self._server(action).cancel(self.world, goal)

    def say(self, topic, data):
        """Send a message, also to the world's own devices."""
        self._said.append(Message(topic, data))
        self._note(topic, data)
        if topic in self.hears:
            self._deliver(topic, data)

    def order(self, name, data):
        """Call a service of the controller, or send a goal to one of its actions."""
        self._said.append(Order(name, data))
        self._note(name, data)

    def answered(self, name, data):
        """Handle the answer of the controller to an order: of a service its data, of an action the end of the goal."""
        self._note(name, data)
        words = data if isinstance(data, str) else data.get("message", "answered")
        self.happens(f"{name}: {words}")

    def press(self):
        """Press the emergency stop."""
        self.button.pressed = True
        self.happens("stop is pressed")

    def release(self):
        """Release the emergency stop, which does not start the robot."""
        self.button.pressed = False
        self.happens("stop is released")

    def go_on(self, words):
        """Press continue."""
        self.happens(words)
        self.say(GO_ON, {})

    def happens(self, words):
        """Record an event for the picture."""
        self.happenings.append(Happening(self.time, self.world.pose.x, self.world.pose.y, words))
        self._note("happening", words)

    def _deliver(self, topic, data):
        for device in self.devices:
            if topic in device.hears:
                device.hear(self.world, topic, data)

    def _server(self, action):
        return next(device for device in self.devices if action in device.serves)

    def _due(self, period):
        return self.world.steps % round(period / STEP) == 0

    def _play(self):
        """Continue the script while its condition holds."""
        while not self.ended and self._waiting():
            try:
                self._wait_until(next(self._script))
            except StopIteration:
                self.ended = True

    def _wait_until(self, wanted):
        """Set the condition of the script: a number of seconds, or a function."""
        if callable(wanted):
            self._waiting = wanted
        else:
            until = self.time + wanted - STEP / 2
            self._waiting = lambda: self.time >= until

    def _trace(self):
        world = self.world
        self.pillars += [pillar for pillar in world.pillars if pillar not in self.pillars]
        self.ways["robot"].append((world.pose.x, world.pose.y))
        for name, body in (("ball", world.ball), ("person", world.person)):
            if body:
                self.ways[name].append((body.x, body.y))
        self._note("pose", self.scenario.pose(world))

    def _note(self, topic, data):
        if topic.endswith("/scan"):
            # The distance of the nearest thing ahead, which controllers use. None without one.
            ranges = data["ranges"]
            nearest = min(ranges[:21] + ranges[-20:] if topic == "/scan" else ranges)
            data = nearest if nearest < math.inf else None
        if topic != "/odom":
            self.record.append({"time": round(self.time, 3), "topic": topic, "data": data})


def _taken(items):
    """Empty a list and return its elements."""
    taken, items[:] = list(items), []
    return taken
