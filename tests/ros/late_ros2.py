"""Run a model as a ROS 2 node that sleeps while a scan arrives and a timer expires.

python3 late_ros2.py controller|layer MODEL --ros-args -p event_log:=LOG

Prints the time at which the node continues.
"""

import sys
import time
from pathlib import Path

import rclpy
from std_msgs.msg import Empty

from robosc.run.runtime.ros2.node import Ros2Node
from robosc.tools.cli import main

#: More than twice the silence of scans that the model accepts.
SLEEP = 2.0


def spin(node, handler):
    """Spin a node, in place of its own method."""
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
