"""The generated packages, built by the platform's own tool."""

from __future__ import annotations

import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

#: With services, actions and a watchdog; with times, parameters and a typed state.
LARGEST = ("scout_controller", "porter_controller")


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
    command = ["g++", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    command += ros1_workspace.compiler_options(package)
    done = subprocess.run([*command, ros1_workspace.source(package)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
