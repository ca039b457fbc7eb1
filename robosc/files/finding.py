"""Finds files below folders."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


def files_below(folder: Path | str, suffix: str, on_error: Callable[[OSError], object] | None = None) -> Iterator[str]:
    """The paths of the files in a folder and below that end with a suffix, in order.

    Hidden folders are left out, and so is what leads out of the folder, or waits for others: links, pipes, devices.
    `on_error` is told of folders that can't be read; without it they are passed over.
    """
    for path, inner, names in os.walk(folder, onerror=on_error):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        files = (Path(path, name) for name in sorted(names) if name.endswith(suffix))
        yield from (str(file) for file in files if file.is_file() and not file.is_symlink())
