"""The robot's side of a node under test: publishers, listeners and servers, correct or faulty, by command.

python3 peer.py 1|2 NAME

Reads commands from standard input, one JSON object a line, such as `{"do": "silence", "topic": "/scan"}`. The values of
`do` are the public methods of `Peer`. Each command gets a line `{"did": ..., "result": ...}`. Each other event is a
line, too: `{"heard": topic, "at": seconds, "data": ...}`, `{"called": number}`, `{"goal": number}`,
`{"cancel": number}`, `{"sent": topic, "count": ...}`. Servers of the node under test cause `{"answered": number}`,
`{"accepted": number, "yes": ...}`, `{"feedback": number}`, `{"ended": number, "how": ...}` and
`{"cancel_answered": number, "yes": ...}`. The program ends at the end of its input.
"""

import importlib
import json
import os
import sys
import threading
import time
import traceback
from pathlib import Path
from queue import Queue

sys.path.append(str(Path(__file__).parents[1]))
from topics import fill, plain, type_of

PATIENCE = 120.0


class Peer:
    """A node on the robot's side. It numbers incoming calls and goals from 0."""

    def __init__(self, version, name, say):
        self.say = say
        self.ros = importlib.import_module(f"ros{version}_peer").Ros(name)
        self.publishers = {}
        self.repeating = {}
        self.calls = []
        self.goals = []
        self.sent = []
        self.at_once = {}
        self.simulated = None

    def listen(self, topic, kind, latched=False):
        def tell(message):
            self.say(heard=topic, at=time.monotonic(), data=plain(message))

        self.ros.listen(topic, type_of(kind), tell, latched)

    def advertise(self, topic, kind, **qos):
        self.publishers[topic] = (type_of(kind), self.ros.publisher(topic, type_of(kind), qos))

    def withdraw(self, topic):
        self.ros.withdraw(self.publishers.pop(topic)[1])

    def listeners(self, topic):
        return self.ros.listeners(self.publishers[topic][1])

    def asked_for(self, topic):
        """Return the reliability that each listener of the topic requests (ROS 2)."""
        return self.ros.asked_for(topic)

    def publish(self, topic, fields):
        kind, publisher = self.publishers[topic]
        publisher.publish(fill(kind(), fields))

    def repeat(self, topic, fields, hz):
        """Publish a message repeatedly, instead of the previous one; return after its first publication."""
        self.silence(topic)
        stop, sent = threading.Event(), threading.Event()
        thread = threading.Thread(target=self._repeat, args=[topic, fields, 1 / hz, stop, sent], daemon=True)
        self.repeating[topic] = (stop, thread)
        thread.start()
        sent.wait()

    def _repeat(self, topic, fields, period, stop, sent):
        while not stop.is_set():
            self.publish(topic, fields)
            sent.set()
            stop.wait(period)

    def silence(self, topic):
        """Stop the repeated message; return after its last publication."""
        if topic in self.repeating:
            stop, thread = self.repeating.pop(topic)
            stop.set()
            thread.join()

    def flood(self, topic, hz, count):
        """Publish the numbers from 1 to `count`; report their count at the end."""
        threading.Thread(target=self._flood, args=[topic, hz, count], daemon=True).start()

    def _flood(self, topic, hz, count):
        start = time.monotonic()
        sent = 0
        while sent < count:
            due = min(count, int((time.monotonic() - start) * hz))
            for number in range(sent + 1, due + 1):
                self.publish(topic, {"data": number})
            sent = due
            time.sleep(0.002)
        self.say(sent=topic, count=sent, seconds=time.monotonic() - start)

    def clock(self, seconds):
        """Publish simulated time from a certain second on; None stops the clock."""
        if "/clock" not in self.publishers:
            self.advertise("/clock", "rosgraph_msgs/Clock")
            threading.Thread(target=self._clock, daemon=True).start()
        self.simulated = None if seconds is None else (seconds, time.monotonic())

    def _clock(self):
        kind, publisher = self.publishers["/clock"]
        now = 0.0
        while True:
            if self.simulated:
                now = self.simulated[0] + time.monotonic() - self.simulated[1]
            publisher.publish(kind(clock=self.ros.time(now)))
            time.sleep(0.005)

    def serve(self, name, kind):
        """Offer a service. `answer`, or `answer_at_once` in advance, determines the result of a call."""
        self.ros.serve(name, kind, self._called)

    def _called(self, request):
        number, answers = len(self.calls), Queue()
        self.calls.append(answers)
        self.say(called=number, at=time.monotonic(), data=plain(request))
        return self.at_once.get("answer") or answers.get(timeout=PATIENCE)

    def answer_at_once(self, fields):
        """Set the immediate answer to all later calls; None lets them wait for `answer`."""
        self.at_once["answer"] = fields

    def answer(self, number, fields):
        """Answer a call; without fields the call fails."""
        self.calls[number].put(fields)

    def act(self, name, kind):
        """Offer an action. `decide`, `progress` and `end` determine the course of a goal."""
        self.ros.act(name, kind, self._asked, self._cancelled)

    def _asked(self, goal, request):
        goal.number = len(self.goals)
        self.goals.append(goal)
        goal.decision = Queue()
        self.say(goal=goal.number, at=time.monotonic(), data=plain(request))
        if self.at_once.get("accept"):
            goal.decision.put(True)
        if self.at_once.get("succeed"):
            threading.Thread(target=goal.end, args=["succeeded"], daemon=True).start()

    def _cancelled(self, goal):
        self.say(cancel=goal.number, at=time.monotonic())
        return self.at_once.get("cancel", "grant")

    def accept_at_once(self, accept, succeed=False):
        """Set whether all later goals are accepted and succeed at once, or wait for a decision."""
        self.at_once |= {"accept": accept, "succeed": accept and succeed}

    def on_cancel(self, answer):
        """Set the answer to requests to cancel: `grant`, `ignore` (granted, but the goal goes on), `refuse`, `mistake`.

        `mistake` cancels another goal (ROS 2).
        """
        self.at_once["cancel"] = answer
        self.ros.mistaken = answer == "mistake"

    def decide(self, number, accept):
        """Accept or reject a goal."""
        self.goals[number].decision.put(accept)

    def progress(self, number, fields):
        """Send feedback on a goal."""
        self.goals[number].progress(fields)

    def end(self, number, how, fields=None):
        """End an accepted goal as `succeeded`, `aborted` or `cancelled`, with fields of its result.

        With `open`, the result has a status that is no end, and the goal goes on.
        """
        self.goals[number].end(how, fields or {})

    def call(self, name, kind, fields):
        """Call a service of the node; return the number of the call. A failed call has null as its data."""
        number = len(self.sent)
        self.sent.append(None)


        def answered(response):
            self.say(answered=number, data=None if response is None else plain(response))

        self.ros.call(name, kind, fields, answered)
        return number

    def start(self, name, kind, fields):
        """Send a goal to an action of the node; return its number."""
        number = len(self.sent)
        self.sent.append(
            self.ros.start(
                name,
                kind,
                fields,
                accepted=lambda yes: self.say(accepted=number, yes=yes),
                progress=lambda feedback: self.say(feedback=number, data=plain(feedback)),
                ended=lambda how, result: self.say(ended=number, how=how, data=plain(result)),
                cancelled=lambda yes: self.say(cancel_answered=number, yes=yes),
            )
        )
        return number

    def cancel(self, number):
        """Ask the node to cancel a goal that it has accepted. Only ROS 2 answers that."""
        self.sent[number].cancel()

    def cancel_elsewhere(self, number):
        """Cancel an accepted goal from another client; the goal goes on until `end`."""
        self.goals[number].cancel_elsewhere()


def main(version, name):
    lock = threading.Lock()

    def say(**what):
        line = json.dumps(what) + "\n"
        with lock:
            sys.stdout.write(line)
            sys.stdout.flush()

    peer = Peer(version, name, say)
    say(did="start", result=None)
    for line in sys.stdin:
        command = json.loads(line)
        do = command.pop("do")
        try:
            say(did=do, result=getattr(peer, do)(**command))
        except Exception:  # the test prints the error
            say(did=do, failed=traceback.format_exc())
    peer.ros.stop()
    # Exit without waiting for threads that still publish.
    os._exit(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
