"""A simulation on the topics of a middleware. `ros1` and `ros2` implement it."""

from __future__ import annotations

import queue
import time
from abc import ABC, abstractmethod

from .simulation import Answer, GoalNews, Order

#: The initial time on the clocks of ROS: a clock at 0 counts as none.
EPOCH = 1.0


class Connection(ABC):
    """Topics and actions of a simulation. Incoming data waits until `receive`, so that one thread handles all of it.

    `answered`: whether a controller has sent anything. `last_heard`: the time of its last data, in the world's time.
    """

    def __init__(self, simulation):
        self.simulation = simulation
        self.answered = False
        self.last_heard = 0.0
        self._inbox = queue.SimpleQueue()
        self._calls = []
        self._ended = False
        #: The number of own messages on each topic that will come back.
        self._echoes = dict.fromkeys(set(simulation.says) & set(simulation.hears), 0)

    def waits_for(self):
        """Return the topics without a listener, apart from the simulation's own devices, and the missing servers."""
        needed = (say for say in self.simulation.says if say not in self.simulation.scenario.unheard)
        topics = [topic for topic in needed if self.listeners(topic) <= (topic in self._echoes)]
        return topics + [name for name in (*self.simulation.calls, *self.simulation.goals) if not self.serves(name)]

    def send(self, item):
        """Send a message, an answer or news of a goal."""
        if isinstance(item, Answer):
            item.call.put(item.data)
            return
        if isinstance(item, GoalNews):
            self.tell(item)
            return
        if isinstance(item, Order):
            self.order(item.name, item.data, lambda answer: self.later(lambda: self._answered(item.name, answer)))
            return
        if item.topic in self._echoes:
            self._echoes[item.topic] += 1
        self.publish(item.topic, item.data)

    def heard(self, topic, data):
        """Queue a received message. Any thread may call this."""
        self._inbox.put(lambda: self._receive(topic, data))

    def asked(self, service, data):
        """Call a service of the simulation and wait for its answer. Any thread may call this."""
        call = queue.SimpleQueue()
        self._calls.append(call)
        if self._ended:
            return {}
        self.later(lambda: self.simulation.ask(service, call, data))
        return call.get()

    def hang_up(self):
        """Answer all calls with empty data, because no other answer will follow."""
        self._ended = True
        for call in self._calls:
            call.put({})

    def alive(self):
        """Record that the controller is running. Any thread may call this."""
        self.later(self._lives)

    def later(self, call):
        """Queue a function for `receive`. Any thread may call this."""
        self._inbox.put(call)

    def receive(self, seconds):
        """Wait this time, in real time, and handle incoming data."""
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

    def _answered(self, name, data):
        self._lives()
        self.simulation.answered(name, data)

    def _lives(self):
        self.answered = True
        self.last_heard = self.simulation.time

    @abstractmethod
    def listeners(self, topic):
        """Return the number of listeners of a topic."""

    @abstractmethod
    def serves(self, name):
        """Return whether the controller serves a service or an action."""

    @abstractmethod
    def order(self, name, data, answered):
        """Call a service of the controller, or send a goal to one of its actions. Any thread calls `answered`."""

    @abstractmethod
    def clock(self, seconds):
        """Publish the time."""

    @abstractmethod
    def publish(self, topic, data):
        """Send a message."""

    @abstractmethod
    def tell(self, news):
        """Send news of a goal to its client."""

    @abstractmethod
    def spin(self, seconds):
        """Let the middleware work until something arrives, at most this time."""

    @abstractmethod
    def close(self):
        """End the connection."""


class UnknownTypeError(Exception):
    """A missing package of ROS types."""

    def __init__(self, kind):
        package = kind.split("/")[0]
        super().__init__(f"no type {kind}: is the package {package} installed, or built and sourced?")
