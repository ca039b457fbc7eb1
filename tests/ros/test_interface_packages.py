"""Packages of ROS types that no registry offers build and match the models that use them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.reading import read

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent
PACKAGES = HERE / "interfaces"
EXAMPLES = sorted((HERE.parents[1] / "examples").glob("*/*.rscd"))
LISTINGS = HERE.parents[2] / "shared" / "thesis" / "models"


def test_packages_build(workspace: Workspace) -> None:
    headers = {path.name for path in workspace.folder.rglob("*.h*")}
    expected = {
        1: {"BoundingBoxes.h", "ObjectCount.h", "NavigateToPoseAction.h", "LightBulbService.h"},
        2: {"bounding_boxes.hpp", "object_count.hpp", "navigate_to_pose.hpp", "light_bulb_service.hpp"},
    }
    assert headers >= expected[workspace.ros.version]


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
        # A pose estimate has the pose one level deeper; the model does not read it.
        ("obstacle-navigation", [("interface-unused", 20), ("interface-unused", 21)]),
        ("simple-navigation", [("interface-unused", 20), ("interface-unused", 21)]),
        # The detector counts pixels in integers, the model has doubles: a received value may be converted.
        ("person-follower", []),
    ],
)
def test_what_the_printed_listings_say_of_ros_types(name: str, expected: list[tuple[str, int]]) -> None:
    reading = read(LISTINGS / f"{name}.rscd")
    found = check(reading.base, reading.findings, RosTypes([PACKAGES]))
    assert [(finding.rule, finding.span.line) for finding in found if finding.rule.startswith("interface-")] == expected
