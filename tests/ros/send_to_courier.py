"""Send messages to the courier one by one, and write the resulting reports and messages of the node to a file.

python3 send_to_courier.py 1|2 FILE
"""

import json
import math
import sys
import time
from pathlib import Path

from topics import connect, plain, type_of

SENT = {
    "target": "geometry_msgs/PoseStamped",
    "sum": "std_msgs/UInt8",
    "ratio": "std_msgs/Float32",
    "report": "std_msgs/String",
    "busy": "std_msgs/Bool",
}
PATIENCE = 120.0


def scan(ranges, angle_min=0.0):
    return "scan", {"ranges": ranges, "angle_min": angle_min}


#: Name of the step, topic, and fields. `EVENTS` has an event of the batch that the node makes of the topic.
STEPS = [
    ("no angle", *scan([3.0, 0.5, 3.0, 7.0], math.nan)),
    ("ahead", *scan([0.5, 3.0, 3.0, 7.0], 1.0)),
    ("short", *scan([0.625])),
    ("infinite", *scan([0.5, 3.0, 3.0, math.inf])),
    ("empty", *scan([])),
    ("left", *scan([3.0, 0.5, 3.0, 1.0], 2.0)),
    ("swapped", *scan([0.5, 3.0, 3.0, 1.0])),
    ("high count", "count", {"data": 30000}),
    ("low count", "count", {"data": -32768}),
    ("division by zero", "count", {"data": 299}),
    ("word", "word", {"data": 'idle "ü" \\ \n'}),
    ("idle", "word", {"data": "idle"}),
]
EVENTS = {"scan": "side", "count": "size", "word": "word"}


def lasting(seen):
    """Return the observations without counters and times of messages."""
    sent = {topic: {**message, "header": None} for topic, message in seen["sent"].items()}
    return seen["components"], sent, {**seen["typed"], "header": None}


class Session:
    def __init__(self, version):
        self.topics = connect(version, "client")
        self.reports = []
        self.sent = {topic: [] for topic in SENT}
        self.topics.listen("/courier_controller/state", "std_msgs/String", self.report)
        #: A compiled node also publishes its state as a typed message.
        self.typed = {}
        try:
            type_of("courier_msgs/State")
        except ImportError:
            self.tells_type = False
        else:
            self.tells_type = True
            self.topics.listen("/courier_controller/typed_state", "courier_msgs/State", self.type)
        for topic, kind in SENT.items():
            self.topics.listen(topic, kind, lambda message, topic=topic: self.sent[topic].append(plain(message)))
        self.senders = {
            "scan": self.topics.publisher("/scan", "sensor_msgs/LaserScan"),
            "count": self.topics.publisher("count", "std_msgs/Int16"),
            "word": self.topics.publisher("word", "std_msgs/String"),
        }

    def report(self, message):
        self.reports.append(json.loads(message.data))

    def type(self, message):
        self.typed = plain(message)

    def wait(self, condition):
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                raise TimeoutError(f"nothing within {PATIENCE} s; the last report was {self.reports[-1:]}")
            self.topics.receive(0.02)

    def rest(self):
        """Return the reports and messages of some ticks, as soon as the next ticks repeat them.

        ROS does not preserve order across topics: a message may arrive before one that was sent earlier.
        """
        seen, before = self.ticks(), None
        until = time.monotonic() + PATIENCE
        while (now := lasting(seen)) != before or set(seen["sent"]) != seen["told"]:
            if time.monotonic() > until:
                raise TimeoutError(f"it does not come to rest; the last that was seen is {seen}")
            seen, before = self.ticks(), now
        return {key: seen[key] for key in ("components", "sent", "typed")}

    def ticks(self):
        """Return reports and messages of the next ticks, and the topics that the reports mention."""
        start = len(self.reports)
        for messages in self.sent.values():
            messages.clear()
        self.wait(lambda: len(self.reports) >= start + 3)
        happened = {event for report in self.reports[start:] for event in report["transitions"]}
        told = {topic for topic in SENT if f"message_{topic}.c_trigger" in happened}
        self.wait(lambda: all(self.sent[topic] for topic in told))
        sent = {topic: messages[-1] for topic, messages in self.sent.items() if messages}
        return {"components": self.reports[-1]["components"], "sent": sent, "told": told, "typed": self.typed}

    def step(self, topic, fields):
        start = len(self.reports)
        event = f"message_{EVENTS[topic]}.u_response"
        self.senders[topic](**fields)
        self.wait(lambda: any(event in report["transitions"] for report in self.reports[start:]))
        return self.rest()


def main(version, path):
    session = Session(version)
    session.wait(lambda: session.topics.heard() and session.reports and (session.typed or not session.tells_type))
    results = {"start": session.rest()}
    for name, topic, fields in STEPS:
        results[name] = session.step(topic, fields)
    Path(path).write_text(json.dumps(results), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
