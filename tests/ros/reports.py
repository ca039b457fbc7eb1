"""Writes what a node says about itself (`~/state`, `~/definition`) to a file, a line of JSON each; ROS 1 or 2.

    python3 reports.py 1|2 NODE FILE
"""

import json
import sys
from pathlib import Path


def main(version, node, path):
    """Until it is interrupted."""
    with Path(path).open("w", encoding="utf-8") as file:

        def note(topic, message):
            file.write(json.dumps({"topic": topic, "data": json.loads(message.data)}) + "\n")
            file.flush()

        (listen1 if version == "1" else listen2)(node, note)


def listen1(node, note):
    import rospy
    from std_msgs.msg import String

    rospy.init_node("reports", anonymous=True)
    for topic in ("state", "definition"):
        rospy.Subscriber(f"/{node}/{topic}", String, lambda message, topic=topic: note(topic, message))
    rospy.spin()


def listen2(node, note):
    import rclpy
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    rclpy.init()
    listener = rclpy.create_node("reports")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    listener.create_subscription(String, f"/{node}/state", lambda message: note("state", message), 10)
    listener.create_subscription(String, f"/{node}/definition", lambda message: note("definition", message), latched)
    try:
        rclpy.spin(listener)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == "__main__":
    main(*sys.argv[1:])
