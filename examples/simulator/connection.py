"""A simulation on the topics of a middleware; `ros1` and `ros2` bring them."""

from __future__ import annotations

import queue
import time
from abc import ABC, abstractmethod

from .simulation import Answer, GoalNews

#: What the clocks of ROS show at the start: a clock that shows 0 counts as none.
EPOCH = 1.0


class Connection(ABC):
    """Topics and actions of a simulation. What comes in waits until it is received: all happens in one thread.

    `answered`: whether a controller ever sent something; `last_heard` is when, in the world's time, it last did.
    """

    def __init__(self, simulation):
        self.simulation = simulation
        self.answered = False
        self.last_heard = 0.0
        self._inbox = queue.SimpleQueue()
        self._calls = []
        self._ended = False
        #: How often what we have sent is still to come back to ourselves.
        self._echoes = dict.fromkeys(set(simulation.says) & set(simulation.hears), 0)

    def waits_for(self):
        """Topics that nobody listens to yet, the simulation's own devices aside."""
        needed = (say for say in self.simulation.says if say not in self.simulation.scenario.unheard)
        return [topic for topic in needed if self.listeners(topic) <= (topic in self._echoes)]

    def send(self, item):
        """Sends a message, an answer or news of a goal."""
        if isinstance(item, Answer):
            item.call.put(item.data)
            return
        if isinstance(item, GoalNews):
            self.tell(item)
            return
        if item.topic in self._echoes:
            self._echoes[item.topic] += 1
        self.publish(item.topic, item.data)

    def heard(self, topic, data):
        """Keeps a message that has come in; from any thread."""
        self._inbox.put(lambda: self._receive(topic, data))

    def asked(self, service, data):
        """What the simulation answers to a call of a service; from any thread, which waits for it."""
        call = queue.SimpleQueue()
        self._calls.append(call)
        if self._ended:
            return {}
        self.later(lambda: self.simulation.ask(service, call, data))
        return call.get()

    def hang_up(self):
        """Answers all calls with nothing: nobody else will."""
        self._ended = True
        for call in self._calls:
            call.put({})

    def alive(self):
        """Takes it that the controller is there; from any thread."""
        self.later(self._lives)

    def later(self, call):
        """Keeps something to be done when things are received; from any thread."""
        self._inbox.put(call)

    def receive(self, seconds):
        """Waits so long, in real time, and takes what has come in."""
        until = time.monotonic() + seconds
        while True:
            self.spin(max(0.0, until - time.monotonic()))
            while not self._inbox.empty():
                self._inbox.get()()
            if time.monotonic() >= until:
                return

    def _receive(self, topic, data):
        if self._echoes.get(topic):
            self._echoes[topic] -= 1
        else:
            self._lives()
            self.simulation.receive(topic, data)

    def _lives(self):
        self.answered = True
        self.last_heard = self.simulation.time

    @abstractmethod
    def listeners(self, topic):
        """How many listen to a topic."""

    @abstractmethod
    def clock(self, seconds):
        """Tells everyone the time."""

    @abstractmethod
    def publish(self, topic, data):
        """Sends a message."""

    @abstractmethod
    def tell(self, news):
        """Sends news of a goal to whoever set it."""

    @abstractmethod
    def spin(self, seconds):
        """Lets the middleware work until something comes in, at most so long."""

    @abstractmethod
    def close(self):
        """Ends the connection."""


class UnknownTypeError(Exception):
    """A package of ROS types is not there."""

    def __init__(self, kind):
        package = kind.split("/")[0]
        super().__init__(f"no type {kind}: is the package {package} installed, or built and sourced?")
