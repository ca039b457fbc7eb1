"""Measure the delays of a node's timer: write the seconds from each press of a button to the beep 200 ms after it.

python3 expiry_times.py 1|2 FILE [--times N] [--hz HZ]

The program publishes scans at HZ meanwhile.
"""

import argparse
import json
import random
import sys
import time
from pathlib import Path

from topics import connect

PATIENCE = 120.0
SCAN = {"ranges": [2.0] * 360}


class World:
    """The button, the listener to the beep, and the lidar."""

    def __init__(self, version, hz):
        self.beeps = []
        self.period = 1 / hz
        self.due = time.monotonic()
        self.topics = connect(version, "world")
        self.topics.listen("/beep", "std_msgs/Empty", lambda _: self.beeps.append(time.perf_counter()))
        self.press = self.topics.publisher("/pressed", "std_msgs/Empty")
        self.scan = self.topics.publisher("/scan", "sensor_msgs/LaserScan")

    def live(self, seconds):
        """Let time pass, and publish scans when they are due."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            if time.monotonic() >= self.due:
                self.scan(**SCAN)
                self.due = time.monotonic() + self.period
            self.topics.receive(max(0.0, min(left, self.due - time.monotonic())))

    def wait(self, condition, what):
        """Let time pass until a condition holds."""
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                sys.exit(f"{what}: not within {PATIENCE} s")
            self.live(0.002)

    def start(self):
        """Wait until the node receives messages, reacts, and its messages arrive."""
        self.wait(self.topics.heard, "the node listens")

        def pressed():
            self.press()
            self.live(0.3)
            return bool(self.beeps)

        self.wait(pressed, "the node beeps")
        self.live(0.5)

    def expiry(self):
        """Return the seconds from a press to the beep."""
        heard = len(self.beeps)
        began = time.perf_counter()
        self.press()
        self.wait(lambda: len(self.beeps) > heard, "the node beeps")
        return self.beeps[heard] - began


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("version")
    parser.add_argument("file", type=Path)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--hz", type=float, default=30.0)
    options = parser.parse_args()
    world = World(options.version, options.hz)
    world.start()
    choice = random.Random(1)  # noqa: S311
    found = []
    for _ in range(options.times):
        world.live(choice.uniform(0.02, 0.12))
        found.append(world.expiry())
    options.file.write_text(json.dumps(found))


if __name__ == "__main__":
    main()
