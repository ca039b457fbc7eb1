"""Send velocities at a high rate to a layer and a relay, or receive what they forward.

    python3 layer_traffic.py send HZ TOPIC...
    python3 layer_traffic.py receive FILE TOPIC...

The sender publishes a velocity on each of the topics HZ times a second, evenly spread, but only a tenth of them on the
last topic. It publishes the sensors of a guarded base 10 times a second. Every second it moves an obstacle into or out
of the scan. A velocity has the time of its publication in `angular.x`. The receiver ends at an interrupt. FILE then has
three numbers for each velocity, all doubles: the number of its topic, the time of its receipt, and the seconds since
its publication.
"""

import signal
import sys
import time
from array import array
from pathlib import Path

import rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

try:
    from rclpy.experimental import EventsExecutor as Executor
except ImportError:
    from rclpy.executors import SingleThreadedExecutor as Executor

#: Rate of the sensors.
SENSORS_HZ = 10


def send(hz, *topics):
    node = rclpy.create_node("traffic_sender")
    publishers = [node.create_publisher(Twist, topic, 10) for topic in topics]
    scans = node.create_publisher(LaserScan, "/scan", qos_profile_sensor_data)
    buttons = node.create_publisher(Bool, "/emergency_stop", 10)
    scan, velocity = LaserScan(), Twist()
    velocity.linear.x = velocity.angular.z = 0.5
    step = 1 / float(hz) / (len(publishers) - 0.9)
    every = round(float(hz) / SENSORS_HZ)
    due, number = time.monotonic(), 0
    while True:
        if number % every == 0:
            scan.ranges = [0.4 if number // every // SENSORS_HZ % 2 else 2.0] * 360
            scans.publish(scan)
            buttons.publish(Bool())
        for publisher in publishers if number % 10 == 0 else publishers[:-1]:
            due += step
            time.sleep(max(0.0, due - time.monotonic()))
            velocity.angular.x = time.monotonic()
            publisher.publish(velocity)
        number += 1


def receive(file, *topics):
    node = rclpy.create_node("traffic_receiver")
    received = array("d")

    def listen(number, topic):
        def note(velocity):
            now = time.monotonic()
            received.extend((number, now, now - velocity.angular.x))

        node.create_subscription(Twist, topic, note, 1000)

    for number, topic in enumerate(topics):
        listen(float(number), topic)
    for name in ("plain_relay", "guarded_base_layer"):
        for kind, topic in ((LaserScan, "scan"), (Bool, "emergency_stop")):
            node.create_subscription(kind, f"/{name}/controller/{topic}", lambda _: None, 10)
    executor = Executor()
    executor.add_node(node)
    ended = []
    signal.signal(signal.SIGINT, lambda *_: ended.append(True))
    while not ended:
        executor.spin_once(timeout_sec=0.1)
    Path(file).write_bytes(received.tobytes())


if __name__ == "__main__":
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    {"send": send, "receive": receive}[sys.argv[1]](*sys.argv[2:])
