"""Hints that say what to write, and the edits that write it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.checks.definitions import unit_of
from robosc.checks.facts import fact
from robosc.diagnostics import Edit, Span
from robosc.diagnostics.lines import lines
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.diagnostics import Repair


class Insertion(NamedTuple):
    """A hint, and the text that does what it says, to be written before an element, or `behind` it.

    With `is_choice` it is one way of several: a person chooses.
    """

    hint: str
    text: str
    element: ex.Located
    behind: bool = False
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        return (Edit(_end_of(span) if self.behind else _start_of(span), self.text),)


class Replacement(NamedTuple):
    """A hint, and the text that does what it says in place of an element, or of what is before `until` in it."""

    hint: str
    text: str
    element: ex.Located
    is_choice: bool = False
    until: ex.Located | None = None

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        if self.until is not None:
            end = place(self.until)[1]
            span = Span(span.line, span.column, end.line, end.column)
        return (Edit(span, self.text),)


class Wrapping(NamedTuple):
    """A hint, and the texts that do what it says, before an element and behind it."""

    hint: str
    before: str
    behind: str
    element: ex.Located
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        return tuple(
            Edit(at, text) for at, text in ((_start_of(span), self.before), (_end_of(span), self.behind)) if text
        )


class Rewriting(NamedTuple):
    """A hint, and the text that takes the place of what a pattern finds first in an element, or of its group."""

    hint: str
    pattern: str
    text: str
    element: ex.Located
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element; nothing where that has no text."""
        return tuple(_rewritten(self.element, self.pattern, self.text))


class Removal(NamedTuple):
    """A hint that an element is to be left out, with the comma beside it, or with its line where it has one."""

    hint: str
    element: ex.Located
    is_choice: bool = True

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element; nothing where that has no text."""
        found = _offsets(self.element)
        if found is None:
            return ()
        content, start, end = found
        before, behind = content[:start].rstrip(), content[end:].lstrip()
        if before.endswith(","):
            start = len(before) - 1
        elif behind.startswith(","):
            end = len(content) - len(behind[1:].lstrip())
        else:
            line = content.rfind("\n", 0, start) + 1
            next_line = content.find("\n", end) + 1 or len(content)
            alone = not content[line:start].strip() and not content[end:next_line].strip()
            start, end = (line, next_line) if alone else (start, end + (content[end : end + 1] == " "))
        return (_edit(content, start, end, ""),)


class Cut(NamedTuple):
    """A hint that what stands behind one element up to the end of another one, and a `closing`, is to be left out."""

    hint: str
    behind: ex.Located
    last: ex.Located
    closing: str = ""
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the elements; nothing where that has no text."""
        first, second = _offsets(self.behind), _offsets(self.last)
        if first is None or second is None:
            return ()
        end = first[0].find(self.closing, second[2])
        return () if end < 0 else (_edit(first[0], first[2], end + len(self.closing), ""),)


class Unassigned(NamedTuple):
    """A hint that a transition is to assign nothing, and what stands in place of that."""

    hint: str
    transition: rsc.Transition
    text: str = ""
    is_choice: bool = True

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the transition; nothing where that has no text."""
        around, first = _offsets(self.transition), _offsets(self.transition.assignments[0])
        last = _offsets(self.transition.assignments[-1])
        if around is None or first is None or last is None:
            return ()
        content = around[0]
        before = content[around[1] : first[1]].rstrip()
        if re.search(r"\bdo\Z", before) is None:
            return ()
        return (_edit(content, around[1] + len(before[:-2].rstrip()), last[2], self.text),)


class Renaming(NamedTuple):
    """A hint that gives an element another name, wherever the text of its robot or library names it."""

    hint: str
    element: ex.NamedElement
    name: str
    is_choice: bool = True

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element; nothing where that has no text."""
        word = rf"(\^?{re.escape(self.element.name)})\b"
        declared = _rewritten(self.element, rf"\b(?:{_DECLARING})\s+{word}", self.name)
        found = list(declared) or list(_rewritten(self.element, rf"\A{word}", self.name))
        for part in fact(_named, unit_of(self.element)).get(self.element, ()) if found else ():
            found += _rewritten(part, _naming(part, self.element).replace("NAME", word), self.name)
        return tuple(dict.fromkeys(found))


