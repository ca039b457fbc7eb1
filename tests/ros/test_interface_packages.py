"""The packages of ROS types that no registry has: they build, and the models that use them fit."""

import os
import shutil
from pathlib import Path

import pytest

from robosc.checks import check
from robosc.language import read
from robosc.ros_types import RosTypes
from tests.ros.installations import find_ros1, find_ros2

HERE = Path(__file__).parent
PACKAGES = HERE / "interfaces"
EXAMPLES = sorted((HERE.parents[1] / "examples").glob("*/*.rscd"))
LISTINGS = HERE.parents[2] / "shared" / "thesis" / "models"
#: What the two generators of interfaces need beside what the nodes need.
NEEDED = {"ros1": ["actionlib_msgs", "message_generation"], "ros2": ["action_msgs", "rosidl_default_generators"]}


@pytest.mark.parametrize("version", ["ros1", "ros2"])
def test_packages_build(version: str, tmp_path: Path) -> None:
    found = find_ros1() if version == "ros1" else find_ros2()
    environment = found.ros.environment if found.ros else {}
    folders = [Path(part) for part in environment.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if part]
    folders += [Path(part) / "share" for part in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    there = {
        package for package in NEEDED[version] for folder in folders if (folder / package / "package.xml").exists()
    }
    missing = [*found.missing, *(f"no {package}" for package in NEEDED[version] if package not in there)]
    if found.ros is None or missing:
        reason = f"{version}: {', '.join(missing)}"
        if version in os.environ.get("ROBOSC_REQUIRE", "").split(","):
            pytest.fail(reason)
        pytest.skip(reason)
    shutil.copytree(PACKAGES / version, tmp_path / "src")
    found.ros.built(tmp_path)
    headers = {path.name for path in tmp_path.rglob("*.h*")}
    expected = {
        "ros1": {"BoundingBoxes.h", "ObjectCount.h", "NavigateToPoseAction.h", "LightBulbService.h"},
        "ros2": {"bounding_boxes.hpp", "object_count.hpp", "navigate_to_pose.hpp", "light_bulb_service.hpp"},
    }
    assert headers >= expected[version]


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda model: model.stem)
def test_examples_fit(model: Path) -> None:
    reading = read(model)
    assert [*reading.findings, *check(reading.base, reading.findings, RosTypes([PACKAGES]))] == []


@pytest.mark.skipif(not LISTINGS.is_dir(), reason="the printed listings are not beside the repository")
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("language-concepts", []),
        ("line-follower", []),
        ("line-follower-supervised", []),
        ("maze-solver", []),
        ("object-finder", []),
        # A pose estimate holds the pose one level deeper; nobody reads it.
        ("obstacle-navigation", [("interface-unused", 20), ("interface-unused", 21)]),
        ("simple-navigation", [("interface-unused", 20), ("interface-unused", 21)]),
        # The detector counts pixels, the model has doubles: what comes in may be converted.
        ("person-follower", []),
    ],
)
def test_what_the_printed_listings_say_of_ros_types(name: str, expected: list[tuple[str, int]]) -> None:
    reading = read(LISTINGS / f"{name}.rscd")
    found = check(reading.base, reading.findings, RosTypes([PACKAGES]))
    assert [(finding.rule, finding.span.line) for finding in found if finding.rule.startswith("interface-")] == expected
