"""Measures how late a node's time is up: writes the seconds from a press of a button to the beep 200 ms after it.

python3 expiry_times.py 1|2 FILE [--times N] [--hz HZ]

Meanwhile scans are sent, so many a second.
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
    """Presses the button and hears the beep, and is the lidar meanwhile."""

    def __init__(self, version, hz):
        self.beeps = []
        self.period = 1 / hz
        self.due = time.monotonic()
        self.topics = connect(version, "world")
        self.topics.listen("/beep", "std_msgs/Empty", lambda _: self.beeps.append(time.perf_counter()))
        self.press = self.topics.publisher("/pressed", "std_msgs/Empty")
        self.scan = self.topics.publisher("/scan", "sensor_msgs/LaserScan")

    def live(self, seconds):
        """Time passes; scans are sent when they are due."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            if time.monotonic() >= self.due:
                self.scan(**SCAN)
                self.due = time.monotonic() + self.period
            self.topics.receive(max(0.0, min(left, self.due - time.monotonic())))

    def wait(self, condition, what):
        """Lives until a condition holds."""
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                sys.exit(f"{what}: not within {PATIENCE} s")
            self.live(0.002)

    def start(self):
        """Waits until the node hears, acts and is heard."""
        self.wait(self.topics.heard, "the node listens")

        def pressed():
            self.press()
            self.live(0.3)
            return bool(self.beeps)

        self.wait(pressed, "the node beeps")
        self.live(0.5)

    def expiry(self):
        """Seconds from a press to the beep."""
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
