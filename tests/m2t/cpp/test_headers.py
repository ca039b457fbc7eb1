"""What every node brings with it, compiled and called."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc

if TYPE_CHECKING:
    from robosc.config import Configuration

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
def test_numbers_arrays_fields_and_json(
    compiler: str, courier: robosc.Models, settings: Configuration, tmp_path: Path
) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    for path, text in robosc.generate("ros1", courier, settings).items():
        if path.startswith("include/"):
            (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path).write_text(text, encoding="utf-8")
    program = tmp_path / "headers"
    source = Path(__file__).parent / "headers.cpp"
    options = ["-std=c++17", *WARNINGS, "-fsanitize=undefined", f"-I{tmp_path / 'include'}"]
    subprocess.run([compiler, *options, source, "-o", program], check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
