"""Publish the sensors of a line follower with the line in view and a clear way, until interrupted.

python3 sensors.py 1|2 HZ [--going]

With `--going`, also publish a released button and repeated presses of continue.
"""

import sys
import time

from reaction_times import CLEAR
from topics import connect


def main(version, hz, *options):
    topics = connect(version, "sensors")
    scan, correct = (
        topics.publisher(topic, kind)
        for topic, kind in (("/scan", "sensor_msgs/LaserScan"), ("/correction", "std_msgs/Float32"))
    )
    button, go_on = None, None
    if options:
        button = topics.publisher("/emergency_stop", "std_msgs/Bool")
        go_on = topics.publisher("/continue", "std_msgs/Empty")
    due = time.monotonic()
    while True:
        if options:
            button(data=False)
            go_on()
        scan(**CLEAR)
        correct(data=10.0)
        due = max(due + 1 / float(hz), time.monotonic())
        topics.receive(due - time.monotonic())


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(0)
