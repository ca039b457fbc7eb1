"""Texts of an editor and their analyses.

The server changes texts with each message. Answers are computed from a `Snapshot`, which never changes.
"""

from __future__ import annotations

import gc
import os
import re
import threading
from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from pygls.uris import from_fs_path, to_fs_path

from robosc.base.diagnostics import in_order
from robosc.base.files.search import files_below
from robosc.base.interruption import checkpoint
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.libraries import declared_name
from robosc.language.reading import read
from robosc.language.text import Documents, Text, decode
from robosc.model import robosc
from robosc.tools.editor.slices import LARGE, Slices

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from typing import Any

    from robosc.base.diagnostics import Diagnostic, Edit
    from robosc.language.reading import Reading
    from robosc.language.scopes import File, Reference

_BREAK = re.compile(r"\r\n|\r|\n")
#: Number of analyses after which the garbage collector for reference cycles runs.
_COLLECTED = 16
#: Seconds between two checkpoints of a thread that waits for the analysis by another one.
_WAIT = 0.05


@dataclass(frozen=True)
class Document:
    """An open text, with the version number of the editor."""

    uri: str
    version: int | None
    content: str


class Project:
    """The open texts of an editor, its folders, and the settings of the server."""

    def __init__(self, libraries: Sequence[Path | str] = (), interfaces: Sequence[Path | str] = ()) -> None:
        """Search `libraries` after a text's own folder, and ROS packages below the folders `interfaces`."""
        self.libraries = tuple(Path(folder).resolve() for folder in libraries)
        self.interfaces = tuple(interfaces)
        self.folders: tuple[Path, ...] = ()
        self._documents: Mapping[Path, Document] = {}
        self._memory = _Memory()
        self._ros_types: RosTypes | None = None

    def path(self, uri: str) -> Path:
        """Return the path of a document.

        A document without a file, such as an unsaved text, is in the first folder.
        """
        name = to_fs_path(uri)
        if name is not None:
            try:
                return Path(name).resolve()
            except (ValueError, RuntimeError):  # An invalid character, or a cycle of links.
                pass
        folder = self.folders[0] if self.folders else Path.cwd()
        return folder / quote(uri, safe="", errors="surrogatepass")

    def put(self, uri: str, version: int | None, content: str) -> Path:
        """Replace a file by an open text, or an open text by its new content."""
        path = self.path(uri)
        if path not in self._documents:
            self._memory.forget()
        self._documents = {**self._documents, path: Document(uri, version, content)}
        return path

    def change(self, uri: str, version: int | None, changes: Iterable[tuple[Range | None, str]]) -> None:
        """Replace ranges of an open text, one after the other.

        The positions are in UTF-16. None means the whole text.
        """
        document = self._documents.get(self.path(uri))
        if document is None:
            return
        content = document.content
        for place, text in changes:
            content = text if place is None else _replaced(content, place, text)
        self.put(uri, version, content)

    def close(self, uri: str) -> None:
        """Close an open text, so that its file counts again."""
        path = self.path(uri)
        self._documents = {other: document for other, document in self._documents.items() if other != path}
        self._memory.forget()

    def forget(self) -> None:
        """Drop all analyses, because files or settings have changed."""
        self._memory.forget()
        self._ros_types = None

    def snapshot(self) -> Snapshot:
        """Return the current state of the project."""
        self._ros_types = self._ros_types or RosTypes(self.interfaces)
        return Snapshot(self._documents, self.folders, self.libraries, self._ros_types, self._memory)

    def is_current(self, snapshot: Snapshot) -> bool:
        """Return whether no text has changed since a snapshot was taken."""
        return snapshot.documents is self._documents


#: First line and unit, last line and unit.
Range = tuple[int, int, int, int]


def _replaced(content: str, place: Range, text: str) -> str:
    """Replace a range of a text; the text has the line breaks of the editor."""
    line, unit, end_line, end_unit = place
    breaks = [match.span() for match in _BREAK.finditer(content)]
    start = _offset(content, breaks, line, unit)
    end = _offset(content, breaks, end_line, end_unit)
    return content[:start] + text + content[max(start, end) :]


