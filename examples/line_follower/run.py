"""Runs the demonstration over a middleware: `world_ros1.py` and `world_ros2.py` bring the connection.

In real time by default. With `--lockstep` the world gives the time (`/clock`; start the controller with `use_sim_time`)
and runs up to five times as fast, never further ahead of the last command than two ticks of the controller: what comes
out does not depend on how busy the machine is.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import queue
import sys
import time
from abc import ABC, abstractmethod
from pathlib import Path

from world import POSE_PERIOD, RANGE_MAX, RANGE_MIN, RAYS, STEP, Simulation

LOCKSTEP_SPEED = 5
ANSWER_WITHIN = 0.2
PATIENCE = 30.0

#: What happens in the world, in words.
SCENES = {
    "obstacle": "an obstacle stands on the line",
    "clear": "the obstacle is gone",
    "/stop": "someone presses the stop button",
    "/continue": "someone presses the continue button",
    "cover": "the line can't be seen",
    "uncover": "the line can be seen again",
    "end": "the end",
}


def said(text, stream=None):
    """Prints a line at once, also where the output is not a terminal."""
    print(text, file=stream or sys.stdout, flush=True)


class Connection(ABC):
    """Topics of a middleware. `topics` are the ones that it publishes; each command goes to `on_command`."""

    @abstractmethod
    def connected(self):
        """Whether somebody listens to every topic."""

    @abstractmethod
    def clock(self, seconds):
        """Tells everyone the time."""

    @abstractmethod
    def publish(self, topic, data, seconds):
        """Sends a number, ranges of the lidar, or nothing (None) to a topic, stamped with a time."""

    @abstractmethod
    def receive(self, seconds):
        """Waits so long, in real time, while commands come in."""

    @abstractmethod
    def close(self):
        """Ends the connection."""

    @staticmethod
    def scan_geometry():
        """What a lidar's message says beside the ranges."""
        return {
            "angle_min": 0.0,
            "angle_max": 2 * math.pi * (RAYS - 1) / RAYS,
            "angle_increment": 2 * math.pi / RAYS,
            "range_min": RANGE_MIN,
            "range_max": RANGE_MAX,
        }


class Runner:
    """A simulation, connected, with a record of everything that crosses the connection."""

    def __init__(self, connect, lockstep, record):
        self.simulation = Simulation()
        self.commands = queue.SimpleQueue()
        self.connection = connect(self.simulation.topics, lambda *speeds: self.commands.put(speeds))
        self.lockstep = lockstep
        self.record = record
        self.answered = 0.0

    def run(self):
        """Plays the scenario to its end; says whether it got there."""
        said("waiting for the controller on " + ", ".join(self.simulation.topics) + " ...")
        if not self.waited_for(self.connection.connected):
            return self.failed(f"no controller listens to all of these topics after {PATIENCE:.0f} s: is it started?")
        said("the controller is there: the world starts")
        started = time.monotonic()
        while not self.simulation.ended:
            messages = self.simulation.advance()
            for happening in self.simulation.happened:
                said(f"{self.simulation.time:4.0f} s  {SCENES.get(happening, happening)}")
            for topic, data in messages:
                self.connection.publish(topic, data, self.simulation.time)
                self.note(topic, self.in_short(data))
            if self.simulation.due(POSE_PERIOD):
                self.note("pose", self.simulation.pose())
            if self.lockstep:
                self.connection.clock(self.simulation.time)
                self.receive(STEP / LOCKSTEP_SPEED)
                if not self.waited_for(self.has_answer):
                    return self.failed(f"no command on /cmd_vel for {PATIENCE:.0f} s: the controller does not answer")
            else:
                self.receive(max(0.0, started + self.simulation.time - time.monotonic()))
        return True

    @staticmethod
    def failed(why):
        """Says on standard error why the scenario can't go on."""
        said(f"error: {why}", sys.stderr)
        return False

    def receive(self, seconds):
        """Waits, then obeys the commands that have come."""
        self.connection.receive(seconds)
        while not self.commands.empty():
            linear, angular = self.commands.get()
            self.simulation.world.command(linear, angular)
            self.answered = self.simulation.time
            self.note("/cmd_vel", [linear, angular])

    def has_answer(self):
        """Whether the last command is recent enough to drive on with."""
        return self.simulation.time - self.answered < ANSWER_WITHIN

    def waited_for(self, condition):
        """Waits until a condition holds; says whether it does. The time, where it was not heard, is told again."""
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                return False
            if self.lockstep:
                self.connection.clock(self.simulation.time)
            self.receive(0.02)
        return True

    def note(self, topic, data):
        """Writes a line to the record."""
        self.record.write(json.dumps({"time": round(self.simulation.time, 3), "topic": topic, "data": data}) + "\n")

    @staticmethod
    def in_short(data):
        """The data; of a scan only how far the nearest thing is (None: nothing was seen)."""
        if not isinstance(data, list):
            return data
        return None if math.isinf(min(data)) else min(data)


def main(connect, arguments):
    """The command line; the exit status is 0 where the scenario was played to its end."""
    parser = argparse.ArgumentParser(description="A simulated world with a line, an obstacle and a robot.")
    parser.add_argument("--lockstep", action="store_true", help="publish /clock and run as fast as commands come")
    parser.add_argument("--record", help="write what happened to this file, one JSON object a line")
    options = parser.parse_args(arguments)
    with Path(options.record or os.devnull).open("w", encoding="utf-8") as record:
        runner = Runner(connect, options.lockstep, record)
        try:
            return 0 if runner.run() else 1
        except KeyboardInterrupt:
            return 1
        finally:
            runner.connection.close()
