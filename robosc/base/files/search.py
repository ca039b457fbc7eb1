"""Finds files below folders."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


def files_below(folder: Path | str, suffix: str, on_error: Callable[[OSError], object] | None = None) -> Iterator[str]:
    """Yield the paths of the files in a folder and below that end with a suffix, in order.

    Hidden folders, links, pipes and devices are skipped. `on_error` is called for unreadable folders; without it they
    are skipped.
    """
    for path, inner, names in os.walk(folder, onerror=on_error):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        files = (Path(path, name) for name in sorted(names) if name.endswith(suffix))
        yield from (str(file) for file in files if file.is_file() and not file.is_symlink())
