"""Topics of ROS 1 or ROS 2 for the scripts that tests run in the Python of a ROS installation."""
# ruff: noqa: PLC0415  # only one of the two is installed

import importlib
import re
import time
from array import array


def connect(version, name):
    """Return the topics of ROS 1 or 2 for a node with this name."""
    return Ros1(name) if version == "1" else Ros2(name)


def type_of(name):
    """Return the Python class of a type such as `std_msgs/Int16`."""
    package, kind = name.split("/")
    return getattr(importlib.import_module(f"{package}.msg"), kind)


def element_of(message, name):
    """Return a new element of a message's array of objects."""
    if hasattr(message, "_slot_types"):
        kind = dict(zip(message.__slots__, message._slot_types, strict=True))[name]
    else:
        kind = message.get_fields_and_field_types()[name]
    return type_of(re.search(r"\w+/\w+", kind)[0])()


def fill(message, fields):
    """Set fields of a message from nested dicts and lists."""
    for name, value in fields.items():
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        elif isinstance(value, list) and any(isinstance(element, dict) for element in value):
            setattr(message, name, [fill(element_of(message, name), element) for element in value])
        else:
            setattr(message, name, value)
    return message


def plain(value):
    """Return a message as nested dicts."""
    if hasattr(value, "__slots__"):
        names = (slot.lstrip("_") for slot in value.__slots__ if slot != "_check_fields")
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, (list, tuple, array)):
        return [plain(element) for element in value]
    if isinstance(value, bytes):  # the Python value of a ROS 2 byte
        return int.from_bytes(value, "little")
    return value if isinstance(value, (bool, int, float, str)) else str(value)


class Ros1:
    def __init__(self, name):
        import rospy

        self.rospy = rospy
        rospy.init_node(name, anonymous=True, disable_signals=True)
        self.publishers = []

    def listen(self, topic, kind, callback, latched=False):  # noqa: ARG002
        self.rospy.Subscriber(topic, type_of(kind), callback, queue_size=1000)

    def publisher(self, topic, kind):
        publisher = self.rospy.Publisher(topic, type_of(kind), queue_size=100)
        self.publishers.append(publisher)
        return lambda **fields: publisher.publish(fill(type_of(kind)(), fields))

    def heard(self):
        return all(publisher.get_num_connections() > 0 for publisher in self.publishers)

    def receive(self, seconds):
        time.sleep(seconds)


class Ros2:
    def __init__(self, name):
        import rclpy

        self.rclpy = rclpy
        rclpy.init()
        self.node = rclpy.create_node(name)
        self.publishers = []

    def listen(self, topic, kind, callback, latched=False):
        from rclpy.qos import DurabilityPolicy, QoSProfile

        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        self.node.create_subscription(type_of(kind), topic, callback, QoSProfile(depth=1000, durability=durability))

    def publisher(self, topic, kind):
        publisher = self.node.create_publisher(type_of(kind), topic, 100)
        self.publishers.append(publisher)
        return lambda **fields: publisher.publish(fill(type_of(kind)(), fields))

    def heard(self):
        return all(publisher.get_subscription_count() > 0 for publisher in self.publishers)

    def receive(self, seconds):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self.rclpy.spin_once(self.node, timeout_sec=max(0.0, until - time.monotonic()))
