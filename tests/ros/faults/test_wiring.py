"""Missing, incompatible and surplus partners on the topics. The node reports each of them once, by name."""

from __future__ import annotations

import re
from contextlib import nullcontext
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.ros.faults.partners import Moment, Peer, Scout

START = None


@pytest.fixture
def stranger(under_way: Scout, kept: Callable[..., Peer]) -> Peer:
    """A node that does not belong to the robot."""
    return kept("stranger", lambda: nullcontext(under_way.meet("stranger")))


def once(scout: Scout, since: Moment, text: str) -> None:
    """Check that the node prints a message exactly once."""
    scout.until_says(since, text)
    scout.nothing(2.5)
    assert scout.says(since, text) == 1


def test_nobody_publishes(scout: Scout) -> None:
    text = "/bumper: nobody publishes it after 5 s"
    scout.until_says(START, text)
    assert scout.says(START, text) == 1
    assert re.findall(r"(\S+): nobody publishes", scout.output()) == ["/bumper"]


def test_wrong_type(scout: Scout, stranger: Peer) -> None:
    since = scout.now()
    stranger.do("advertise", topic="/charge", kind="std_msgs/String")
    stranger.do("repeat", topic="/charge", fields={"data": "full"}, hz=20)
    once(scout, since, "/charge: /stranger publishes std_msgs/…String, not std_msgs/…Int16")
    assert scout.events(since, "message_charge.u_response") == []
    scout.send("/charge", data=77)
    scout.until_event(since, "message_charge.u_response")
    stranger.do("silence", topic="/charge")
    stranger.do("withdraw", topic="/charge")


def test_foreign_publisher(scout: Scout, stranger: Peer) -> None:
    since = scout.now()
    stranger.do("advertise", topic="/cmd_vel", kind="geometry_msgs/Twist")
    once(scout, since, "/cmd_vel: /stranger publishes it, too")
    stranger.do("withdraw", topic="/cmd_vel")
    assert len(re.findall(r"/cmd_vel:.* publishes", scout.output())) == 1


def test_incompatible_quality_of_service(scout: Scout, stranger: Peer) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 has no quality of service")
    since = scout.now()
    stranger.do("advertise", topic="/charge", kind="std_msgs/Int16", best_effort=True)
    stranger.do("repeat", topic="/charge", fields={"data": 13}, hz=20)
    once(scout, since, "/charge: /stranger offers a quality of service that does not fit: …")
    assert scout.events(since, "message_charge.u_response") == []
    stranger.do("silence", topic="/charge")
    stranger.do("withdraw", topic="/charge")


def test_listener_that_can_not_hear(scout: Scout, stranger: Peer) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 itself tells of listeners")
    since = scout.now()
    logger = scout.meet("logger")
    logger.do("listen", topic="/cmd_vel", kind="std_msgs/String")
    once(scout, since, "/cmd_vel: /logger expects std_msgs/…String, not geometry_msgs/…Twist")
    logger.process.kill()
    stranger.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist", latched=True)
    once(scout, since, "/cmd_vel: /stranger asks for a quality of service that does not fit: …")
    assert len(re.findall("quality of service|QoS", scout.output(since))) == 1


def test_best_effort_sensor_is_received(scout: Scout, stranger: Peer) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 has no quality of service")
    stranger.do("advertise", topic="/scan", kind="sensor_msgs/LaserScan", best_effort=True)
    scout.world.do("silence", topic="/scan")
    stranger.do("repeat", topic="/scan", fields={"ranges": [0.1]}, hz=20)
    since = scout.now()
    scout.until(lambda: scout.variable("Lidar", "front") == "obstructed", "the stranger's scan is seen")
    scout.until_event(since, "message_view.u_response", count=10)
    assert "/scan: /stranger" not in scout.output()
    stranger.do("silence", topic="/scan")
    stranger.do("withdraw", topic="/scan")


def test_quality_of_service_of_feedback(scout: Scout) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 has no quality of service")
    assert set(scout.world.do("asked_for", topic="/travel/_action/feedback")) == {"BEST_EFFORT"}
