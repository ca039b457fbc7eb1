"""Reads models from XMI files and reports all errors at once."""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, MutableMapping
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple, TypeAlias
from urllib.parse import unquote

from pyecore.ecore import EClass, EEnum

from robosc.base.diagnostics import START, Diagnostic, ModelError, Severity, Span
from robosc.base.files.reading import read
from robosc.model._ecore import packages
from robosc.model.places import Place, SourceFile
from robosc.model.reflection import features, is_attribute
from robosc.model.xmi.format import XMI, XSI, from_text
from robosc.model.xmi.markup import Element, parse

#: Returns the faults of a model, given its root: elements, and the reasons.
Faults: TypeAlias = Callable[[Any], Iterable[tuple[Any, str]]]
#: Root classes of a file: the classes of each metamodel that describe a complete model.
ROOTS = {
    "robosc": ("Robot", "Library"),
    "sct": ("SupervisoryControlModel",),
    "rosgraph": ("RosGraph",),
    "engine": ("EngineModel",),
}
_ECORE = "http://www.eclipse.org/emf/2002/Ecore"
_FRAGMENT = re.compile(r"/(/@\w+(\.[0-9]{1,9})?)*", re.ASCII)
_ADDRESS = re.compile(r"[\w.+-]+:|/")


def load(
    path: str | Path,
    texts: MutableMapping[str, str] | None = None,
    locate: Callable[[str], str | None] | None = None,
    *,
    faults: Faults,
) -> Any:
    """Load the model in an XMI file, with all files that it refers to, and return its root element.

    These must be in the file's folder or below. Raises ModelError with all findings, located in the files: `syntax` for
    invalid XML; `xmi` for contents that violate the metamodels, for broken references, and for `faults` of a model
    (`robosc.model.validity`). Never opens a network address or expands an entity.

    `texts` receives the text of each file, by the file name of findings. `locate` maps the name of a source text in the
    model to the path that the user would write. If it is None or returns None, the name stays.
    """
    loading = _Loading(Path(path), {} if texts is None else texts, faults)
    if locate is not None:
        for source in loading.sources.values():
            source.path = locate(source.name) or source.name
    return loading.root


class Reference(NamedTuple):
    """An unresolved reference. `target` is a fragment path, with a file's relative path before the `#`."""

    element: Any
    feature: Any
    target: str
    where: Callable[[], Span]


