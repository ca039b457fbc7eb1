"""A workspace with packages for a model, an interface and a simulated robot, as in the examples.

One call of the platform's own tool builds it, and a second call builds only changed files: docs/workspace.md.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.cmake.building import blocks, built_again, no_work_is_done, touched_later
from tests.ros.installations import find_ros1, find_ros2
from tests.ros.workspaces import EXAMPLES, Workspace, found_or_skipped, middleware
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import moved_while_stopped, poses

if TYPE_CHECKING:
    from tests.ros.installations import Ros

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
#: Files of the build, for each ROS version.
NODE = "person_follower_controller"
INSTALLED = {
    1: {
        f"include/{NODE}/person_follower_supervisor.h",
        f"lib/follower_robot/{NODE}",
        f"lib/lib{NODE}_engine.a",
        f"share/follower_robot/config/{NODE}.yaml",
        f"share/follower_robot/launch/{NODE}.launch",
    },
    2: {
        f"follower_robot/include/follower_robot/{NODE}/person_follower_supervisor.h",
        f"follower_robot/lib/follower_robot/{NODE}",
        f"follower_robot/lib/lib{NODE}_component.so",
        f"follower_robot/lib/lib{NODE}_engine.a",
        f"follower_robot/share/follower_robot/cmake/{NODE}Export-noconfig.cmake",
        f"follower_robot/share/follower_robot/cmake/{NODE}Export.cmake",
        f"follower_robot/share/follower_robot/config/{NODE}.yaml",
        f"follower_robot/share/follower_robot/launch/{NODE}.launch.py",
    },
}
ONLOOKER = {1: "devel/lib/downstream/downstream_onlooker", 2: "install/downstream/lib/downstream/downstream_onlooker"}


@pytest.fixture(scope="session", params=[1, 2], ids=["ros1", "ros2"])
def model_workspace(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    """`examples/workspace`, built by the commands on the page, and a package that uses the exports of the model."""
    ros = with_robosc(found_or_skipped(f"ros{request.param}", {1: find_ros1, 2: find_ros2}[request.param]()))
    home = tmp_path_factory.mktemp("home")
    folder = home / {1: "catkin_ws", 2: "ros2_ws"}[ros.version]
    shutil.copytree(HERE / "downstream", folder / "src" / "downstream")
    built = subprocess.run(
        ["bash", "-e", "-c", blocks(f"ROS {ros.version}", "sh")[0]],
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
    """Return an installation whose path ends with the folder of `robosc`."""
    own = ros.environment
    found = {
        "PATH": f"{own['PATH']}{os.pathsep}{Path(sys.executable).parent}",
        "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), own.get("PYTHONPATH")])),
        **({"ROS_VERSION": "2"} if ros.version == 2 else {"ROS_IP": "127.0.0.1", "ROS_HOSTNAME": "127.0.0.1"}),
    }
    return replace(ros, environment={**own, **found})


@dataclass(frozen=True)
class Built:
    """Exit status and output of a build."""

    status: int
    output: str


def build(workspace: Workspace, *arguments: str) -> Built:
    """Build a workspace again, like a user."""
    colcon = ["colcon", "build", "--event-handlers", "console_direct+"]
    done = subprocess.run(
        [*(["catkin_make"] if workspace.ros.version == 1 else colcon), *arguments],
        cwd=workspace.folder,
        env=workspace.environment() if workspace.ros.version == 1 else workspace.ros.environment,
        capture_output=True,
        text=True,
        check=False,
    )
    return Built(done.returncode, done.stdout + done.stderr)


def source(workspace: Workspace, package: str, name: str) -> Path:
    return workspace.folder / "src" / f"ros{workspace.ros.version}" / package / name


@pytest.mark.parametrize("version", [1, 2])
def test_the_page_shows_the_package(version: int) -> None:
    script = EXAMPLES / "workspace" / f"ros{version}" / "follower_robot" / "CMakeLists.txt"
    assert blocks(f"ROS {version}", "cmake") == [script.read_text(encoding="utf-8")]


def test_it_drives(model_workspace: Workspace, tmp_path: Path) -> None:
    """One launch file starts the installed controller and the world around the robot."""
    version = model_workspace.ros.version
    folder, events, seen = tmp_path / "run", tmp_path / "events.jsonl", tmp_path / "record.jsonl"
    with middleware(model_workspace, folder, simulated=True) as processes:
        command = blocks(f"ROS {version}", "sh")[1].split()
        arguments = ["speed:=4", f"record:={seen}", *([f"event_log:={events}"] if version == 1 else [])]
        launch = processes.start("launch", [*command, *arguments])
        processes.wait_until(lambda: launch.poll() is not None, "the scenario has ended", seconds=900)
    said = (folder / "launch.log").read_text(errors="replace")
    assert "the goal was reached" in said, said
    record = lines(seen)
    assert moved_while_stopped(record, 1.0) < 0.02
    assert min(pose["gap"] for pose in poses(record)) >= 0
    if version == 1:
        log = lines(events)
        while log[-1]["direction"] == "outside":
            # When the node shuts down, it halts the robot independently of the requirements.
            log.pop()
        assert sum(entry["direction"] == "out" for entry in log) >= 3
        assert BOOKS["person_follower"]().violations(log) == []


def test_another_package_uses_the_engine(model_workspace: Workspace) -> None:
    onlooker = model_workspace.folder / ONLOOKER[model_workspace.ros.version]
    assert subprocess.run([onlooker], capture_output=True, text=True, check=True).stdout == "01\n"


def test_a_second_build_does_nothing(model_workspace: Workspace) -> None:
    done = build(model_workspace)
    assert done.status == 0, done.output
    assert no_work_is_done(done.output), done.output


def test_what_is_installed(model_workspace: Workspace) -> None:
    """The installed workspace contains everything that a node needs."""
    version = model_workspace.ros.version
    done = build(model_workspace, *(["install"] if version == 1 else []))
    assert done.status == 0, done.output
    assert built_again(done.output) == []
    install = model_workspace.folder / "install"
    installed = {path.relative_to(install).as_posix() for path in install.rglob("*person_follower*") if path.is_file()}
    assert installed == INSTALLED[version]
    assert len([*install.rglob("find-robosc.cmake")]) == 1


def test_a_comment_compiles_nothing(model_workspace: Workspace) -> None:
    model = source(model_workspace, "follower_robot", "person_follower.rscd")
    with touched_later(model, "// Nothing new.\n" + model.read_text(encoding="utf-8")):
        done = build(model_workspace)
        assert done.status == 0, done.output
        assert "-- robosc: " in done.output
        assert built_again(done.output) == []


def test_traces_are_played(model_workspace: Workspace, tmp_path: Path) -> None:
    """The generated test plays the traces against the node of the package."""
    version = model_workspace.ros.version
    prefixes = model_workspace.ros.environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if version == 2 and not any(
        (Path(prefix) / "share" / "launch_testing_ament_cmake").exists() for prefix in prefixes
    ):
        pytest.skip("there is no launch_testing_ament_cmake beside this rclcpp")
    script = source(model_workspace, "follower_robot", "CMakeLists.txt")
    manifest = source(model_workspace, "follower_robot", "package.xml")
    tools = {1: ["rospy", "rostest"], 2: ["launch_testing", "launch_testing_ament_cmake", "rclpy"]}[version]
    needed = "".join(f"  <test_depend>{name}</test_depend>\n" for name in ("rosgraph_msgs", *tools))
    text = manifest.read_text(encoding="utf-8").replace("</package>", f"{needed}</package>")
    asked = script.read_text(encoding="utf-8").replace(".rscd)", ".rscd TESTS)")
    with touched_later(script, asked), touched_later(manifest, text):
        done = build(model_workspace, *(["run_tests_follower_robot"] if version == 1 else []))
        if version == 2:
            with middleware(model_workspace, tmp_path / "run") as processes:
                # This run has a ROS domain of its own.
                played(
                    ["colcon", "test", "--packages-select", "follower_robot"], model_workspace, processes.environment
                )
        results = {1: ["catkin_test_results", "build/test_results"], 2: ["colcon", "test-result", "--verbose"]}[version]
        told = played(results, model_workspace, model_workspace.environment())
        # The launch system counts two tests for each trace, CTest counts the program.
        assert f"Summary: {1 + version} tests, 0 errors, 0 failures, 0 skipped" in told, done.output + told


def test_what_stops_a_build(model_workspace: Workspace) -> None:
    """Each fault stops the build. One build at the end repairs everything, because a build takes seconds."""
    a_fault_stops_it_with_its_place(model_workspace)
    what_the_package_does_not_declare_is_listed(model_workspace)
    a_definition_that_changes_is_read_again(model_workspace)
    assert build(model_workspace).status == 0


def a_fault_stops_it_with_its_place(model_workspace: Workspace) -> None:
    model = source(model_workspace, "follower_robot", "person_follower.rscd")
    text = model.read_text(encoding="utf-8")
    right = "  requirement move needs EmergencyStop.in_service and Lidar.sensing and PersonDetector.detected\n"
    assert right in text
    line = right.replace("detected", "detectd").rstrip("\n")
    with touched_later(model, text.replace(right, f"{line}\n")):
        done = build(model_workspace)
        assert done.status != 0
        number = text[: text.index("requirement move")].count("\n") + 1
        column = line.index("detectd") + 1
        assert f"{model}:{number}:{column}: error: " in done.output
        assert f"    {line}\n    {' ' * (column - 1)}^^^^^^^\n" in done.output
        assert "did you mean `detected`?" in done.output


def a_definition_that_changes_is_read_again(model_workspace: Workspace) -> None:
    """The build depends on the definitions that the model uses, and checks the model against them."""
    definition = source(model_workspace, "bboxes_ex_msgs", "msg/BoundingBox.msg")
    text = definition.read_text(encoding="utf-8")
    with touched_later(definition, text.replace("img_width", "img_breadth")):
        done = build(model_workspace)
        assert done.status != 0
        assert "person_follower.rscd" in done.output
        assert "img_width" in done.output


def what_the_package_does_not_declare_is_listed(model_workspace: Workspace) -> None:
    package = source(model_workspace, "follower_robot", "package.xml")
    text = package.read_text(encoding="utf-8")
    library, tag = {1: ("roscpp", "exec_depend"), 2: ("rclcpp", "depend")}[model_workspace.ros.version]
    without = text.replace("  <depend>geometry_msgs</depend>\n", "")
    without = without.replace(f"<depend>{library}</depend>", f"<build_depend>{library}</build_depend>")
    with touched_later(package, without):
        done = build(model_workspace)
        assert done.status != 0
        said = done.output.partition("Add to it:\n")[2].partition("CMake Error")[0]
        assert said.split() == ["<depend>geometry_msgs</depend>", f"<{tag}>{library}</{tag}>"]


def played(command: list[str], workspace: Workspace, environment: dict[str, str]) -> str:
    """Return the output of a command that plays traces or counts results."""
    return subprocess.run(
        command, cwd=workspace.folder, env=environment, capture_output=True, text=True, check=False
    ).stdout


def lines(path: Path) -> list[dict[str, Any]]:
    """Return the objects in a file of JSON lines."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
