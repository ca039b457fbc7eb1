"""The generated packages, built by the platform's own tool."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

#: With services, actions and a watchdog; with times, parameters and a typed state; with proxies.
LARGEST = ("scout_controller", "porter_controller", "usher_layer")


def test_builds_without_warnings(workspace: Workspace) -> None:
    # What rosidl itself writes for the packages of message types is not ours.
    warnings = [line for line in workspace.build.splitlines() if ": warning:" in line and "/rosidl_" not in line]
    assert warnings == []
    assert "CMake Warning" not in workspace.build


@pytest.mark.parametrize("package", LARGEST)
def test_gcc_has_nothing_to_say(ros1_workspace: Workspace, package: str) -> None:
    """The compiler of Debian, with nothing precompiled, of what clang builds here because it is faster."""
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    source = ros1_workspace.folder / "src" / package
    command = ["g++", "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    # As catkin has them: ROS's own headers are of the system.
    prefix = Path(ros1_workspace.ros.environment["ROS_PACKAGE_PATH"].partition(":")[0]).parent
    folders = [ros1_workspace.folder / "devel/include", prefix / "include", prefix / "include/xmlrpcpp"]
    command += [
        f"-I{source / 'include'}",
        *(f"-isystem{folder}" for folder in folders if folder != Path("/usr/include")),
    ]
    done = subprocess.run(
        [*command, source / "src" / f"{package}_node.cpp"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