@dataclass(eq=False)
class Document:
    """A file: its name as the user would write it, its root (None if it has no usable one) and its findings.

    `sources` are the source files of the elements by name, for all documents of a model.
    """

    name: str
    path: Path
    sources: dict[str, SourceFile]
    root: Any = None
    markup: dict[Any, Element] = field(default_factory=dict)
    references: list[Reference] = field(default_factory=list)
    findings: list[Diagnostic] = field(default_factory=list)
    #: File of places that do not name one.
    source: str = ""

    def report(self, span: Span, message: str, hint: str | None = None) -> None:
        """Add a finding of the rule `xmi`."""
        self.findings.append(Diagnostic(self.name, span, Severity.ERROR, "xmi", message, hint))

    def build(self, top: Element) -> None:
        """Create the elements of the file with the outermost XML element `top`. References stay unresolved."""
        metaclass = self._root_class(top)
        if metaclass is None:
            return
        self.root = metaclass.python_class()
        self.source = top.attributes.get(("", "file"), "")
        pending = [(top, self.root)]
        while pending:
            markup, element = pending.pop()
            self.markup[element] = markup
            pending += reversed(self._fill(markup, element))

    def _root_class(self, top: Element) -> Any:
        package = _package(top.namespace)
        if top.namespace == _ECORE:
            self.report(top.span, "this is a metamodel (Ecore), not a model")
        elif (top.namespace, top.name) == (XMI, "XMI"):
            self.report(top.span, "this file has several models, expected one")
        elif package is None:
            known = ", ".join(packages()[root].nsURI for root in ROOTS)
            self.report(top.span, f"no model of RoboSC has the namespace '{top.namespace}'", f"known are {known}")
        elif top.name not in ROOTS.get(package.name, ()):
            alternatives = ", ".join(name for names in ROOTS.values() for name in names)
            self.report(top.span, f"a {top.name} cannot be the root of a file", f"expected {alternatives}")
        else:
            return package.getEClassifier(top.name)
        return None

    def _fill(self, markup: Element, element: Any) -> list[tuple[Element, Any]]:
        """Set the features of an element. Create its children and return them."""
        declared, named = features(element.eClass), a(element.eClass)
        counts = Counter(self._fill_attributes(markup, element))
        children = list(self._fill_children(markup, element, counts))
        if markup.text.strip():
            self.report(markup.span, f"{named} cannot have text")
        for name, feature in declared.items():
            # Features that EMF omits have a default: a boolean, a number, the first literal of an enumeration.
            if feature.lowerBound and name not in counts and (feature.many or getattr(element, name) is None):
                self.report(markup.span, f"{named} needs '{name}'")
        return children

    def _fill_attributes(self, markup: Element, element: Any) -> Iterator[str]:
        """Set the features that XML attributes hold, and yield their names."""
        for (namespace, name), text in markup.attributes.items():
            if namespace in (XMI, XSI) and name in ("version", "type", "schemaLocation"):
                continue
            feature = None if namespace else features(element.eClass).get(name)
            where = partial(markup.attribute_span, name)
            if feature is None or (not is_attribute(feature) and feature.containment):
                self.report(where(), f"{a(element.eClass)} has no attribute '{name}'")
                continue
            yield name
            if is_attribute(feature):
                self._set(element, feature, text, where)
            elif not feature.many and len(text.split()) != 1:
                self.report(where(), f"'{name}' refers to one element")
            else:
                self.references += [Reference(element, feature, f"#{target}", where) for target in text.split()]

    def _fill_children(self, markup: Element, element: Any, counts: Counter[str]) -> Iterator[tuple[Element, Any]]:
        """Set the features that child elements hold, and yield the children that are model elements.

        `counts` counts the values of each feature.
        """
        for child in markup.children:
            feature = None if child.namespace else features(element.eClass).get(child.name)
            where = partial(getattr, child, "span")
            if feature is None:
                self.report(where(), f"{a(element.eClass)} has no '{child.name}'")
                continue
            counts[child.name] += 1
            if counts[child.name] > 1 and not feature.many:
                self.report(where(), f"{a(element.eClass)} has only one '{child.name}'")
            elif is_attribute(feature):
                self._set(element, feature, child.text, where)
            elif not feature.containment:
                target = child.attributes.get(("", "href"), "")
                self.references.append(Reference(element, feature, target, where))
            elif (metaclass := self._child_class(child, feature)) is not None:
                child_element = metaclass.python_class()
                _put(element, feature, child_element)
                yield child, child_element

    def _child_class(self, child: Element, feature: Any) -> Any:
        """Return the class of a child: the class that it names, else its feature's.

        If it is invalid, report it and return None.
        """
        classifier = feature.eType if child.type is None else _classifier(*child.type)
        if classifier is None or not isinstance(classifier, EClass):
            written = child.attributes.get((XSI, "type"))
            self.report(child.attribute_span("xsi:type"), f"unknown class '{written}'")
        elif not issubclass(classifier.python_class, feature.eType.python_class):
            self.report(child.span, f"'{feature.name}' expects {a(feature.eType)}, found {a(classifier)}")
        elif classifier.abstract:
            self.report(child.span, f"{classifier.name} is abstract", "write its class with xsi:type")
        else:
            return classifier
        return None

    def _set(self, element: Any, feature: Any, text: str, where: Callable[[], Span]) -> None:
        kind = feature.eType
        value = Place.parse(text, self.sources, self.source) if kind.eType is Place else from_text(kind, text)
        if value is None:
            literals = ", ".join(literal.name for literal in kind.eLiterals) if isinstance(kind, EEnum) else ""
            hint = f"one of {literals}" if literals else None
            self.report(where(), f"'{feature.name}' cannot be '{text[:80]}'", hint)
        else:
            _put(element, feature, value)


