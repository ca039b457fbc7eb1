"""The headers that generated packages share: style, separate compilation, behavior."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.base.diagnostics.visible import HIDDEN
from robosc.model.semantics.communication import QUEUE_DEPTH
from robosc.model.semantics.definition import TRANSITIONS_KEPT
from robosc.run.runtime.core.json_text import json_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.language.configuration import Configuration

pytestmark = pytest.mark.build

INCLUDE = Path(robosc.__file__).parent / "m2t" / "ros" / "include"
HEADERS = sorted(path.relative_to(INCLUDE).as_posix() for path in INCLUDE.rglob("*.hpp"))
VERSION = "robosc/version.hpp"
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]


def run(
    compiler: str, source: str, sanitizers: str, files: dict[str, str], folder: Path, *others: Path
) -> tuple[int, str, str]:
    """Build a program with the headers of a package and run it in a folder; return its exit status and output."""
    for path, text in files.items():
        if path.startswith("include/"):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    program = folder / "program"
    options = ["-std=c++17", "-g", *WARNINGS, f"-fsanitize={sanitizers}", "-pthread", f"-I{folder / 'include'}"]
    subprocess.run([compiler, *options, Path(__file__).parent / source, *others, "-o", program], check=True)
    # ThreadSanitizer needs the program at its expected addresses.
    command = ["setarch", "--addr-no-randomize", program, folder]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=900)
    return done.returncode, done.stdout, done.stderr


def test_clang_format_leaves_them_as_they_are() -> None:
    command = [Path(sys.executable).parent / "clang-format", "--dry-run", "-Werror", *HEADERS]
    done = subprocess.run(command, cwd=INCLUDE, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_all_are_of_one_version_and_guarded_by_their_names() -> None:
    for header in HEADERS:
        text = (INCLUDE / header).read_text(encoding="utf-8")
        guard = re.sub(r"\W", "_", header).upper() + "_"
        assert f"#ifndef {guard}\n#define {guard}\n" in text
        if header != VERSION:
            assert "\nnamespace robosc {\ninline namespace ROBOSC_VERSION {\n" in text
            assert f'\n#include "{VERSION}"\n' in text


def test_their_version_follows_what_stands_in_them(golden: Callable[[Path, str], None]) -> None:
    """The headers' namespace has a version that depends on their content.

    One process may contain packages of two versions of the tool: different code needs different linker names.
    """
    texts = [f"{header}\n{(INCLUDE / header).read_text(encoding='utf-8')}" for header in HEADERS if header != VERSION]
    digest = hashlib.sha256("".join(texts).encode()).hexdigest()
    place = INCLUDE / VERSION
    named = re.sub(r"(#define ROBOSC_VERSION) \w+", rf"\1 v{digest[:8]}", place.read_text(encoding="utf-8"))
    golden(place, named)


def middleware(header: str) -> list[str] | None:
    """Return the options that find a header's middleware includes; None if the middleware is not installed."""
    if header.startswith("robosc_ros1/"):
        return [] if Path("/usr/include/ros/ros.h").exists() and Path("/usr/include/actionlib").exists() else None
    if header.startswith("robosc_ros2/"):
        prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if prefix]
        folders = [folder for prefix in prefixes for folder in (prefix / "include").glob("*") if folder.is_dir()]
        return [f"-isystem{folder}" for folder in folders] if any(f.name == "rclcpp" for f in folders) else None
    return []


