"""A workspace with a package for a model, one for an interface and one for the simulated robot, as in the examples.

One call of the platform's own tool builds it, and what has not changed is not built again: docs/workspace.md.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.cmake.building import blocks, built_again, no_work_is_done, touched_later
from tests.ros.workspaces import EXAMPLES, Workspace, found_or_skipped, middleware
from tests.scenarios.rules.books import BOOKS

if TYPE_CHECKING:
    from tests.ros.installations import Ros

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
MODEL = "ros1/follower_robot/person_follower.rscd"


@pytest.fixture(scope="session")
def model_workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    """`examples/workspace`, word for word as the page says, and a package that uses what the model exports."""
    ros = with_robosc(found_or_skipped(1))
    home = tmp_path_factory.mktemp("home")
    folder = home / "catkin_ws"
    shutil.copytree(HERE / "downstream", folder / "src" / "downstream")
    built = subprocess.run(
        ["bash", "-e", "-c", blocks("ROS 1", "sh")[0]],
        cwd=ROOT,
        env={**ros.environment, "HOME": str(home)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stdout
    return Workspace(ros, folder, built.stdout)


def with_robosc(ros: Ros) -> Ros:
    """An installation beside which `robosc` is found, after its own programs."""
    programs = f"{ros.environment['PATH']}{os.pathsep}{Path(sys.executable).parent}"
    return replace(ros, environment={**ros.environment, "PATH": programs, "PYTHONPATH": str(ROOT)})


def build(workspace: Workspace, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Builds again what was built, as its user would."""
    return subprocess.run(
        ["catkin_make", *arguments],
        cwd=workspace.folder,
        env={**workspace.environment(), "ROS_IP": "127.0.0.1", "ROS_HOSTNAME": "127.0.0.1"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("version", [1, 2])
def test_the_page_shows_the_package(version: int) -> None:
    script = EXAMPLES / "workspace" / f"ros{version}" / "follower_robot" / "CMakeLists.txt"
    assert blocks(f"ROS {version}", "cmake") == [script.read_text(encoding="utf-8")]


def test_it_drives(model_workspace: Workspace, tmp_path: Path) -> None:
    """One launch file starts the controller, from where the build has put it, and the world around the robot."""
    folder, events, record = tmp_path / "run", tmp_path / "events.jsonl", tmp_path / "record.jsonl"
    with middleware(model_workspace, folder, simulated=True) as processes:
        arguments = ["speed:=4", f"event_log:={events}", f"record:={record}"]
        command = blocks("ROS 1", "sh")[1].split()
        launch = processes.start("launch", [*command, *arguments])
        processes.wait_until(lambda: launch.poll() is not None, "the scenario has ended", seconds=900)
    said = (folder / "launch.log").read_text(errors="replace")
    assert "the goal was reached" in said, said
    log = lines(events)
    while log[-1]["direction"] == "outside":
        # At the very end, when it is shut down, the node halts the robot whatever the requirements say.
        log.pop()
    assert sum(entry["direction"] == "out" for entry in log) >= 3
    assert BOOKS["person_follower"]().violations(log) == []
    assert lines(record) != []


def test_another_package_uses_the_engine(model_workspace: Workspace) -> None:
    onlooker = model_workspace.folder / "devel" / "lib" / "downstream" / "downstream_onlooker"
    assert subprocess.run([onlooker], capture_output=True, text=True, check=True).stdout == "01\n"


def test_a_second_build_does_nothing(model_workspace: Workspace) -> None:
    done = build(model_workspace)
    assert done.returncode == 0, done.stderr
    assert no_work_is_done(done.stdout), done.stdout


def test_what_is_installed(model_workspace: Workspace) -> None:
    """What a node needs that runs from the installed workspace alone."""
    done = build(model_workspace, "install")
    assert done.returncode == 0, done.stderr
    assert built_again(done.stdout) == []
    installed = {
        path.relative_to(model_workspace.folder / "install").as_posix()
        for path in (model_workspace.folder / "install").rglob("*person_follower*")
        if path.is_file()
    }
    assert installed == {
        "include/person_follower_controller/person_follower_supervisor.h",
        "lib/follower_robot/person_follower_controller",
        "lib/libperson_follower_controller_engine.a",
        "share/follower_robot/config/person_follower_controller.yaml",
        "share/follower_robot/launch/person_follower_controller.launch",
    }
    assert (model_workspace.folder / "install/share/catkin_robosc/cmake/find-robosc.cmake").exists()


def test_a_comment_compiles_nothing(model_workspace: Workspace) -> None:
    model = model_workspace.folder / "src" / MODEL
    with touched_later(model, "// Nothing new.\n" + model.read_text(encoding="utf-8")):
        done = build(model_workspace)
        assert done.returncode == 0, done.stderr
        assert "person_follower: 17 files, " in done.stdout
        assert built_again(done.stdout) == []


def test_a_fault_stops_the_build_with_its_place(model_workspace: Workspace) -> None:
    model = model_workspace.folder / "src" / MODEL
    text = model.read_text(encoding="utf-8")
    right = "  requirement move needs EmergencyStop.in_service and PersonDetector.detected\n"
    assert right in text
    line = right.replace("detected", "detectd").rstrip("\n")
    with touched_later(model, text.replace(right, f"{line}\n")):
        done = build(model_workspace)
        assert done.returncode != 0
        number = text[: text.index("requirement move")].count("\n") + 1
        column = line.index("detectd") + 1
        assert f"{model}:{number}:{column}: error: " in done.stderr
        assert f"    {line}\n    {' ' * (column - 1)}^^^^^^^\n" in done.stderr
        assert "did you mean `detected`?" in done.stderr
    assert build(model_workspace).returncode == 0


def test_a_definition_that_changes_is_read_again(model_workspace: Workspace) -> None:
    """The model is checked against it: what the build depends on follows from the model."""
    definition = model_workspace.folder / "src" / "ros1" / "bboxes_ex_msgs" / "msg" / "BoundingBox.msg"
    text = definition.read_text(encoding="utf-8")
    with touched_later(definition, text.replace("img_width", "img_breadth")):
        done = build(model_workspace)
        assert done.returncode != 0
        assert "person_follower.rscd" in done.stderr
        assert "img_width" in done.stderr
    assert build(model_workspace).returncode == 0


def test_what_the_package_does_not_declare_is_listed(model_workspace: Workspace) -> None:
    package = model_workspace.folder / "src" / "ros1" / "follower_robot" / "package.xml"
    text = package.read_text(encoding="utf-8")
    without = text.replace("  <depend>geometry_msgs</depend>\n", "").replace("depend>roscpp", "build_depend>roscpp", 1)
    with touched_later(package, without.replace("roscpp</depend>", "roscpp</build_depend>")):
        done = build(model_workspace)
        assert done.returncode != 0
        listed = [line for line in done.stderr.splitlines() if line.startswith("  <")]
        assert listed == ["  <depend>geometry_msgs</depend>", "  <exec_depend>roscpp</exec_depend>"]
    assert build(model_workspace).returncode == 0


def test_traces_are_played(model_workspace: Workspace) -> None:
    """Against the node that is part of the package, by the generated test."""
    package = model_workspace.folder / "src" / "ros1" / "follower_robot"
    script, manifest = package / "CMakeLists.txt", package / "package.xml"
    needed = "".join(f"  <test_depend>{name}</test_depend>\n" for name in ("rosgraph_msgs", "rospy", "rostest"))
    text = manifest.read_text(encoding="utf-8").replace("</package>", f"{needed}</package>")
    asked = script.read_text(encoding="utf-8").replace(".rscd)", ".rscd TESTS)")
    with touched_later(script, asked), touched_later(manifest, text):
        done = build(model_workspace, "run_tests_follower_robot")
        results = model_workspace.folder / "build" / "test_results"
        told = subprocess.run(
            ["catkin_test_results", results],
            env=model_workspace.environment(),
            capture_output=True,
            text=True,
            check=False,
        )
        assert "Summary: 2 tests, 0 errors, 0 failures, 0 skipped" in told.stdout, done.stdout + told.stdout
    assert build(model_workspace).returncode == 0


def lines(path: Path) -> list[dict[str, Any]]:
    """The objects in a file of JSON lines."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
