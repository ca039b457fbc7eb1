"""The generated C++ of a ROS 2 node with everything in it, read by clang-tidy: see `.clang-tidy`."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent


@pytest.mark.parametrize("package", ["porter_controller", "managed_porter"])
def test_clang_tidy_is_content(ros2_workspace: Workspace, package: str) -> None:
    if shutil.which("clang-tidy") is None:
        pytest.skip("no clang-tidy (Debian: clang-tidy)")
    build = ros2_workspace.folder / "build" / package
    environment = ros2_workspace.environment()
    command = ["cmake", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "."]
    subprocess.run(command, cwd=build, env=environment, check=True, capture_output=True)
    source = ros2_workspace.folder / "src" / package / "src" / f"{package}_node.cpp"
    options = [
        f"--config-file={HERE / '.clang-tidy'}",
        "-p",
        build,
        f"--header-filter=include/({package}|robosc_?[a-z0-9]*)/.*",
    ]
    done = subprocess.run(
        ["clang-tidy", *options, "--extra-arg=-std=c++17", "--quiet", source.resolve()],
        env=environment,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stdout
