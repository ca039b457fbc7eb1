"""The elements of one XMI file, before its references are resolved."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from pyecore.ecore import EClass, EEnum

from robosc.diagnostics import Diagnostic, Severity, Span
from robosc.metamodel._ecore import packages
from robosc.metamodel.places import Place, SourceFile
from robosc.metamodel.reflection import features, is_attribute
from robosc.metamodel.xmi.format import XMI, XSI, a
from robosc.metamodel.xmi.markup import Element
from robosc.metamodel.xmi.values import from_text

#: What a file may hold: a class of each metamodel that describes something whole.
ROOTS = {
    "robosc": ("Robot", "Library"),
    "sct": ("SupervisoryControlModel",),
    "rosgraph": ("RosGraph",),
    "engine": ("EngineModel",),
}
_ECORE = "http://www.eclipse.org/emf/2002/Ecore"


@dataclass(frozen=True)
class Reference:
    """A reference to be resolved: `target` is a fragment path, with a file's relative path before the `#`.

    It stands in an attribute of its own name, or is an element.
    """

    element: Any
    feature: Any
    target: str
    markup: Element
    is_attribute: bool

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.markup.attribute_span(self.feature.name) if self.is_attribute else self.markup.span


@dataclass(eq=False)
class Document:
    """A file: its name as the user would write it, its root (None where it has no usable one) and what was found.

    `sources` are the files that the elements come from, by their names, for all documents of a model.
    """

    name: str
    path: Path
    sources: dict[str, SourceFile]
    root: Any = None
    #: The file of the places that name none.
    source: str = ""
    markup: dict[Any, Element] = field(default_factory=dict)
    references: list[Reference] = field(default_factory=list)
    findings: list[Diagnostic] = field(default_factory=list)

    def place(self, text: str) -> Place | None:
        """The place in a source that a text stands for; None where it stands for none."""
        return Place.parse(text, self.sources, self.source)

    def report(self, span: Span, message: str, hint: str | None = None) -> None:
        """Adds a finding of the rule `xmi`."""
        self.findings.append(Diagnostic(self.name, span, Severity.ERROR, "xmi", message, hint))


def build(document: Document, top: Element) -> None:
    """Makes the elements of the file whose outermost XML element is `top`."""
    metaclass = _root_class(document, top)
    if metaclass is None:
        return
    document.root = metaclass.python_class()
    document.source = top.attributes.get(("", "file"), "")
    pending = [(top, document.root)]
    while pending:
        markup, element = pending.pop()
        document.markup[element] = markup
        filling = _Filling(document, markup, element)
        filling.run()
        pending += reversed(filling.children)


def _root_class(document: Document, top: Element) -> Any:
    package = _package(top.namespace)
    if top.namespace == _ECORE:
        document.report(top.span, "this is a metamodel (Ecore), not a model")
    elif (top.namespace, top.name) == (XMI, "XMI"):
        document.report(top.span, "this file has several models; one is wanted")
    elif package is None:
        known = ", ".join(packages()[root].nsURI for root in ROOTS)
        document.report(top.span, f"no model of RoboSC has the namespace '{top.namespace}'", f"known are {known}")
    elif top.name not in ROOTS.get(package.name, ()):
        wanted = ", ".join(name for names in ROOTS.values() for name in names)
        document.report(top.span, f"a file can't hold a {top.name} by itself", f"it may hold {wanted}")
    else:
        return package.getEClassifier(top.name)
    return None


def _package(uri: str | None) -> Any:
    return next((package for package in packages().values() if package.nsURI == uri), None)


@cache
def _classifier(uri: str | None, name: str) -> Any:
    package = _package(uri)
    return None if package is None else package.getEClassifier(name)


class _Filling:
    """Sets the features of one element; its children are made, but not filled."""

    def __init__(self, document: Document, markup: Element, element: Any) -> None:
        self.document = document
        self.markup = markup
        self.element = element
        self.features = features(element.eClass)
        self.class_name = a(element.eClass)
        self.given: dict[str, int] = {}
        self.children: list[tuple[Element, Any]] = []

    def run(self) -> None:
        for (namespace, name), text in self.markup.attributes.items():
            if namespace not in (XMI, XSI) or name not in ("version", "type", "schemaLocation"):
                self.attribute(namespace, name, text)
        for child in self.markup.children:
            self.child(child)
        if self.markup.text.strip():
            self.document.report(self.markup.span, f"{self.class_name} holds no text")
        for name, feature in self.features.items():
            # What EMF leaves out has a default: a boolean, a number, the first literal of an enumeration.
            if feature.lowerBound and name not in self.given and (feature.many or getattr(self.element, name) is None):
                self.document.report(self.markup.span, f"{self.class_name} needs '{name}'")

    def attribute(self, namespace: str, name: str, text: str) -> None:
        feature = None if namespace else self.features.get(name)
        if feature is None or (not is_attribute(feature) and feature.containment):
            self.document.report(self.markup.attribute_span(name), f"{self.class_name} has no attribute '{name}'")
            return
        self.given[name] = 1
        if is_attribute(feature):
            self.set(feature, text, lambda: self.markup.attribute_span(name))
            return
        targets = text.split()
        if len(targets) != 1 and not feature.many:
            self.document.report(self.markup.attribute_span(name), f"'{name}' refers to one element")
            return
        self.document.references += [
            Reference(self.element, feature, f"#{target}", self.markup, is_attribute=True) for target in targets
        ]

    def child(self, child: Element) -> None:
        feature = None if child.namespace else self.features.get(child.name)
        if feature is None:
            self.document.report(child.span, f"{self.class_name} has no '{child.name}'")
            return
        self.given[child.name] = self.given.get(child.name, 0) + 1
        if self.given[child.name] > 1 and not feature.many:
            self.document.report(child.span, f"{self.class_name} has only one '{child.name}'")
        elif is_attribute(feature):
            self.set(feature, child.text, lambda: child.span)
        elif feature.containment:
            self.contain(child, feature)
        else:
            target = child.attributes.get(("", "href"), "")
            self.document.references.append(Reference(self.element, feature, target, child, is_attribute=False))

    def contain(self, child: Element, feature: Any) -> None:
        metaclass = self.child_class(child, feature)
        if metaclass is None:
            return
        made = metaclass.python_class()
        self.children.append((child, made))
        if feature.many:
            getattr(self.element, feature.name).append(made)
        else:
            setattr(self.element, feature.name, made)

    def child_class(self, child: Element, feature: Any) -> Any:
        """The class of a child: the one that it names, else its feature's; None with a finding where it can't be."""
        found = feature.eType
        written = child.attributes.get((XSI, "type"))
        if child.type is not None:
            found = _classifier(*child.type)
        if found is None or not isinstance(found, EClass):
            self.document.report(child.attribute_span("xsi:type"), f"there is no class '{written}'")
        elif not issubclass(found.python_class, feature.eType.python_class):
            message = f"'{feature.name}' wants {a(feature.eType)}, which {a(found)} is not"
            self.document.report(child.span, message)
        elif found.abstract:
            self.document.report(child.span, f"{found.name} is abstract", "say what it is with xsi:type")
        else:
            return found
        return None

    def set(self, feature: Any, text: str, where: Callable[[], Span]) -> None:
        value = self.document.place(text) if feature.eType.eType is Place else from_text(feature.eType, text)
        if value is None:
            kind = feature.eType
            hint = (
                f"one of {', '.join(literal.name for literal in kind.eLiterals)}" if isinstance(kind, EEnum) else None
            )
            self.document.report(where(), f"'{feature.name}' can't be '{text[:80]}'", hint)
        elif feature.many:
            getattr(self.element, feature.name).append(value)
        else:
            setattr(self.element, feature.name, value)
