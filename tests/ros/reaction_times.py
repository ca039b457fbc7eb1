"""Measure the reaction times of a line follower: the seconds from an input to the first zero on /cmd_vel.

python3 reaction_times.py 1|2 FILE --reason stop|obstacle [--times N] [--seed S] [--frozen SECONDS]

A `stop` is a press of the button, while another program publishes the sensors' messages. An `obstacle` is a scan in a
stream of scans of this program. The robot drives each time, and the moment is random.

Between the reactions the program measures the round trips of `echo.py`. `--frozen` is for a node in simulated time
with a period of SECONDS: after one tick the clock stops, so that a reaction cannot come from a tick.
"""

import argparse
import json
import random
import sys
import time
from pathlib import Path

from topics import connect

HZ = 30
PATIENCE = 120.0
#: Maximum seconds for which the robot drives (one period of the control loop) and stands before the next input.
DRIVES, STANDS = 0.1, 0.02
CLEAR, BLOCKED = {"ranges": [2.0] * 360}, {"ranges": [0.3] * 360}


class World:
    """Environment of the line follower: its sensors, and its commands with their times."""

    def __init__(self, version, scans):
        self.version = version
        self.topics = connect(version, "world")
        self.commands = []
        self.answers = []
        self.topics.listen("/cmd_vel", "geometry_msgs/Twist", self._commanded)
        self.topics.listen("/answer", "std_msgs/Int32", self._answered)
        self.button = self.topics.publisher("/emergency_stop", "std_msgs/Bool")
        self.go_on = self.topics.publisher("/continue", "std_msgs/Empty")
        self.scan = self.topics.publisher("/scan", "sensor_msgs/LaserScan") if scans else None
        self.correct = self.topics.publisher("/correction", "std_msgs/Float32") if scans else None
        self.ask = self.topics.publisher("/question", "std_msgs/Int32")
        self.seen, self.pressed = CLEAR, False
        self._due = time.monotonic()

    def _commanded(self, message):
        self.commands.append((time.perf_counter(), message.linear.x))

    def _answered(self, message):
        self.answers.append((time.perf_counter(), message.data))

    def live(self, seconds):
        """Let time pass; publish the scans and the state of the button when they are due."""
        until = time.monotonic() + seconds
        while True:
            now = time.monotonic()
            if now >= self._due:
                self.sense()
            left = until - now
            if left <= 0:
                return
            self.topics.receive(min(left, max(0.0, self._due - now)))

    def sense(self):
        """Publish the sensors and the button now; the next publication follows after one period."""
        self.button(data=self.pressed)
        if self.scan:
            self.scan(**self.seen)
            self.correct(data=10.0)
        self._due = time.monotonic() + 1 / HZ

    def wait(self, condition, what, period=0.002):
        """Let time pass until a condition holds, and check it once in each period."""
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                sys.exit(f"{what}: not within {PATIENCE} s")
            self.live(period)

    def drive(self):
        """Release the button, and press continue until the robot drives."""
        since = len(self.commands)
        self.seen, self.pressed = CLEAR, False
        self.sense()

        def drives():
            self.go_on()
            return any(sent for _, sent in self.commands[since:])

        self.wait(drives, "the robot drives", 0.05)

    def reaction(self):
        """Publish the new input; return the seconds to the first command to stand."""
        since = len(self.commands)
        began = time.perf_counter()
        self.sense()

        def found():
            return next((at for at, sent in self.commands[since:] if not sent), None)

        self.wait(found, "the robot stands")
        return found() - began

    def start(self):
        """Wait until the node is connected."""
        self.wait(self.topics.heard, "the node listens")

    def start_frozen(self, period):
        """Start like `start`, with a clock that permits exactly one tick."""
        send = self.topics.publisher("/clock", "rosgraph_msgs/Clock")

        def clock(seconds):
            send(clock={"secs": seconds} if self.version == "1" else {"sec": seconds})
            self.live(0.1)

        def ticked():
            clock(1000 + 2 * period)
            return self.commands

        self.wait(lambda: clock(1000) or self.topics.heard(), "the node listens")
        for _ in range(10):
            clock(1000)
        self.seen = BLOCKED
        self.wait(ticked, "the node's first tick")
        self.live(0.5)

    def round_trip(self, number):
        """Return the seconds to the answer of the echo."""
        began = time.perf_counter()
        self.ask(data=number)
        self.wait(lambda: number in [answered for _, answered in self.answers[-3:]], "the echo answers")
        return next(at for at, answered in reversed(self.answers) if answered == number) - began


def measure(world, options):
    """Return the reaction times, and the round trips of the echo."""
    chance = random.Random(options.seed)  # noqa: S311  # no secret
    reactions, echoes = [], []
    for number in range(options.times):
        world.drive()
        world.live(chance.uniform(0, DRIVES))
        echoes.append(world.round_trip(number))
        if options.reason == "obstacle":
            world.seen = BLOCKED
        else:
            world.pressed = True
        reactions.append(world.reaction())
        world.live(chance.uniform(0, STANDS))
    return {"reactions": reactions, "echoes": echoes}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("version", choices=["1", "2"])
    parser.add_argument("file", type=Path)
    parser.add_argument("--reason", choices=["stop", "obstacle"], required=True)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--frozen", type=int)
    options = parser.parse_args()
    world = World(options.version, scans=options.reason == "obstacle")
    if options.frozen:
        world.start_frozen(options.frozen)
    else:
        world.start()
    options.file.write_text(json.dumps(measure(world, options)))


if __name__ == "__main__":
    main()
