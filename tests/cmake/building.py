"""Blocks of docs/workspace.md about building, checks of the output of make, and temporary changes of files."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

PAGE = (Path(__file__).parents[2] / "docs" / "workspace.md").read_text(encoding="utf-8")


def blocks(section: str, language: str) -> list[str]:
    """Return the blocks of a language (`sh`, `cmake`) in a section of the page, unchanged."""
    (text,) = re.findall(rf"^## {re.escape(section)}\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def built_again(output: str) -> list[str]:
    """Return the names of the object files that make reports as built."""
    return re.findall(r"Building \w+ object (?:\S*/)?(\S+)", output)


def no_work_is_done(output: str) -> bool:
    """Whether make reports only finished targets, and CMake only unchanged installed files."""
    lines = [line for line in output.splitlines() if re.match(r"(\[ *\d+%|-- )", line)]
    idle = r"\[ *\d+%\] Built target |-- Install configuration|-- Up-to-date: "
    # ament lists its environment in each build, and rosidl reinstalls some of the files that it generates from
    # messages.
    again = r"-- Installing: .*/(package\.dsv|\w+__type_support\.c|[\w.-]+\.egg-info/\S+)$"
    return any("Built target" in line for line in lines) and all(re.match(f"{idle}|{again}", line) for line in lines)


@contextmanager
def touched_later(file: Path, text: str) -> Iterator[None]:
    """Replace the text of a file for a block of code; both changes get a time later than all earlier builds."""
    before = file.read_text(encoding="utf-8")
    _write(file, text)
    try:
        yield
    finally:
        _write(file, before)


def _write(file: Path, text: str) -> None:
    """Write a file with a new modification time, even if the clock of the file system is coarse."""
    earlier = file.stat().st_mtime_ns
    file.write_text(text, encoding="utf-8")
    later = max(file.stat().st_mtime_ns, earlier + 1)
    os.utime(file, ns=(later, later))
