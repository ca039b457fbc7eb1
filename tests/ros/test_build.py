"""The generated packages, built by the platform's own tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace


def test_builds_without_warnings(workspace: Workspace) -> None:
    # What rosidl itself writes for the packages of message types is not ours.
    warnings = [line for line in workspace.build.splitlines() if ": warning:" in line and "/rosidl_" not in line]
    assert warnings == []
    assert "CMake Warning" not in workspace.build
