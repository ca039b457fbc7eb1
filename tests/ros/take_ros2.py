"""Print the number of the 300 messages of a fast topic that a node processes before a stop sent after them."""

import time

import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import Empty, Int32

import robosc
from robosc.language.configuration import Configuration
from robosc.run.runtime.ros2.node import Ros2Node

MODEL = """
robot Taker {
  interface number use Int32 from std_msgs

  component Sensor {
    outgoing message pulse with identifier: "/pulse", type: integer links number
    outgoing message stop with identifier: "/stop", type: none
  }
}
"""
COUNT = 300

graph = robosc.to_rosgraph(robosc.load(text=MODEL))
node = Ros2Node("taker", graph, Configuration.model_validate({"qos": {"pulse": {"depth": 1000}}}), [])
taken: list[str] = []
for subscription in graph.subscriptions:
    node._subscribe(subscription, lambda _, topic=subscription.topic: taken.append(topic))
world = rclpy.create_node("world")
pulses, stops = (
    world.create_publisher(Int32, "/pulse", QoSProfile(depth=1000)),
    world.create_publisher(Empty, "/stop", 10),
)
while not (pulses.get_subscription_count() and stops.get_subscription_count()):
    time.sleep(0.05)
# Teach the node which topic is fast.
for number in range(20):
    pulses.publish(Int32(data=number))
while len(taken) < 20:
    node._spin_once()
taken.clear()
for number in range(COUNT):
    pulses.publish(Int32(data=number))
stops.publish(Empty())
time.sleep(2.0)
while len(taken) <= COUNT:
    node._spin_once()
print(taken.index("/stop"))  # noqa: T201
node.close()
