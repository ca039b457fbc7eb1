"""`send: change`: a command is sent when it becomes possible or its data differs from the last sent data."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.tools.cli import main
from tests.run.runtime.fake import World

LAMPS = Path(__file__).parent / "lamps.rscd"


@pytest.fixture
def world(tmp_path: Path) -> World:
    return World(LAMPS, tmp_path / "events.jsonl").start()


def sent(world: World, topic: str, seconds: float = 0.55) -> list[float]:
    world.wait(seconds)
    found = [fields["data"] for name, fields in world.port.sent if name == topic]
    world.port.sent.clear()
    return found


def test_it_is_sent_once(world: World) -> None:
    """The command is sent when it becomes possible, not in every tick."""
    assert sent(world, "/lamp") == [0.5]
    assert len(sent(world, "/plain")) >= 5
    assert sent(world, "/lamp") == []


def test_it_is_sent_when_its_data_differs(world: World) -> None:
    """The command is sent when its data differs from the last sent data."""
    sent(world, "/lamp")
    for level, expected in [(0.5, []), (0.75, [0.75]), (0.75, []), (0.25, [0.25])]:
        world.hear("level", data=level)
        assert sent(world, "/lamp") == expected


def test_it_is_sent_again_when_it_becomes_possible_again(world: World) -> None:
    """The command is sent when it becomes possible."""
    sent(world, "/lamp")
    world.hear("allow", data=False)
    assert sent(world, "/lamp") == []
    world.hear("level", data=2.0)
    world.hear("level", data=0.5)
    world.hear("allow", data=True)
    assert sent(world, "/lamp") == [0.5]


def test_what_is_withheld_was_not_handed_over(world: World) -> None:
    """Withheld or failed data does not count as sent."""
    sent(world, "/lamp")
    world.hear("level", data=math.nan)
    assert sent(world, "/lamp") == []
    world.hear("level", data=0.5)
    # The robot still has 0.5.
    assert sent(world, "/lamp") == []
    world.hear("level", data=0.75)
    assert sent(world, "/lamp") == [0.75]


def test_generated_nodes_compare_too() -> None:
    """The node compares the data for the engine. In ROS 2, the publisher is transient-local."""
    robot = robosc.load(LAMPS)
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    texts = {target: str(robosc.generate(target, models)) for target in ("ros1", "ros2", "ros2-layer", "supervisor")}
    for target in ("ros1", "ros2"):
        assert "!(lamp_handed_->data == lamp_message_.data)" in texts[target]
        assert "plain_handed_" not in texts[target]
    assert texts["ros2"].count("rclcpp::QoS(10).transient_local());") == 1
    # The layer has no part in this.
    assert "_handed_" not in texts["ros2-layer"]


def test_a_message_without_data_is_sent_once(tmp_path: Path) -> None:
    """The command is sent when it becomes possible, also by the simulated robot of scenarios."""
    robot = tmp_path / "bell.rscd"
    robot.write_text(
        """robot R { component Bell { incoming message ring with type: none, send: change
        outgoing message press with type: boolean
        behaviour { initial marked state quiet { on response from press if value goto loud }
                    marked state loud { on response from press if !value goto quiet } } }
        requirement ring needs Bell.loud }"""
    )
    scenarios = tmp_path / "bell.scenarios"
    scenarios.write_text(
        'scenario "once"\n  press with true\n  expect ring sent\n  wait 500 ms\n  expect ring not sent\n'
        "  press with false\n  press with true\n  expect ring sent\n"
    )
    answer = CliRunner().invoke(main, ["test", str(robot), str(scenarios)])
    assert answer.exit_code == 0, answer.output
