"""The generated packages, built by the platform's own tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace


def test_builds_without_warnings(workspace: Workspace) -> None:
    assert ": warning:" not in workspace.build
    assert "CMake Warning" not in workspace.build
