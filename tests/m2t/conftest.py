"""The courier: a robot with every kind of data. The porter: one with every kind of communication."""

from __future__ import annotations

import re
from difflib import unified_diff
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.base.ros_types import RosTypes
from robosc.language import configuration as config

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

HERE = Path(__file__).parent / "cpp"
#: Packages for ROS 1 that only ROS 2 has otherwise.
ROS1_INTERFACES = Path(__file__).parents[1] / "ros" / "interfaces" / "ros1"
SHIPPED = Path(robosc.__file__).parent / "m2t" / "ros" / "include"


def models(name: str) -> robosc.Models:
    robot = robosc.load(HERE / f"{name}.rscd")
    assert [finding for finding in robosc.check(robot) if finding.rule != "interface-unknown"] == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot, RosTypes([ROS1_INTERFACES]))


@pytest.fixture(scope="session")
def courier() -> robosc.Models:
    return models("courier")


@pytest.fixture(scope="session")
def porter() -> robosc.Models:
    return models("porter")


@pytest.fixture(scope="session")
def settings() -> config.Configuration:
    return config.read(HERE / "controller-config.json")


@pytest.fixture(scope="session")
def porter_settings() -> config.Configuration:
    return config.read(HERE / "porter-config.json")


def differences(before: Mapping[str, str], after: Mapping[str, str]) -> str:
    """Return the removed and added lines of files below their paths, without positions."""
    lines = []
    for path, text in after.items():
        found = unified_diff(before[path].splitlines(), text.splitlines(), "", path, n=0, lineterm="")
        lines += [f"{line}\n" for line in found if not line.startswith(("---", "@@"))]
    return "".join(lines)


@pytest.fixture
def golden_package(golden: Callable[[Path, str], None]) -> Callable[[Path, dict[str, str]], None]:
    """`golden_package(folder, files)`: compare a package except the C engine and copied headers.

    Other tests cover these. The definition is the same in each ROS and has one golden file for both.
    """

    def compare(folder: Path, files: dict[str, str]) -> None:
        copied = {path for path in files if (SHIPPED / path.removeprefix("include/")).exists()}
        engine = {path for path in files if re.fullmatch(r"src/\w+_supervisor\.[ch]", path)}
        assert "include/robosc/json.hpp" in copied
        assert len(engine) == 2
        for path in copied:
            assert files[path] == (SHIPPED / path.removeprefix("include/")).read_text(encoding="utf-8")
        definition = next(path for path in files if path.endswith("/definition.hpp"))
        golden(HERE.parent / "definitions" / f"{PurePath(definition).parent.name}.hpp", files[definition])
        decided = set(files) - copied - engine - {definition}
        for path in sorted(decided):
            golden(folder / path, files[path])
        kept = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
        assert kept == decided

    return compare
