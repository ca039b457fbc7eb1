"""Random data of commands: functions from random numbers and the time to data. Needs no robosc."""

from __future__ import annotations

import math

#: Numbers that programs send by mistake.
WRONG = (math.nan, math.inf, -math.inf, 1e9)


def number(numbers, most, wrong=0.02):
    """Return a number of at most this size, now and then a wrong one."""
    return numbers.choice(WRONG) if numbers.random() < wrong else numbers.uniform(-most, most)


def twist(numbers, time=0.0, most=1.5, wrong=0.02):
    """Return a velocity: often straight ahead, often only a turn, sometimes a stop.

    The angular velocity around x, which no wheel obeys, marks the message: it equals no other one, and no stop of a
    guard.
    """
    del time
    kind = numbers.random()
    ahead = 0.0 if kind < 0.3 else number(numbers, most, wrong) if kind < 0.6 else numbers.uniform(0.0, most)
    turn = 0.0 if 0.2 < kind < 0.4 else number(numbers, most, wrong)
    linear = {"x": ahead, "y": 0.0, "z": 0.0}
    return {"linear": linear, "angular": {"x": numbers.uniform(1e-3, 2e-3), "y": 0.0, "z": turn}}


def stamped_twist(numbers, time):
    """Return a velocity with a stamp: often a recent one, sometimes an old one or one of the future."""
    at = time - numbers.choice((0.0, 0.02, 0.1, 0.2, 0.45, 1.0, 30.0, -0.6, time))
    return {"header": {"stamp": stamp(at), "frame_id": ""}, "twist": twist(numbers, wrong=0.0)}


def stamp(time):
    """Return a time in the form of ROS."""
    return {"sec": math.floor(time), "nanosec": round(time % 1 * 1e9) % 1_000_000_000}


def destination(width, height, frames=("map", "map", "map", "odom", "")):
    """Return a function for goals of navigation, with positions of at most this size."""

    def compose(numbers, time):
        position = {"x": number(numbers, width), "y": number(numbers, height), "z": 0.0}
        pose = {"position": position, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
        header = {"stamp": stamp(time), "frame_id": numbers.choice(frames)}
        return {"pose": {"header": header, "pose": pose}, "behavior_tree": ""}

    return compose


def nothing(numbers, time):
    """Return a command without data. A number marks it."""
    del time
    return {"mark": numbers.random()}
