"""What every node brings with it, compiled and called."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.diagnostics.visible import HIDDEN
from robosc.runtime.core.json_text import json_text

if TYPE_CHECKING:
    from robosc.configuration import Configuration

pytestmark = pytest.mark.build

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]


def run(compiler: str, source: str, sanitizers: str, files: dict[str, str], folder: Path) -> tuple[int, str, str]:
    """Builds a program with the headers of a package, runs it in a folder; how it ends and what it prints."""
    for path, text in files.items():
        if path.startswith("include/"):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    program = folder / "program"
    options = ["-std=c++17", "-g", *WARNINGS, f"-fsanitize={sanitizers}", "-pthread", f"-I{folder / 'include'}"]
    subprocess.run([compiler, *options, Path(__file__).parent / source, "-o", program], check=True)
    # The program's addresses stay where ThreadSanitizer expects them.
    command = ["setarch", "--addr-no-randomize", program, folder]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
def test_numbers_arrays_fields_and_json(
    compiler: str, courier: robosc.Models, settings: Configuration, tmp_path: Path
) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    files = robosc.generate("ros1", courier, settings)
    assert run(compiler, "headers.cpp", "undefined", files, tmp_path) == (0, "", "")
    for text in ("".join(chr(each) for bounds in HIDDEN for each in bounds if each), 'größer 漢字 🤖 "\\ \n'):
        told = subprocess.run([tmp_path / "program", tmp_path, text], capture_output=True, check=True).stdout.decode()
        assert told == json_text(text)
        assert json.loads(told) == text


@pytest.mark.parametrize("sanitizers", ["address,undefined", "thread"])
def test_what_threads_and_signals_touch(
    sanitizers: str, courier: robosc.Models, settings: Configuration, tmp_path: Path
) -> None:
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    files = robosc.generate("ros2", courier, settings)
    assert run("g++", "threads.cpp", sanitizers, files, tmp_path) == (0, "", "")
