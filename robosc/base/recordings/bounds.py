"""Limits for recordings from elsewhere: regular files, a budget for decompression, no computed tables."""

from __future__ import annotations

import bz2
import sqlite3
from contextlib import closing, contextmanager
from contextvars import ContextVar
from functools import partial
from importlib import import_module
from io import BytesIO
from types import SimpleNamespace
from typing import IO, TYPE_CHECKING, Any

from robosc.base.files.reading import MOST_BYTES, open_file

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

#: Budget of decompression: this many times the size of the recording, plus `MOST_BYTES`.
RATIO = 64
_MOST_METADATA = 4 << 20
#: Remaining budget of decompression in bytes, in a list of one; None for no limit.
_budget: ContextVar[list[int] | None] = ContextVar("budget", default=None)


class BoundError(Exception):
    """A recording that is too large, or that is more than a recording; the message gives the reason."""


def require_plain(folder: Path) -> None:
    """Check that all files of a recording are regular, and that its tables are stored, not computed.

    Raises OSError if a file is not regular or cannot be read, and BoundError.
    """
    for path in sorted(folder.iterdir()) if folder.is_dir() else [folder]:
        if path.is_dir():
            continue
        with open_file(path):
            if path.suffix == ".db3":
                _require_stored(path)
        if path.name == "metadata.yaml" and path.stat().st_size > _MOST_METADATA:
            raise BoundError(f"metadata.yaml has more than {_MOST_METADATA >> 20} MB, the most that is read")


def _require_stored(path: Path) -> None:
    """Check that a database has only tables of stored values: a view may compute without end.

    Raises BoundError. The reader reports files that are not databases.
    """
    with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as database:
        database.text_factory = lambda text: text.decode("utf-8", "replace")
        try:
            rows = database.execute("SELECT type, name, sql FROM sqlite_master").fetchall()
            for kind, name, text in rows:
                columns = database.execute("SELECT hidden FROM pragma_table_xinfo(?)", (name,)).fetchall()
                is_virtual = str(text).upper().lstrip().startswith("CREATE VIRTUAL")
                if kind not in {"table", "index"} or is_virtual or any(hidden for (hidden,) in columns):
                    raise BoundError(f"`{name}` of {path.name} is computed: a recording has stored tables only")
        except (sqlite3.Error, ValueError):  # ValueError: a message that is not UTF-8.
            return


@contextmanager
def limit_decompression(path: Path) -> Iterator[None]:
    """Limit the decompression of a recording within the `with` block: beyond its budget it raises BoundError."""
    files = [path] if path.is_file() else [file for file in path.iterdir() if file.is_file()]
    _install()
    token = _budget.set([MOST_BYTES + RATIO * sum(file.stat().st_size for file in files)])
    try:
        yield
    finally:
        _budget.reset(token)


def decompress(data: bytes, compression: str) -> bytes:
    """Return decompressed bytes. `compression` is `zstd`, `lz4`, `bz2` or empty. Raises BoundError."""
    if not compression:
        return data
    budget = _budget.get()
    with _open(BytesIO(data), compression) as file:
        if budget is None:
            return file.read()
        content = file.read(min(budget[0], MOST_BYTES) + 1)
    _take(len(content), min(budget[0], MOST_BYTES))
    return content


def _take(size: int, most: int) -> None:
    budget = _budget.get()
    if budget is None:
        return
    if size > most:
        raise BoundError(
            f"it is compressed to less than a {RATIO}th, or a part of it has more than {MOST_BYTES >> 20} MB: "
            "such a recording is not decompressed"
        )
    budget[0] -= size


class _Counted:
    """A decompressed file that can be read only within the budget."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file

    def __enter__(self) -> _Counted:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def read(self, size: int = -1) -> bytes:
        content = self._file.read(size)
        budget = _budget.get()
        _take(len(content), budget[0] if budget is not None else len(content))
        return content


def _open(file: IO[bytes], compression: str) -> IO[bytes]:
    lz4_frame = import_module("lz4.frame")  # has no types
    zstd = vars(import_module("rosbags.rosbag2.storage_mcap"))["zstd"]  # in the Python library from 3.14 on
    readers: dict[str, Any] = {"zstd": zstd.open, "lz4": lz4_frame.open, "bz2": bz2.open}
    reader: IO[bytes] = readers[compression](file, "rb")
    return reader


def _install() -> None:
    """Make rosbags decompress with the functions of this module."""
    bags: Any = import_module("rosbags.rosbag1.reader")  # takes long to load
    storage_mcap: Any = import_module("rosbags.rosbag2.storage_mcap")
    folders: Any = import_module("rosbags.rosbag2.reader")
    for name in ("bz2", "lz4"):
        bags.decompressors[name] = partial(decompress, compression=name)
    for name in ("lz4", "zstd"):
        storage_mcap.DECOMPRESSORS[name] = partial(_of_size, name)
    folders.zstd = SimpleNamespace(
        decompress=partial(decompress, compression="zstd"), open=lambda file, _: _Counted(_open(file, "zstd"))
    )


def _of_size(compression: str, data: bytes, _: int) -> bytes:
    return decompress(data, compression)