def _offset(content: str, breaks: Sequence[tuple[int, int]], line: int, unit: int) -> int:
    if line > len(breaks):
        return len(content)
    start = breaks[line - 1][1] if line else 0
    end = breaks[line][0] if line < len(breaks) else len(content)
    return start + Text("", content[start:end]).from_utf16(0, unit)


@dataclass(eq=False)
class Analysis:
    """A text that was read and checked, with its findings."""

    path: Path
    reading: Reading
    findings: list[Diagnostic]

    @property
    def file(self) -> File:
        """The file of the text itself."""
        return self.reading.file

    @property
    def text(self) -> Text:
        """The text itself, with line feeds as line breaks."""
        return self.file.text

    @cached_property
    def declarations(self) -> Mapping[Any, tuple[File, Reference]]:
        """Declarations of the names of all elements, including those of libraries."""
        return {
            name.target: (file, name)
            for file in self.reading.files.values()
            for name in file.names
            if name.is_declaration
        }

    @property
    def is_large(self) -> bool:
        """Whether the text is too large to read it as a whole after each change."""
        return self.text.content.count("\n") >= LARGE

    @cached_property
    def slices(self) -> Slices:
        """Its definitions, for changes within one of them."""
        return Slices(self.file, self.findings)

    def key(self, element: Any) -> tuple[str, int] | None:
        """Return an identity of an element that all analyses share: the file and offset of its name."""
        declaration = self.declarations.get(element)
        return None if declaration is None else (declaration[0].text.file, declaration[1].start)


@dataclass
class _Memory:
    """The last analysis of each text, and the texts on which it depends."""

    analyses: dict[Path, tuple[Analysis, Mapping[Path, str], Mapping[Path, str | None]]] = field(default_factory=dict)
    analysis_count: int = 0
    locks: defaultdict[Path, threading.Lock] = field(default_factory=lambda: defaultdict(threading.Lock))

    @contextmanager
    def only_one(self, path: Path) -> Iterator[None]:
        """Let only one thread analyze a text.

        Other threads wait for its result, unless their own check interrupts them.
        """
        lock = self.locks[path]
        while not lock.acquire(timeout=_WAIT):
            checkpoint()
        try:
            yield
        finally:
            lock.release()

    def forget(self) -> None:
        self.analyses = {}

    def count(self) -> None:
        """Count an analysis; collect garbage now and then, because models contain reference cycles."""
        self.analysis_count += 1
        if self.analysis_count % _COLLECTED == 0:
            gc.collect()


