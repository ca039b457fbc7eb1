"""XMI files to models, with everything found wrong at once."""

import re
from collections.abc import Callable, MutableMapping
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from robosc.diagnostics import ModelError, Span
from robosc.files.reading import read
from robosc.metamodel.reflection import features, is_attribute
from robosc.metamodel.validity import faults
from robosc.metamodel.xmi.building import Document, Reference, build
from robosc.metamodel.xmi.format import a
from robosc.metamodel.xmi.markup import parse

if TYPE_CHECKING:
    from robosc.metamodel.places import SourceFile

_FRAGMENT = re.compile(r"/(/@\w+(\.[0-9]{1,9})?)*", re.ASCII)
_ADDRESS = re.compile(r"[\w.+-]+:|/")


def load(
    path: str | Path,
    texts: MutableMapping[str, str] | None = None,
    locate: Callable[[str], str | None] | None = None,
) -> Any:
    """The root element of the model in an XMI file; files that it refers to are loaded with it.

    These must lie in the file's folder or below. Raises ModelError with all findings, located in the files: `syntax`
    for what is no XML, `xmi` for what is no model of these metamodels, refers to nothing, or breaks a rule that every
    such model keeps (`robosc.metamodel.validity`). Nothing is ever fetched, and no entity expanded. `texts` gets
    what was read, by the names that findings carry. `locate` gives the path, as the user would write it, of a text
    that elements come from, by the name that the model has of it.
    """
    loading = _Loading(Path(path), {} if texts is None else texts)
    if locate is not None:
        for source in loading.sources.values():
            source.path = locate(source.name) or source.name
    return loading.root


class _Loading:
    def __init__(self, path: Path, texts: MutableMapping[str, str]) -> None:
        self._texts = texts
        self._folder = path.resolve().parent
        self._documents: dict[Path, Document] = {}
        self.sources: dict[str, SourceFile] = {}
        self._sought: set[tuple[Document, str]] = set()
        main = self._read(path.as_posix(), path.resolve())
        for document in self._documents.values():
            for reference in document.references:
                self._resolve(document, reference)
        self._stop_if_wrong()
        for document in self._documents.values():
            for element, message in faults(document.root):
                document.report(document.markup[element].span, message)
        self._stop_if_wrong()
        self.root = main.root

    def _stop_if_wrong(self) -> None:
        documents = self._documents.values()
        findings = [finding for one in documents for finding in sorted(one.findings, key=lambda found: found.span)]
        if findings:
            raise ModelError(findings)

    def _read(self, name: str, path: Path) -> Document:
        """Reads a file and all that it refers to."""
        main = self._documents[path] = Document(name, path, self.sources)
        pending = [main]
        while pending:
            document = pending.pop()
            try:
                content = read(document.path)
                self._texts[document.name] = content.decode("utf-8", errors="replace")
                build(document, parse(content, document.name))
            except OSError as error:
                document.report(Span(1, 1, 1, 1), f"the file can't be read: {error.strerror}")
            except ModelError as error:
                document.findings += error.diagnostics
            pending += self._referred(document)
        return main

    def _referred(self, document: Document) -> list[Document]:
        """The files that a file refers to, and that are not read yet."""
        found = []
        for reference in document.references:
            href = unquote(reference.target.partition("#")[0])
            if not href or (document, href) in self._sought:
                continue
            self._sought.add((document, href))
            path = self._path(document, href)
            if path is None:
                message = f"'{href}' is not in the folder of this model or below; nothing else is read"
                document.report(reference.span, message)
            elif not path.is_file():
                document.report(reference.span, f"there is no file '{href}'")
            elif path not in self._documents:
                name = (PurePosixPath(document.name).parent / href).as_posix()
                found.append(self._documents.setdefault(path, Document(name, path, self.sources)))
        return found

    def _path(self, document: Document, href: str) -> Path | None:
        """Where a relative href leads; None where it leads out of the folder."""
        if "\0" in href or "\\" in href or _ADDRESS.match(href):
            return None
        path = (document.path.parent / href).resolve()
        return path if path.is_relative_to(self._folder) else None

    def _resolve(self, document: Document, reference: Reference) -> None:
        href, _, fragment = reference.target.partition("#")
        path = self._path(document, unquote(href)) if href else document.path
        other = None if path is None else self._documents.get(path)
        if other is None or other.root is None:
            return  # reported where the file was looked for, or in the file
        element, feature = reference.element, reference.feature
        target = _walk(other.root, fragment)
        shown = reference.target.removeprefix("#")
        if target is None:
            document.report(reference.span, f"'{feature.name}' refers to '{shown}', where nothing is")
        elif not isinstance(target, feature.eType.python_class):
            message = f"'{feature.name}' refers to {a(target.eClass)}, but wants {a(feature.eType)}"
            document.report(reference.span, message)
        elif not feature.many:
            setattr(element, feature.name, target)
        elif target in getattr(element, feature.name):
            document.report(reference.span, f"'{feature.name}' names '{shown}' twice")
        else:
            getattr(element, feature.name).append(target)


def _walk(root: Any, fragment: str) -> Any:
    """The element at a fragment path; None where there is none."""
    if not _FRAGMENT.fullmatch(fragment):
        return None
    element = root
    for step in fragment.split("/@")[1:]:
        name, _, index = step.partition(".")
        feature = features(element.eClass).get(name)
        if feature is None or is_attribute(feature) or not feature.containment:
            return None
        element = getattr(element, name)
        if feature.many:
            element = element[int(index)] if index and int(index) < len(element) else None
        if element is None:
            return None
    return element
