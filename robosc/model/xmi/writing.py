"""Writes models to XMI text."""

import posixpath
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote
from xml.sax.saxutils import escape, quoteattr

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model._ecore import PACKAGES, packages
from robosc.model.places import place
from robosc.model.reflection import contents, features, is_attribute
from robosc.model.xmi.format import DEEPEST, UNWRITABLE, XMI, XSI, to_text

_DEEPEST_INDENT = 40


def to_texts(roots: Mapping[str, Any]) -> dict[str, str]:
    """Return the text of each file for the root of its model, both by relative path with `/`.

    A reference to a model of another of these files becomes a relative href. The text depends only on the models and
    the relative paths. Raises ModelError for contents that XML cannot hold: a control character in a string, or nesting
    beyond that of any expression. Raises ValueError for a reference to an element outside of these models.
    """
    places: dict[Any, _Place] = {}
    for path, root in roots.items():
        places[root] = _Place(path, None, "")
        elements = [root]
        while elements:
            where = places[elements[-1]]
            for step, child in contents(elements.pop()):
                places[child] = _Place(path, where, step)
                elements.append(child)
    return {path: _Document(path, places).text(root) for path, root in roots.items()}


@dataclass(frozen=True, eq=False)
class _Place:
    """Place of an element: its file, the place of its container, and the step from there."""

    file: str
    container: "_Place | None"
    step: str

    @property
    def fragment(self) -> str:
        """Path from the root, computed on demand because few elements need it."""
        steps = []
        where: _Place | None = self
        while where is not None:
            steps.append(where.step)
            where = where.container
        return "/" + "/".join(reversed(steps))


@dataclass
class _Document:
    file: str
    places: Mapping[Any, _Place]
    used: set[str] = field(default_factory=set)

    def text(self, root: Any) -> str:
        package = self._prefix(root)
        lines: list[str] = []
        # End tags are in the same list as pending elements, so that no depth needs recursion.
        pending: list[tuple[int, str, Any]] = [(0, f"{package}:{root.eClass.name}", root)]
        while pending:
            depth, tag, element = pending.pop()
            if element is None:
                lines.append(f"{_indent(depth)}{tag}")
                continue
            if depth > DEEPEST:
                raise _unwritable(element, f"more than {DEEPEST} elements are inside each other")
            attributes, children = self._features(element)
            opened = "".join(f" {name}={quoteattr(value)}" for name, value in attributes)
            lines.append(f"{_indent(depth)}<{tag}{opened}{'>' if children else '/>'}")
            if children:
                pending.append((depth, f"</{tag}>", None))
                pending += [(depth + 1, tag_or_line, child) for tag_or_line, child in reversed(children)]
        return self._with_namespaces(lines, package, root)

    def _features(self, element: Any) -> tuple[list[tuple[str, str]], list[tuple[str, Any]]]:
        """Return the XML attributes and the children.

        A child is a tag and its model element, or a line and None.
        """
        attributes: list[tuple[str, str]] = self._type(element, element.eContainmentFeature())
        children: list[tuple[str, Any]] = []
        for name, feature in features(element.eClass).items():
            value = getattr(element, name)
            values = list(value) if feature.many else [] if value is None else [value]
            if not values:
                continue
            if is_attribute(feature):
                texts = [self._value(element, value) for value in values]
                if feature.many:
                    children += [(f"<{name}>{escape(text, {chr(13): '&#13;'})}</{name}>", None) for text in texts]
                else:
                    attributes.append((name, texts[0]))
            elif feature.containment:
                children += [(name, value) for value in values]
            else:
                targets = [self._target(element, name, value) for value in values]
                if all(target.file == self.file for target in targets):
                    attributes.append((name, " ".join(target.fragment for target in targets)))
                else:
                    children += [
                        (self._href(name, feature, value, target), None)
                        for value, target in zip(values, targets, strict=True)
                    ]
        return attributes, children

    def _href(self, name: str, feature: Any, element: Any, target: _Place) -> str:
        path = posixpath.relpath(target.file, posixpath.dirname(self.file) or ".") if target.file != self.file else ""
        attributes = [*self._type(element, feature), ("href", f"{quote(path)}#{target.fragment}")]
        return f"<{name}{''.join(f' {key}={quoteattr(value)}' for key, value in attributes)}/>"

    def _type(self, element: Any, feature: Any) -> list[tuple[str, str]]:
        """Return the attribute with an element's class, if its feature does not imply it."""
        # A class of another metamodel is a proxy in the feature, but its Python class is the same.
        if feature is None or feature.eType.python_class is element.eClass.python_class:
            return []
        return [("xsi:type", f"{self._prefix(element)}:{element.eClass.name}")]

    def _prefix(self, element: Any) -> str:
        package: str = element.eClass.ePackage.name
        self.used.add(package)
        return package

    def _target(self, element: Any, name: str, target: Any) -> _Place:
        if target not in self.places:
            raise ValueError(f"{name} of a {element.eClass.name} refers to a {target.eClass.name} of no saved model")
        return self.places[target]

    def _value(self, element: Any, value: Any) -> str:
        text = to_text(value)
        if UNWRITABLE.search(text):
            raise _unwritable(element, f"XML cannot represent a character of {text!r}")
        return text

    def _with_namespaces(self, lines: list[str], package: str, root: Any) -> str:
        tag = f"<{package}:{root.eClass.name}"
        spaces = {"xmi": XMI, "xsi": XSI} | {name: packages()[name].nsURI for name in PACKAGES if name in self.used}
        declared = "".join(f' xmlns:{prefix}="{uri}"' for prefix, uri in spaces.items())
        lines[0] = f'{tag} xmi:version="2.0"{declared}\n   {lines[0].removeprefix(tag)}'
        return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', *lines, ""])


def _indent(depth: int) -> str:
    """Return the indentation of a line.

    It is limited because it would be most of the text in an expression of thousands of operators.
    """
    return "  " * min(depth, _DEEPEST_INDENT)


def _unwritable(element: Any, message: str) -> ModelError:
    file, span = place(element)
    return ModelError([Diagnostic(file, span, Severity.ERROR, "xmi", message)])
