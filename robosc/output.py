"""Writes generated files: all of them or none, only what changed, never outside of the folder that was named."""

from __future__ import annotations

import shutil
import tempfile
from contextlib import ExitStack
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


class OutputError(Exception):
    """Files could not be written, and none was; the message says why."""


def write(trees: Mapping[Path, Mapping[str, str]]) -> list[Path]:
    """Writes texts below folders, as UTF-8, and says which files are new or different.

    Each folder comes with its files: relative POSIX path to text. Missing folders are made. A file that has its text
    already keeps its time of change; files that are not mentioned are left alone. Scripts (`#!`) can be
    executed. Raises OutputError, after undoing everything, where something can't be written, leads out of its folder
    (by `..`, an absolute path or a link), or is asked to be two texts.
    """
    try:
        placed = {folder.resolve(): _placed(folder.resolve(), files) for folder, files in trees.items()}
        _refuse_conflicts(placed)
        changed = {
            folder: {path: text.encode() for path, text in files.items() if _content(path) != text.encode()}
            for folder, files in placed.items()
        }
        with ExitStack() as made:
            for folder, files in changed.items():
                if files:
                    _make(folder, made)
            _replace(changed)
            made.pop_all()
    except (OSError, RuntimeError) as error:  # a RuntimeError is how `resolve` reports links in a circle
        raise OutputError(_reason(error)) from error
    return [path for files in changed.values() for path in files]


def _placed(folder: Path, files: Mapping[str, str]) -> dict[Path, str]:
    placed = {}
    for name, text in files.items():
        relative = PurePosixPath(name)
        path = folder / relative
        if relative.is_absolute() or not relative.parts or ".." in relative.parts or "\\" in name:
            raise OutputError(f"{name} is no path inside of the output folder")
        if not path.parent.resolve().is_relative_to(folder):
            raise OutputError(f"{path} leads out of {folder}: there is a link on the way")
        if path.is_dir() and not path.is_symlink():
            raise OutputError(f"{path} is a folder: a file of that name can't be written")
        placed[path] = text
    return placed


def _refuse_conflicts(placed: Mapping[Path, Mapping[Path, str]]) -> None:
    texts: dict[Path, str] = {}
    for files in placed.values():
        for path, text in files.items():
            if texts.setdefault(path, text) != text:
                raise OutputError(f"{path} would be written twice, with different texts")


def _replace(changed: Mapping[Path, Mapping[Path, bytes]]) -> None:
    """Stages all files, then moves each into its place; what was there waits in the stage to be moved back."""
    with ExitStack() as stages, ExitStack() as moved:
        staged = []
        for folder, files in changed.items():
            if not files:
                continue
            # Inside of the folder: only there one can count on the right to write and on one file system.
            stage = Path(tempfile.mkdtemp(prefix=".robosc-", dir=folder))
            stages.callback(shutil.rmtree, stage, ignore_errors=True)
            for number, (path, content) in enumerate(files.items()):
                (stage / f"{number}.new").write_bytes(content)
                staged.append((stage / f"{number}.new", stage / f"{number}.old", path))
        for new, old, path in staged:
            _make(path.parent, moved)
            if path.is_file():
                shutil.copymode(path, new)
            if new.read_bytes().startswith(b"#!"):
                new.chmod(new.stat().st_mode | 0o111)
            if path.exists() or path.is_symlink():
                path.replace(old)
                moved.callback(old.replace, path)
            else:
                moved.callback(path.unlink, missing_ok=True)
            new.replace(path)
        moved.pop_all()


def _make(folder: Path, made: ExitStack) -> None:
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    for each in reversed(missing):
        each.mkdir()
        made.callback(each.rmdir)


def _content(path: Path) -> bytes | None:
    return path.read_bytes() if path.is_file() else None


def _reason(error: OSError | RuntimeError) -> str:
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return str(error)
