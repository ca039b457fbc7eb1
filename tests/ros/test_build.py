"""The generated packages build with the platform's own tool."""

from __future__ import annotations

import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

#: A node with services, actions and a watchdog; one with times, parameters and a typed state.
LARGEST = ("scout_controller", "porter_controller")


def test_builds_without_warnings(workspace: Workspace) -> None:
    # rosidl's own code for the packages of message types is not under test.
    warnings = [line for line in workspace.build.splitlines() if ": warning:" in line and "/rosidl_" not in line]
    assert warnings == []
    assert "CMake Warning" not in workspace.build


@pytest.mark.parametrize("package", LARGEST)
def test_gcc_has_nothing_to_say(ros1_workspace: Workspace, package: str) -> None:
    """Debian's g++, without precompiled headers, has no warnings; the other tests build with clang for speed."""
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    command = ["g++", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    command += ros1_workspace.compiler_options(package)
    done = subprocess.run([*command, ros1_workspace.source(package)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
