"""Small worlds for the guards: devices that act and report, with faults, from a seed. Needs no robosc."""

from __future__ import annotations

import math
import random

from ..simulator.simulation import GoalNews, Message

STEPS_PER_SECOND = 20
#: Lengths of silences in seconds. None of them is a patience of a guard.
SILENCES = (0.3, 0.75, 1.2, 6.3)
#: The share of messages that a silence follows.
SILENT = 0.02


class SmallWorld:
    """A base and action servers, with the interface of `simulator.simulation.Simulation` for a guard.

    `advance` runs one step of time and returns the messages and news of goals that are sent after it. `danger` returns
    the hazard that the guard has not prevented.
    """

    #: Actions and services of the robot.
    serves: tuple = ()
    answers: tuple = ()

    def __init__(self, seed=0):
        self.random = random.Random(f"{type(self).__name__}/{seed}")  # noqa: S311  # not used for security
        self.base = Base(self)
        self.servers = {action: Server(self, action) for action in self.serves}
        self._steps = 100 * STEPS_PER_SECOND
        self._sent = []
        self._silent_until = {}
        self._begun = {}

    @property
    def time(self):
        """Seconds."""
        return self._steps / STEPS_PER_SECOND

    def advance(self):
        """Run one step of time. Return what the world sends."""
        self._steps += 1
        self.live()
        for server in self.servers.values():
            server.act()
        sent, self._sent = self._sent, []
        return sent

    def live(self):
        """Move the base. Subclasses let people and devices act, and devices report."""
        self.base.act()

    def danger(self):
        """Return the present hazard, or None."""
        return

    def every(self, seconds):
        """Return whether a device with this period reports now."""
        return self._steps % round(seconds * STEPS_PER_SECOND) == 0

    def happens(self, per_second):
        """Return whether a random event with this frequency happens now."""
        return self.random.random() < per_second / STEPS_PER_SECOND

    def say(self, topic, data):
        """Send a message, unless its device is silent at the moment. Return whether it is sent."""
        if self.time < self._silent_until.get(topic, 0.0):
            return False
        self._sent.append(Message(topic, data))
        if self.random.random() < SILENT:
            self._silent_until[topic] = self.time + self.random.choice(SILENCES) - 0.01
        return True

    def tell(self, news):
        """Send news of a goal."""
        self._sent.append(news)

    def lasts(self, key, holds, seconds):
        """Return whether something has held for more than some seconds."""
        if not holds:
            self._begun.pop(key, None)
        return holds and self.time - self._begun.setdefault(key, self.time) > seconds

    def receive(self, topic, data):
        """Drive at a velocity."""
        del topic
        self.base.obey(data)

    def start(self, action, goal, data):
        """Accept or reject a goal. Return whether it is accepted."""
        return self.servers[action].accept(goal, data)

    def result(self, action, what):
        """Return the result of a goal that ends."""
        del action, what
        return {}

    def cancel(self, action, goal):
        """Request the end of a goal. Return whether it will end; None if the server refuses."""
        return self.servers[action].cancel(goal)


class Base:
    """Wheels that need time to brake, and stop by themselves half a second after the last velocity."""

    timeout, acceleration = 0.5, 3.0

    def __init__(self, world):
        self._world = world
        self.speed = self.turn = self._wanted = self._turn = 0.0
        self._obeyed = -math.inf

    def obey(self, data):
        """Take a velocity."""
        self._wanted, self._turn = (max(-2.0, min(wish, 2.0)) for wish in (data["linear"]["x"], data["angular"]["z"]))
        self._obeyed = self._world.time

    def act(self):
        """Move. Return the distance."""
        if self._world.time - self._obeyed > self.timeout:
            self._wanted = self._turn = 0.0
        change = self.acceleration / STEPS_PER_SECOND
        self.speed += max(-change, min(change, self._wanted - self.speed))
        self.turn += max(-change, min(change, self._turn - self.turn))
        return self.speed / STEPS_PER_SECOND

    @property
    def moves(self):
        """Whether the base moves."""
        return math.hypot(self.speed, self.turn) > 0.01


class Server:
    """An action server as they are: it rejects goals, aborts and loses them, refuses cancels, and needs time to brake.

    A goal that is lost for its clients may still move the robot, until the next goal begins or it has ended by itself.
    """

    rejects, refuses, loses, aborts = 0.05, 0.1, 0.1, 0.1

    def __init__(self, world, action):
        self._world, self._action = world, action
        self._goal = None
        self._until = self._ghost_until = -math.inf
        self._canceled = self._refused = False
        self.data = None

    @property
    def moves(self):
        """Whether a goal moves the robot."""
        return self._goal is not None or self._world.time < self._ghost_until

    @property
    def ghost(self):
        """Whether no client can stop the movement: the goal is lost, or the server has refused to cancel it."""
        return self._goal is None or self._refused

    def forget(self):
        """Leave a lost goal."""
        self._ghost_until = -math.inf

    def accept(self, goal, data):
        """Accept or reject a goal."""
        if self._world.random.random() < self.rejects:
            return False
        self._goal, self.data = goal, data
        self._canceled = self._refused = False
        self._ghost_until = -math.inf
        self._until = self._world.time + self._world.random.uniform(0.3, 4.0)
        return True

    def cancel(self, goal):
        """Accept or refuse to cancel a goal. Return False if it has ended."""
        if goal != self._goal:
            return False
        if self._world.random.random() < self.refuses:
            self._refused = True
            return None
        self._canceled = True
        self._until = min(self._until, self._world.time + self._world.random.uniform(0.1, 0.5))
        return True

    def act(self):
        """End a goal whose time has come."""
        if self._goal is None or self._world.time < self._until:
            return
        chance = self._world.random.random()
        if self._canceled:
            what = "canceled" if chance > 0.2 else "succeeded"
        elif chance < self.loses:
            what, self._ghost_until = "lost", self._world.time + self._world.random.uniform(0.5, 4.0)
        else:
            what = "aborted" if chance < self.loses + self.aborts else "succeeded"
        self._world.tell(GoalNews(self._action, self._goal, what, self._world.result(self._action, what)))
        self._goal = None
