"""Search for libraries by the names that their files declare."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.files.resources import locate
from robosc.language.tokens import Tokens

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.language.text import Documents

_BLANK = rb"(?:\s|//[^\n]*|/\*[\s\S]*?\*/)"
_HEADER = re.compile(rb"(?:\xef\xbb\xbf)?" + _BLANK + rb"*+library\b" + _BLANK + rb"*+\^?([A-Za-z_]\w*)")


def search_folders(folders: Iterable[Path | str]) -> list[Path]:
    """Return the folders of a call, those of ROBOSC_PATH, and the folder that ships with the tool."""
    environment = [folder for folder in os.environ.get("ROBOSC_PATH", "").split(os.pathsep) if folder]
    return [*map(Path, folders), *map(Path, environment), locate("stdlib")]


class LibraryPath:
    """Folders searched for libraries, each listed once."""

    def __init__(self, folders: Iterable[Path | str], documents: Documents) -> None:
        """Search `folders` first, then those of ROBOSC_PATH and the folder that ships with the tool."""
        self._folders = search_folders(folders)
        self._documents = documents
        self._declared: dict[Path, Mapping[str, list[Path]]] = {}

    def find(self, name: str, beside: Path) -> list[Path]:
        """Return the files that declare a library, all from the first folder that has one; empty if none has.

        `beside` is the importing file; its own folder is searched first. Unreadable folders and files without a library
        are skipped.
        """
        for folder in (beside.parent, *self._folders):
            files = self.declared_libraries(folder).get(name)
            if files:
                return files
        return []

    def library_names(self, beside: Path) -> list[str]:
        """Return the names of all libraries that a file could import from."""
        return [name for folder in (beside.parent, *self._folders) for name in self.declared_libraries(folder)]

    def components(self, beside: Path) -> Mapping[str, str]:
        """Return the components of all libraries that a file could import from, each with its first library."""
        by_name: dict[str, str] = {}
        for folder in (beside.parent, *self._folders):
            for library, paths in self.declared_libraries(folder).items():
                for name in self._component_names(paths[0]):
                    by_name.setdefault(name, library)
        return by_name

    def _component_names(self, path: Path) -> list[str]:
        try:
            tokens = Tokens(self._documents.read(path, is_input=False).decode("utf-8", errors="replace"))
        except OSError:
            return []
        return [tokens[at + 1].text for at, token in enumerate(tokens) if token.is_keyword("component")]

    def declared_libraries(self, folder: Path) -> Mapping[str, list[Path]]:
        """Return the paths of a folder's libraries by name; each path starts with the folder's path."""
        if folder not in self._declared:
            libraries: dict[str, list[Path]] = {}
            for path in self._documents.models(folder):
                name = self._declared_name(path)
                if name is not None:
                    libraries.setdefault(name, []).append(path)
            self._declared[folder] = libraries
        return self._declared[folder]

    def _declared_name(self, path: Path) -> str | None:
        try:
            return declared_name(self._documents.read(path, is_input=False))
        except OSError:
            return None


def declared_name(content: bytes) -> str | None:
    """Return the name of the library that a UTF-8 text declares, or None if it declares none."""
    match = _HEADER.match(content)
    return match[1].decode("ascii") if match else None
