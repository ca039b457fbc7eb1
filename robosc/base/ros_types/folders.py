"""Definitions in folders: the user's own packages and those of a ROS installation."""

from __future__ import annotations

import os
import re
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.files import reading as files
from robosc.base.interruption import checkpoint
from robosc.base.ros_types.wire import FOLDERS, DefinitionError, Fields, Section

if TYPE_CHECKING:
    from collections.abc import Iterator

_SECTIONS = {"message": 1, "service": 2, "action": 3}
_NAME = re.compile(r"<name>\s*([A-Za-z][\w-]*)\s*</name>")
#: Words in the manifest of a package for one ROS version; a package with words of both or none is for both.
_BUILT_FOR = {"ROS 1": re.compile(r"catkin|message_generation"), "ROS 2": re.compile(r"ament_|rosidl_")}
#: Maximum number of folders below a folder of the call that are searched. A full workspace has some hundred.
MOST_FOLDERS = 10_000
#: Marker files of folders that build tools skip.
_IGNORED = {"AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"}


class Share:
    """A folder of installed packages, each in a folder with its name."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._fields: dict[Path, list[Fields]] = {}

    @property
    def folder(self) -> Path:
        """The folder itself."""
        return self._folder

    def fields(self, package: str, name: str, section: Section) -> Fields | None:
        """Return the fields of a section of a type, or None if the folder has no such type.

        Raises DefinitionError.
        """
        folder = FOLDERS[section.kind]
        for root in self.roots(package):
            path = root / folder / f"{name}.{folder}"
            if path not in self._fields:
                if not path.exists():
                    continue
                self._fields[path] = _sections(path, package, section)
            return self._fields[path][section.index]
        return None

    def names(self, package: str, kind: str) -> list[str]:
        """Return the names of all types of a kind that a package defines."""
        folder = FOLDERS[kind]
        return sorted(path.stem for root in self.roots(package) for path in (root / folder).glob(f"*.{folder}"))

    def packages(self) -> list[str]:
        """Return the names of all packages that define types."""
        return self._packages

    def defines(self, package: str) -> bool:
        """Return whether a package defines types."""
        return any(_defines_types(root) for root in self.roots(package))

    @cached_property
    def _packages(self) -> list[str]:
        return [path.name for path in self._folder.iterdir() if _defines_types(path)] if self._folder.is_dir() else []

    def roots(self, package: str) -> list[Path]:
        """Return the folders of a package."""
        return [self._folder / package] if (self._folder / package).is_dir() else []


class Workspace(Share):
    """A folder with the packages of one ROS version anywhere below it, or the folder of a single package.

    The name of a package is that in its `package.xml`, else that of its folder.
    """

    def __init__(self, folder: Path, ros: str) -> None:
        super().__init__(folder)
        self._ros = ros
        self._searched = 0

    def roots(self, package: str) -> list[Path]:
        """Return the folders of a package, in the order of their paths."""
        return self._roots.get(package, [])

    def packages(self) -> list[str]:
        """Return the names of all packages."""
        return list(self._roots)

    @cached_property
    def _roots(self) -> dict[str, list[Path]]:
        packages: dict[str, list[Path]] = {}
        for name, root in self._definitions():
            packages.setdefault(name, []).append(root)
        return packages

    @property
    def is_too_large(self) -> bool:
        """Whether it has more than `MOST_FOLDERS` folders, so that the search was incomplete."""
        _ = self._roots
        return self._searched > MOST_FOLDERS

    def _definitions(self) -> Iterator[tuple[str, Path]]:
        seen = set()
        for folder, below, names in os.walk(self._folder, followlinks=True):  # as the tools of ROS do
            checkpoint()
            self._searched += 1
            if self._searched > MOST_FOLDERS:
                return
            root = Path(folder)
            place = os.path.realpath(folder)
            if place in seen:  # A link leads to an enclosing folder.
                below.clear()
                continue
            seen.add(place)
            if _IGNORED.intersection(names):
                below.clear()
            elif "package.xml" in names:
                below.clear()  # Packages do not nest.
                manifest = ""
                with suppress(OSError):
                    manifest = _text(root / "package.xml")
                named = _NAME.search(manifest)
                if self._fits(manifest):
                    yield named[1] if named else root.resolve().name, root
            else:
                if set(FOLDERS.values()).intersection(below):
                    yield root.resolve().name, root
                below[:] = sorted(name for name in below if not name.startswith("."))

    def _fits(self, manifest: str) -> bool:
        meant = [ros for ros, words in _BUILT_FOR.items() if words.search(manifest)]
        return self._ros in (meant or _BUILT_FOR)


def _defines_types(root: Path) -> bool:
    return any((root / folder).is_dir() for folder in FOLDERS.values())


def _sections(path: Path, package: str, section: Section) -> list[Fields]:
    from robosc.base.ros_types.rosbags_types import sections  # takes long to load

    try:
        return sections(_text(path), package, _SECTIONS[section.kind])
    except OSError as error:
        raise DefinitionError(f"{path}: {error.strerror}") from None
    except DefinitionError as fault:
        raise DefinitionError(f"{path}: {fault}") from None


def _text(path: Path) -> str:
    return files.read(path).decode("utf-8", errors="replace")