class Together(NamedTuple):
    """A hint, and all that is to be done at once."""

    hint: str
    parts: tuple[Insertion | Replacement | Rewriting | Renaming, ...]
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the first part."""
        return tuple(edit for part in self.parts for edit in part.edits())

    @property
    def element(self) -> ex.Located:
        """What is changed first."""
        return self.parts[0].element


Way: TypeAlias = "Insertion | Replacement | Wrapping | Rewriting | Removal | Cut | Unassigned | Renaming | Together"


class Choice(NamedTuple):
    """A hint, and the ways to do what it says, among which a person chooses: each with a hint of its own."""

    hint: str
    ways: tuple[Way, ...]


#: How to mend what a rule found: words, the text that takes the place of the element, or what does it elsewhere.
Hint: TypeAlias = "str | Repair | Way | Choice"


def file_of(way: Way) -> str:
    """The file that a way to mend something changes."""
    match way:
        case Cut(behind=element) | Unassigned(transition=element):
            return place(element)[0]
    return place(way.element)[0]


#: Words that stand before a name that is declared.
_DECLARING = (
    "state|component|object|enum|variable|constant|parameter|condition|function|requirement|property|message|service"
    "|action|interface"
)


#: What names an element by which feature, and where in its text the name stands.
_NAMING: tuple[tuple[type, str, str], ...] = (
    (rsc.Access, "component", r"\ANAME(?=\s*\.)"),
    (rsc.Access, "enumeration", r"\ANAME(?=\s*\.)"),
    (rsc.Transition, "target", r"\bgoto\s+NAME\Z"),
    (rsc.RequirementTransition, "target", r"\bgoto\s+NAME\Z"),
    (rsc.CommunicationReference, "communicationType", r"NAME\Z"),
    (rsc.CommunicationReference, "component", r"\ANAME(?=\s*\.)"),
    (rsc.ComplexDataTypeReference, "type", r"\ANAME"),
    (rsc.PropertySegment, "property", r"NAME\Z"),
    (rsc.ObjectPropertyValue, "property", r"\ANAME"),
    (rsc.TopicRemapping, "communicationType", r"\ANAME"),
    (rsc.Call, "function", r"\ANAME"),
    (rsc.Argument, "parameter", r"\ANAME"),
    (rsc.InstantiatedComponent, "definition", r"\bis\s+NAME"),
    (rsc.InstanceQuantifier, "template", r"\A\w+\s+NAME"),
)


def _named(base: rsc.Base) -> dict[Any, list[Any]]:
    """By what is named in a robot or library what names it, in the order of the text."""
    found: dict[Any, list[Any]] = {}
    for _, part in tree(base):
        features = [feature for kind, feature, _ in _NAMING if isinstance(part, kind)]
        features += ["item"] if isinstance(part, rsc.Access) else []
        for element in dict.fromkeys(getattr(part, feature) for feature in features):
            if element is not None:
                found.setdefault(element, []).append(part)
    return found


def _naming(part: Any, element: Any) -> str:
    """The pattern of the name of an element, `NAME`, in the text of what names it."""
    if isinstance(part, rsc.Access) and part.item is element:
        own = part.component is not None and not _is_qualified(part, part.component)
        return r"\ANAME" if own else r"\A(?:\^?\w+\s*\.\s*)?NAME"
    rows = (row for row in _NAMING if isinstance(part, row[0]))
    return next(pattern for _, feature, pattern in rows if getattr(part, feature) is element)


def _is_qualified(access: rsc.Access, component: rsc.Component) -> bool:
    """Whether the text of an access names the component before the item."""
    content, start, end = _offsets(access) or ("", 0, 0)
    return re.match(rf"\^?{re.escape(component.name)}\s*\.", content[start:end]) is not None


def _rewritten(element: ex.Located, pattern: str, text: str) -> Iterator[Edit]:
    found = _offsets(element)
    match = re.search(pattern, found[0][found[1] : found[2]], re.DOTALL) if found is not None else None
    if found is not None and match is not None:
        first, behind = match.span(match.re.groups and 1)
        yield _edit(found[0], found[1] + first, found[1] + behind, text)


def _offsets(element: ex.Located) -> tuple[str, int, int] | None:
    """The text that an element stands in, and where; None where that is not known."""
    source = element.source
    if source is None or source.file is None or not source.file.content:
        return None
    content, span = source.file.content, source.span
    known = lines(content)
    return content, known.offset(span.line, span.column), known.offset(span.end_line, span.end_column)


def _edit(content: str, start: int, end: int, text: str) -> Edit:
    known = lines(content)
    return Edit(Span(*known.place(start), *known.place(end)), text)


def _start_of(span: Span) -> Span:
    """The place before a span."""
    return Span(span.line, span.column, span.line, span.column)


def _end_of(span: Span) -> Span:
    """The place behind a span."""
    return Span(span.end_line, span.end_column, span.end_line, span.end_column)
