"""The judge of a guard: rules written by hand, without the model. Needs no robosc."""

from __future__ import annotations

import math

#: Seconds around a timeout in which the judge leaves its verdict open.
MOMENT = 0.061
ZERO = {"x": 0.0, "y": 0.0, "z": 0.0}
#: The stop that a guard sends in place of a velocity.
STOP = {"linear": ZERO, "angular": ZERO}


class Judge:
    """The knowledge of a guard, from what the world sent it, and its verdict on each command.

    Subclasses implement `heard`, `permits`, and where needed `limited`, `sent`, `ended` and `goes_on`.
    """

    #: Commands of the agent, by topic, service or action: functions from random numbers and the time to data.
    commands: dict = {}
    #: Commands that the agent sends more or less often than others, by a factor.
    weights: dict = {}
    #: Topics on which the guard sends this stop when it blocks a command after it forwarded one.
    replaced: dict = {}

    def __init__(self, time=0.0):
        self.time = time
        #: Goals and calls that have not ended, with their data.
        self.running = {}
        self._times = {}

    def receive(self, topic, data):
        """Handle a message of the world."""
        self.heard(topic, data)
        self._times[topic] = self.time

    def expect(self, name, data):
        """Return the permitted outcomes of a command: the data that reaches the world, or None if nothing does.

        There are two outcomes at the very moment of a timeout.
        """
        permitted = False if name in self.running else self.permits(name, data)
        passing = [] if permitted is False else self.limited(name, data)
        return passing if permitted else [*passing, None]

    def send(self, name, data, *, opens):
        """Handle a command that has passed. `opens`: it is a call or goal that now waits for its end."""
        if opens:
            self.running[name] = data
        self.sent(name, data)

    def answer(self, service, data):
        """Handle the answer of a service."""
        self.running.pop(service, None)
        self.ended(service, "answered", data)

    def tell(self, action, what, data):
        """Handle feedback or the end of a goal."""
        if what == "feedback":
            self.fed_back(data)
        else:
            self.running.pop(action, None)
            self.ended(action, what, data)

    def must_end(self, action):
        """Return whether a running goal must be canceled; None at the very moment of a timeout."""
        return opposite(self.goes_on(action, self.running[action])) if action in self.running else None

    def heard(self, topic, data):
        """Note a message."""

    def permits(self, name, data):
        """Return whether a command may pass; None if that depends on a timeout that is due now."""
        raise NotImplementedError

    def limited(self, name, data):
        """Return the data of a permitted command after its limits; two at the very moment of a timeout."""
        del name
        return [data]

    def sent(self, name, data):
        """Note a command that has reached the world."""

    def fed_back(self, data):
        """Note feedback of a goal."""

    def ended(self, name, what, data):
        """Note the end of a goal, or the answer of a service."""

    def goes_on(self, action, data):
        """Return whether a running goal may go on; None if that depends on a timeout that is due now."""
        return self.permits(action, data)

    def since(self, key):
        """Return the seconds since the last message of a topic, or since `note(key)`."""
        return self.time - self._times.get(key, -math.inf)

    def note(self, key):
        """Begin to count the seconds of a key."""
        self._times[key] = self.time

    def fresh(self, key, patience):
        """Return whether the last message is younger than a patience; None if it has just that age."""
        if abs(self.since(key) - patience) < MOMENT:
            return None
        return self.since(key) < patience

    def known(self):
        """Return the knowledge of the judge, for messages."""
        return ", ".join(f"{name}={value!r}" for name, value in vars(self).items() if not name.startswith("_"))


class Button:
    """An emergency stop that repeats whether it is pressed, latched until `continue` after a release."""

    def __init__(self, judge, patience=0.5):
        self._judge, self._patience = judge, patience
        self._released = self._going = False

    def heard(self, topic, data):
        """Note a message of the button or of `continue`."""
        silent = self._judge.fresh("/emergency_stop", self._patience) is False
        if silent:
            self._released = self._going = False
        if topic == "/emergency_stop":
            self._released = not data["data"]
            self._going = self._going and self._released
        elif topic == "/continue":
            # A message at the very moment of the timeout comes before it or after it.
            self._going = self._going or self._released

    @property
    def in_service(self):
        """Whether the robot may move; None at the very moment of the timeout."""
        return both(self._going, self._judge.fresh("/emergency_stop", self._patience))

    def __repr__(self):
        return f"going={self._going}"


def both(*claims):
    """Return the conjunction in three-valued logic; None is unknown."""
    return False if False in claims else None if None in claims else True


def either(*claims):
    """Return the disjunction in three-valued logic; None is unknown."""
    return True if True in claims else None if None in claims else False


def opposite(claim):
    """Return the negation in three-valued logic; None is unknown."""
    return None if claim is None else not claim


def finite(*numbers):
    """Return whether all numbers are finite."""
    return all(map(math.isfinite, numbers))
