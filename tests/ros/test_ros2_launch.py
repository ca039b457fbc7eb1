"""The launch files of ROS 2 in the installed launch system start the right nodes with the right arguments."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

import robosc
from robosc.language.configuration import Configuration
from tests.ros.installations import Ros, find_ros2

HERE = Path(__file__).parent
ROBOT = "supervised_line_follower"
LAYER, CONTROLLER = f"{ROBOT}_layer", f"{ROBOT}_controller"
#: Stand-in for a node: prints its arguments and the content of its parameter files.
NODE = """\
#!/bin/sh
echo "started ${0##*/} $*"
for argument; do case $argument in /tmp/*) cat "$argument" ;; esac; done
"""


@pytest.fixture(scope="module")
def ros() -> Ros:
    found = find_ros2()
    if found.ros is None:
        pytest.skip(f"ros2: {', '.join(found.missing)}")
    there = subprocess.run([found.ros.python, "-c", "import launch_ros"], env=found.ros.environment, check=False)
    if there.returncode:
        pytest.skip("ros2: no launch_ros")
    return found.ros


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an installed layer and its controller, whose nodes are stand-ins."""
    folder = tmp_path_factory.mktemp("prefix")
    controller = {"launch": {"packageName": CONTROLLER, "file": f"{CONTROLLER}.launch.py"}}
    settings = Configuration.model_validate({"supervisor": {"controller": controller}})
    robot = robosc.load(HERE.parents[1] / "examples" / ROBOT / f"{ROBOT}.rscd")
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    for target, package in {"ros2-layer": LAYER, "ros2": CONTROLLER}.items():
        index = folder / "share/ament_index/resource_index/packages" / package
        index.parent.mkdir(parents=True, exist_ok=True)
        index.touch()
        for path, text in robosc.generate(target, models, settings).items():
            if path.startswith(("launch/", "config/")):
                file = folder / "share" / package / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
        node = folder / "lib" / package / package
        node.parent.mkdir(parents=True)
        node.write_text(NODE, encoding="utf-8")
        node.chmod(0o755)
    return folder


def started(ros: Ros, prefix: Path, how: str, *arguments: str, package: str = LAYER) -> dict[str, str]:
    """Start the layer and its controller, or the controller alone; return their arguments and output, by package."""
    file = prefix / "share" / package / "launch" / f"{package}.launch.py"
    done = subprocess.run(
        [ros.python, HERE / "launch_ros2.py", file, how, *arguments],
        env={**ros.environment, "AMENT_PREFIX_PATH": f"{prefix}:{ros.environment['AMENT_PREFIX_PATH']}"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [re.match(r"\[(\w+)-\d+\] (.*)", line) for line in done.stdout.splitlines()]
    said = {name: "\n".join(line[2] for line in lines if line and line[1] == name) for name in (LAYER, CONTROLLER)}
    assert said[CONTROLLER], done.stdout + done.stderr
    assert said[LAYER] or package == CONTROLLER, done.stdout + done.stderr
    return said


def test_the_controller_has_a_name_and_a_log_of_its_own(ros: Ros, prefix: Path) -> None:
    said = started(ros, prefix, "plain", "name=gate", "namespace=left", "event_log=/tmp/gate.jsonl")
    assert "__node:=gate -r __ns:=/left " in said[LAYER]
    assert "event_log: /tmp/gate.jsonl" in said[LAYER]
    assert f"__node:={CONTROLLER} -r __ns:=/ " in said[CONTROLLER]
    assert "/correction:=/left/gate/controller/correction" in said[CONTROLLER]
    assert "gate.jsonl" not in said[CONTROLLER]


def test_a_namespace_around_the_file_holds_for_both(ros: Ros, prefix: Path) -> None:
    said = started(ros, prefix, "pushed")
    assert f"__node:={LAYER} -r __ns:=/hall " in said[LAYER]
    assert f"__node:={CONTROLLER} -r __ns:=/hall " in said[CONTROLLER]
    assert f"/correction:=/hall/{LAYER}/controller/correction" in said[CONTROLLER]


def test_a_clock_around_the_file_holds_for_both(ros: Ros, prefix: Path) -> None:
    for text in started(ros, prefix, "simulated").values():
        assert "use_sim_time:=True" in text
        assert "use_sim_time: false" not in text


def test_a_clock_that_is_asked_for_holds_for_both(ros: Ros, prefix: Path) -> None:
    for text in started(ros, prefix, "plain", "use_sim_time=true").values():
        assert "use_sim_time: true" in text
    for text in started(ros, prefix, "plain").values():
        assert "use_sim_time" not in text


def test_parameters_of_the_default_name_apply_to_another_name(ros: Ros, prefix: Path) -> None:
    """The node's own name is in the file that the launch system writes for it."""
    said = started(ros, prefix, "plain", "name=other", "namespace=left", package=CONTROLLER)[CONTROLLER]
    named = said.partition("/left/other")[2]
    assert "period_ms: 100" in named
    assert "watchdog_ms.scan: 0" in named


def test_a_node_that_died_starts_again(ros: Ros, prefix: Path) -> None:
    """The stand-in ends at once: the launch system starts it again until it is stopped."""
    assert started(ros, prefix, "stopped", "use_respawn=true", package=CONTROLLER)[CONTROLLER].count("started ") > 1
    assert started(ros, prefix, "stopped", package=CONTROLLER)[CONTROLLER].count("started ") == 1
