"""Runs a model as a node of ROS 2 that does nothing for a while, in which a scan arrives and a time is up.

python3 late_ros2.py controller|layer MODEL --ros-args -p event_log:=LOG

Prints when it goes on.
"""

import sys
import time
from pathlib import Path

import rclpy
from std_msgs.msg import Empty

from robosc.run.runtime.ros2.node import Ros2Node
from robosc.tools.cli import main

#: Twice as long as the model bears without a scan, and then some.
SLEEP = 2.0


def spin(node, handler):
    """In the place of the node's own."""
    handler.start()
    robot = rclpy.create_node("robot")
    publisher = robot.create_publisher(Empty, "/scan", 10)
    log = Path(sys.argv[-1].partition(":=")[2])
    heard = 0
    while not heard:
        if publisher.get_subscription_count():
            publisher.publish(Empty())
        node._spin_once()
        handler._log.flush()
        heard = log.read_text().count("message_scan.u_response")
    while heard != (heard := log.read_text().count("message_scan.u_response")):
        for _ in range(10):
            node._spin_once()
        handler._log.flush()
    publisher.publish(Empty())
    time.sleep(SLEEP)
    sys.stdout.write(f"on at {time.time()}\n")
    for _ in range(3):
        node._spin_once()
    handler.close()
    robot.destroy_node()
    node.close()


if __name__ == "__main__":
    Ros2Node.spin = spin
    layer = ["--layer"] if sys.argv[1] == "layer" else []
    main(["run", sys.argv[2], "--ros2", *layer, *sys.argv[3:]])