@pytest.fixture(scope="module")
def node_handle(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Return a compiler command that has precompiled `<ros/node_handle.h>`."""
    compiler = ["clang++", "-std=c++17", *WARNINGS]
    if shutil.which(compiler[0]) is None:
        return ["g++", *compiler[1:]]
    precompiled = tmp_path_factory.mktemp("precompiled") / "node_handle.pch"
    command = [*compiler, "-x", "c++-header", "/usr/include/ros/node_handle.h", "-o", precompiled]
    subprocess.run(command, check=True)
    return [*compiler, "-include-pch", str(precompiled)]


@pytest.mark.parametrize("header", HEADERS)
def test_compiles_alone(header: str, request: pytest.FixtureRequest) -> None:
    found = middleware(header)
    if found is None or shutil.which("g++") is None:
        pytest.skip(f"no g++, or no {header.partition('/')[0].removeprefix('robosc_')}")
    compiler = ["g++", "-std=c++17", *WARNINGS]
    includes = re.findall(r"^#include <(.*)>", (INCLUDE / header).read_text(encoding="utf-8"), re.MULTILINE)
    if {"ros/node_handle.h", "ros/ros.h"} & {*includes}:
        # Its own includes are compiled once for all such headers: they take longer than all these headers.
        compiler = request.getfixturevalue("node_handle")
    command = [*compiler, "-fsyntax-only", f"-I{INCLUDE}", *found, "-x", "c++", "-"]
    text = f'#include "{header}"\n'
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False, timeout=900)
    assert (done.returncode, done.stderr) == (0, "")


def test_hidden_characters_are_those_of_the_tool() -> None:
    rows = re.findall(r"\{0x([0-9A-F]+), 0x([0-9A-F]+)\},", (INCLUDE / "robosc/json.hpp").read_text(encoding="utf-8"))
    assert [(int(first, 16), int(last, 16)) for first, last in rows] == list(HIDDEN)


def test_as_many_transitions_are_kept_as_in_the_node_that_is_not_generated() -> None:
    text = (INCLUDE / "robosc/transitions.hpp").read_text(encoding="utf-8")
    assert re.findall(r"kTransitionsKept = (\d+);", text) == [str(TRANSITIONS_KEPT)]


def test_as_many_messages_wait_as_in_the_node_that_is_not_generated() -> None:
    text = (INCLUDE / "robosc/queue_depth.hpp").read_text(encoding="utf-8")
    assert re.findall(r"kQueueDepth = (\d+);", text) == [str(QUEUE_DEPTH)]
    queue = re.compile(rf"(?:advertise|subscribe|create_publisher|Publisher\(|QoS).*\b{QUEUE_DEPTH}\b")
    texts = {
        path: path.read_text(encoding="utf-8") for path in (*INCLUDE.rglob("*.hpp"), *INCLUDE.parent.rglob("*.j2"))
    }
    assert len(texts) > len(HEADERS)
    assert [path.name for path, text in texts.items() if queue.search(text)] == []


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
def test_numbers_arrays_fields_and_json(
    compiler: str, courier: robosc.Models, settings: Configuration, tmp_path: Path
) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    files = robosc.generate("ros1", courier, settings)
    assert run(compiler, "headers.cpp", "undefined", files, tmp_path) == (0, "", "")
    for text in ("".join(chr(bound) for bounds in HIDDEN for bound in bounds if bound), 'größer 漢字 🤖 "\\ \n'):
        told = subprocess.run([tmp_path / "program", tmp_path, text], capture_output=True, check=True).stdout.decode()
        assert told == json_text(text)
        assert json.loads(told) == text


@pytest.mark.parametrize("source", ["calls.cpp", "goals.cpp", "servers.cpp", "timeouts.cpp", "transitions.cpp"])
def test_without_middleware(source: str, tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    files = {f"include/{header}": (INCLUDE / header).read_text(encoding="utf-8") for header in HEADERS}
    assert run("g++", source, "address,undefined", files, tmp_path) == (0, "", "")


@pytest.mark.parametrize("sanitizers", ["address,undefined", "thread"])
def test_what_threads_and_signals_touch(
    sanitizers: str, courier: robosc.Models, settings: Configuration, tmp_path: Path
) -> None:
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    files = robosc.generate("ros2", courier, settings)
    assert run("g++", "threads.cpp", sanitizers, files, tmp_path) == (0, "", "")
