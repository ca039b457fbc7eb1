"""clang-tidy has no findings in the generated C++ of controllers and layers with all features: see `.clang-tidy`."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent

#: `run-tests` does not install clang-tidy, which needs half a minute of CPU time for each node.
pytestmark = pytest.mark.matrix


# `usher_layer` is missing: clang-tidy 14 does not finish its file with ROS 2, see docs/sanitizers.md.
@pytest.mark.parametrize("package", ["porter_controller", "managed_porter", "guard_layer"])
def test_clang_tidy_is_content_with_ros_2(ros2_workspace: Workspace, package: str) -> None:
    build = ros2_workspace.folder / "build" / package
    command = ["cmake", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "."]
    subprocess.run(command, cwd=build, env=ros2_workspace.environment(), check=True, capture_output=True)
    assert said(ros2_workspace, package, ["-p", str(build), "--extra-arg=-std=c++17"], []) == ""


def test_clang_tidy_is_content_with_ros_1(ros1_workspace: Workspace) -> None:
    package = "porter_controller"
    assert said(ros1_workspace, package, [], ["--", *ros1_workspace.compiler_options(package)]) == ""


def said(workspace: Workspace, package: str, options: list[str], compiler: list[str]) -> str:
    """Return the findings of clang-tidy about a node and its generated headers."""
    if shutil.which("clang-tidy") is None:
        pytest.skip("no clang-tidy (Debian: clang-tidy)")
    headers = f"--header-filter=include/({package}|robosc_?[a-z0-9]*)/.*"
    command = ["clang-tidy", f"--config-file={HERE / '.clang-tidy'}", headers, "--quiet", *options]
    done = subprocess.run(
        [*command, workspace.source(package).resolve(), *compiler],
        env=workspace.environment(),
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    return done.stdout if done.returncode else ""
