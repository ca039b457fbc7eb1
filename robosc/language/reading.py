"""Reads a file and the libraries that it imports."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Repair, in_order
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.language.failures import names_failures
from robosc.language.libraries import LibraryPath
from robosc.language.linking import link
from robosc.language.name_findings import RULE
from robosc.language.recovery import parse_file
from robosc.language.syntax_messages import did_you_mean
from robosc.language.text import Documents, decode
from robosc.model import robosc as rsc
from robosc.model.semantics.failures import PREDEFINED

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.builder import Name
    from robosc.language.scopes import File

#: Path of the library that every model can use without an import.
_PREDEFINED = "stdlib/predefined/predefined.rscd"


@dataclass(frozen=True)
class Reading:
    """Result of reading a file.

    `base` is the robot or library of the file, without its unreadable parts, or None if its first line is unreadable.
    `findings` are the faults of the text and its names, in order, including those of imported libraries.
    `files` maps the paths that the findings use to all files that were read, beginning with the file itself.
    """

    base: rsc.Base | None
    findings: list[Diagnostic]
    files: dict[str, File]

    @property
    def file(self) -> File:
        """The file itself."""
        return next(iter(self.files.values()))

    @property
    def texts(self) -> dict[str, str]:
        """Contents of all files that were read, by the paths that the findings use."""
        return {path: file.text.content for path, file in self.files.items()}


def read(
    path: Path | str,
    library_paths: Iterable[Path | str] = (),
    ros_types: RosTypes | None = None,
    documents: Documents | None = None,
) -> Reading:
    """Read a robot or a library and all that it imports, and link the names.

    `library_paths` are searched after the file's own folder and before ROBOSC_PATH and the standard library.
    `ros_types` are the known ROS types; None for those that are known without folders of the call. `documents` are
    texts that replace files; None if there are only files. Raises OSError if the file itself cannot be read; all other
    faults are findings of the rules `syntax`, `unresolved-reference` and `import-cycle`.
    """
    folder = Path(path).parent.resolve()
    reader = _Reader(folder, library_paths, ros_types or RosTypes(), documents or Documents())
    file = reader.read(Path(path), str(path))
    return Reading(file.base, in_order(reader.findings), reader.files)


class _Reader:
    """Reads each file once; `_reading` holds the files in progress, each imported by the one before.

    Files wait for their libraries in this dictionary, so that a chain of imports can have any length.
    """

    def __init__(
        self, folder: Path, library_paths: Iterable[Path | str], ros_types: RosTypes, documents: Documents
    ) -> None:
        self._folder = folder
        self.findings: list[Diagnostic] = []
        self.files: dict[str, File] = {}
        self._documents = documents
        self._path = LibraryPath(library_paths, documents)
        self._names: dict[str, Path] = {}
        self._ros_types = ros_types
        self._files: dict[Path, File] = {}
        self._paths: dict[Path, Path] = {}
        self._reading: dict[Path, Iterator[Name]] = {}

    def read(self, path: Path, shown: str) -> File:
        """Return the linked file at a path, with all that it imports; findings call it `shown`."""
        first = self._open(path, shown)
        while self._reading:
            identity, names = next(reversed(self._reading.items()))
            file = self._files[identity]
            name = next((name for name in names if name.text not in file.libraries), None)
            if name is not None:
                file.libraries[name.text] = self._library(file, self._paths[identity], name)
                continue
            if file.predefined is None and names_failures(file):
                file.predefined = self._predefined()
                continue
            if file.base is not None:
                importable = partial(self._path.components, self._paths[identity])
                self.findings += link(file, self._ros_types, importable)
            del self._reading[identity]
        return first

    def _open(self, path: Path, shown: str) -> File:
        """Return a file and register it for reading its libraries, in the order of its text."""
        identity = path.resolve()
        content = self._documents.read(path)
        name = self._name(path)
        text, findings = decode(shown, content, name)
        self.findings += findings
        file = self.files[shown] = parse_file(text)
        self.findings += file.findings
        self._files[identity] = file
        self._paths[identity] = path
        references = file.references.items() if file.base is not None else ()
        self._reading[identity] = (
            names["library"] for element, names in references if isinstance(element, rsc.ImportedComponent)
        )
        if file.base is not None:
            file.base.file = name
        return file

    def _name(self, path: Path) -> str:
        """Return the name of a file in models.

        That is its path from the model's folder if it is below, else its bare name. If two files share a name, the
        later one gets as many of its parent folders as distinguish them.
        """
        whole = path.parent.resolve() / path.name
        if whole == locate(_PREDEFINED).resolve():
            return PREDEFINED
        shipped = locate("stdlib") in whole.parents
        name = (
            path.name
            if shipped or not whole.is_relative_to(self._folder)
            else whole.relative_to(self._folder).as_posix()
        )
        parts = len(PurePath(name).parts)
        while self._names.setdefault(name, whole) != whole:
            parts += 1
            name = PurePath(*whole.parts[-parts:]).as_posix()
        return name

    def _predefined(self) -> File:
        """Return the library that every model can use without an import."""
        path = locate(_PREDEFINED)
        identity = path.resolve()
        return self._files[identity] if identity in self._files else self._open(path, str(path))

    def _library(self, file: File, path: Path, name: Name) -> File | None:
        files = self._path.find(name.text, path)
        if len(files) != 1:
            self._report(file, name, *(self._several(name, files) if files else self._none(name, path)))
            return None
        identity = files[0].resolve()
        if identity in self._reading:
            reading = list(self._reading)
            cycle = [self._files[imported] for imported in reading[reading.index(identity) :]]
            names = [file.base.name for file in cycle if file.base is not None]
            message = f"libraries import each other in a circle: {' -> '.join([*names, name.text])}"
            self._report(file, name, message, "move the shared parts to a separate library", "import-cycle")
            return None
        return self._files[identity] if identity in self._files else self._open(files[0], str(files[0]))

    def _several(self, name: Name, files: list[Path]) -> tuple[str, str]:
        paths = " and ".join(f"`{path}`" for path in files)
        return f"library `{name.text}` is declared by several files of one folder: {paths}", "keep one of them"

    def _none(self, name: Name, path: Path) -> tuple[str, Repair | str]:
        where = "libraries are searched beside this file and in the folders of -I and ROBOSC_PATH"
        return f"there is no library `{name.text}`", did_you_mean(
            name.text, self._path.library_names(path), cutoff=0.75
        ) or where

    def _report(self, file: File, name: Name, message: str, repair: Repair | str, rule: str = RULE) -> None:
        self.findings.append(file.text.error(rule, name.start, name.end, message, repair))