class _Loading:
    def __init__(self, path: Path, texts: MutableMapping[str, str], faults: Faults) -> None:
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
        findings = [
            finding for document in documents for finding in sorted(document.findings, key=lambda item: item.span)
        ]
        if findings:
            raise ModelError(findings)

    def _read(self, name: str, path: Path) -> Document:
        """Read a file and all files that it refers to."""
        main = self._documents[path] = Document(name, path, self.sources)
        pending = [main]
        while pending:
            document = pending.pop()
            try:
                content = read(document.path)
                self._texts[document.name] = content.decode("utf-8", errors="replace")
                document.build(parse(content, document.name))
            except OSError as error:
                document.report(START, f"the file cannot be read: {error.strerror}")
            except ModelError as error:
                document.findings += error.diagnostics
            pending += self._referred(document)
        return main

    def _referred(self, document: Document) -> list[Document]:
        """Return the files that a file refers to and that are not read yet."""
        documents = []
        for reference in document.references:
            href = unquote(reference.target.partition("#")[0])
            if not href or (document, href) in self._sought:
                continue
            self._sought.add((document, href))
            path = self._path(document, href)
            if path is None:
                message = f"'{href}' is not in the folder of this model or below; other files are not read"
                document.report(reference.where(), message)
            elif not path.is_file():
                document.report(reference.where(), f"the file '{href}' does not exist")
            elif path not in self._documents:
                name = (PurePosixPath(document.name).parent / href).as_posix()
                documents.append(self._documents.setdefault(path, Document(name, path, self.sources)))
        return documents

    def _path(self, document: Document, href: str) -> Path | None:
        """Return the path of a relative href. None if it leaves the folder."""
        if "\0" in href or "\\" in href or _ADDRESS.match(href):
            return None
        path = (document.path.parent / href).resolve()
        return path if path.is_relative_to(self._folder) else None

    def _resolve(self, document: Document, reference: Reference) -> None:
        href, _, fragment = reference.target.partition("#")
        path = self._path(document, unquote(href)) if href else document.path
        other = None if path is None else self._documents.get(path)
        if other is None or other.root is None:
            return  # reported at the first reference to the file, or in the file
        element, feature = reference.element, reference.feature
        target = _walk(other.root, fragment)
        shown = reference.target.removeprefix("#")
        if target is None:
            document.report(reference.where(), f"'{feature.name}' refers to '{shown}', which does not exist")
        elif not isinstance(target, feature.eType.python_class):
            message = f"'{feature.name}' refers to {a(target.eClass)}, expected {a(feature.eType)}"
            document.report(reference.where(), message)
        elif feature.many and target in getattr(element, feature.name):
            document.report(reference.where(), f"'{feature.name}' names '{shown}' twice")
        else:
            _put(element, feature, target)


def _put(element: Any, feature: Any, value: object) -> None:
    """Set a feature, or append to one with many values."""
    if feature.many:
        getattr(element, feature.name).append(value)
    else:
        setattr(element, feature.name, value)


def a(metaclass: Any) -> str:
    """Return the name of a class with its article."""
    return f"{'an' if metaclass.name[0] in 'AEIOU' else 'a'} {metaclass.name}"


def _package(uri: str | None) -> Any:
    return next((package for package in packages().values() if package.nsURI == uri), None)


@cache
def _classifier(uri: str | None, name: str) -> Any:
    package = _package(uri)
    return None if package is None else package.getEClassifier(name)


def _walk(root: Any, fragment: str) -> Any:
    """Return the element at a fragment path, or None."""
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