@dataclass(frozen=True, eq=False)
class Snapshot:
    """The project at one moment. Analyses are created on demand and reused by later snapshots."""

    documents: Mapping[Path, Document]
    folders: tuple[Path, ...]
    libraries: tuple[Path, ...]
    ros_types: RosTypes
    memory: _Memory

    @cached_property
    def texts(self) -> Documents:
        """The open texts, which take precedence over the files."""
        return Documents({str(path): document.content for path, document in self.documents.items()})

    def analysis(self, path: Path) -> Analysis | None:
        """Return the analysis of the text at a path, or None if the text cannot be read."""
        with self.memory.only_one(path):
            return self._analysis(path)

    def _analysis(self, path: Path) -> Analysis | None:
        memory = self.memory.analyses
        known = memory.get(path)
        if known is not None:
            analysis, contents, headers = known
            same = all(self._content(file) == content for file, content in contents.items())
            if same and headers == self._headers:
                return analysis
        try:
            reading = read(path, self.libraries, self.ros_types, self.texts)
        except OSError:
            memory.pop(path, None)
            return None
        findings = in_order([*reading.findings, *check(reading.base, reading.findings, self.ros_types)])
        analysis = Analysis(path, reading, findings)
        files = [Path(file).resolve() for file in reading.files]
        contents = {file: self.documents[file].content for file in files if file in self.documents}
        memory[path] = analysis, contents, self._headers
        self.memory.count()
        return analysis

    def quick_findings(self, path: Path) -> tuple[Text, dict[str, Text], list[Diagnostic]] | None:
        """Return a large text, all texts by file, and the findings, after a change within one definition.

        Only the changed definition is read again. Returns None if its findings cannot be determined this way.
        """
        document, known = self.documents.get(path), self.memory.analyses.get(path)
        if document is None or known is None or document.content.count("\n") < LARGE:
            return None
        analysis, contents, headers = known
        others = {file: content for file, content in contents.items() if file != path}
        if headers != self._headers or any(self._content(file) != content for file, content in others.items()):
            return None
        text, faults = decode(analysis.text.file, document.content.encode("utf-8", "surrogatepass"))
        part = None if faults else analysis.slices.slice(text)
        if part is None:
            return None
        documents = {**self.documents, path: replace(document, content=part.content)}
        sliced = replace(self, documents=documents, memory=_Memory())
        reading = read(path, self.libraries, self.ros_types, sliced.texts)
        findings = part.findings([*reading.findings, *check(reading.base, reading.findings, self.ros_types)])
        texts = {file: other.text for file, other in analysis.reading.files.items()} | {text.file: text}
        return None if findings is None else (text, texts, in_order(findings))

    def _content(self, path: Path) -> str | None:
        document = self.documents.get(path)
        return None if document is None else document.content

    @cached_property
    def _headers(self) -> Mapping[Path, str | None]:
        """Names of the libraries that open texts declare: renaming one affects the imports of other texts."""
        return {
            path: declared_name(document.content.encode("utf-8", "surrogatepass"))
            for path, document in self.documents.items()
        }

    def apply_edits(self, edits: Mapping[Path, Iterable[Edit]]) -> Snapshot:
        """Return the project after edits of texts, by their paths."""
        documents = dict(self.documents)
        for path, changes in edits.items():
            before = documents.get(path) or Document(path.as_uri(), None, self.texts.read(path).decode())
            text, _ = decode(str(path), before.content.encode("utf-8", "surrogatepass"))
            documents[path] = replace(before, content=text.after(changes, before.content))
        return self.replace_documents(documents)

    def replace_documents(self, documents: Mapping[Path, Document]) -> Snapshot:
        """Return the project with other texts."""
        return replace(self, documents=documents, memory=_Memory())

    def models(self) -> list[Path]:
        """Return the paths of all open texts and of all texts in the editor's folders, hidden folders excluded."""
        paths = dict.fromkeys(self.documents)
        for folder in self.folders:
            paths |= dict.fromkeys(Path(path).resolve() for path in files_below(folder, ".rscd"))
        return list(paths)

    def analyses_with(self, word: str) -> Iterator[Analysis]:
        """Yield the analyses of all texts of the project that contain a word."""
        for path in self.models():
            try:
                content = self.texts.read(path, is_input=False)
            except OSError:
                continue
            if re.search(rf"\b{re.escape(word)}\b".encode(), content):
                analysis = self.analysis(path)
                if analysis is not None:
                    yield analysis

    def importers(self, paths: Iterable[Path]) -> Iterator[Analysis]:
        """Yield the analyses of all texts of the project that import one of these files, directly or not."""
        pending, known = list(paths), set(paths)
        while pending:
            analysis = self.analysis(pending.pop())
            base = None if analysis is None else analysis.reading.base
            if not isinstance(base, robosc.Library):
                continue
            for importer in self.analyses_with(base.name):
                if importer.path not in known:
                    known.add(importer.path)
                    pending.append(importer.path)
                    yield importer

    def uri(self, file: str) -> str:
        """Return the URI of a file; if the file is open, the URI of the editor."""
        document = self.documents.get(Path(file).resolve())
        return document.uri if document is not None else str(from_fs_path(os.fspath(file)))
