"""What docs/workspace.md says of building, what is seen of it by make, and files that change while one watches."""

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
    """The blocks of a language (`sh`, `cmake`) in a section of the page, as they stand there."""
    (text,) = re.findall(rf"^## {re.escape(section)}\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def built_again(output: str) -> list[str]:
    """The object files that make says it has built, without their folders."""
    return re.findall(r"Building \w+ object (?:\S*/)?(\S+)", output)


def no_work_is_done(output: str) -> bool:
    """Whether make says nothing but that all is built, and CMake at most that what is installed is as it was."""
    lines = [line for line in output.splitlines() if re.match(r"(\[ *\d+%|-- )", line)]
    idle = r"\[ *\d+%\] Built target |-- Install configuration|-- Up-to-date: "
    # ament lists its environment anew each time, and rosidl installs some of what it makes of messages again.
    again = r"-- Installing: .*/(package\.dsv|\w+__type_support\.c|[\w.-]+\.egg-info/\S+)$"
    return any("Built target" in line for line in lines) and all(re.match(f"{idle}|{again}", line) for line in lines)


@contextmanager
def touched_later(file: Path, text: str) -> Iterator[None]:
    """A file with another text, and after the block with its own again; each later than whatever was built before."""
    before = file.read_text(encoding="utf-8")
    _write(file, text)
    try:
        yield
    finally:
        _write(file, before)


def _write(file: Path, text: str) -> None:
    """Where time passes in steps, what is written right after a build would be as old as that."""
    earlier = file.stat().st_mtime_ns
    file.write_text(text, encoding="utf-8")
    later = max(file.stat().st_mtime_ns, earlier + 1)
    os.utime(file, ns=(later, later))
