"""Outline of a text for navigation: its definitions and their nesting."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.model import robosc as rsc
from robosc.model.reflection import contents

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.scopes import File

#: Elements with an entry of their own in the outline, even without a name.
_ITEMS = (rsc.StatedDefinition, rsc.DataStatement, rsc.ComponentBehaviour)
#: Named elements inside expressions and headers, which the outline omits.
_HIDDEN = (rsc.FormalParameter, rsc.ArrayElement)
#: Elements that span several lines and can be folded.
_FOLDED = (
    rsc.Base,
    rsc.Component,
    rsc.ComponentBehaviour,
    rsc.State,
    rsc.ComplexDataType,
    rsc.AutomatonRequirement,
    rsc.RequirementState,
    rsc.ObjectValue,
    rsc.CommunicationTypeSet,
    rsc.EventSet,
)


@dataclass(frozen=True)
class Item:
    """An entry of the outline: label, range of the element and of its name (offsets), and the nested entries."""

    element: Any
    name: str
    start: int
    end: int
    name_start: int
    name_end: int
    items: list[Item] = field(default_factory=list)


def outline(file: File) -> list[Item]:
    """Return the definitions of the readable parts of a text, nested as in the text."""
    roots: list[Item] = []
    items_by_element: dict[Any, Item] = {}
    for element in own_elements(file):
        name = file.declared_names.get(element)
        if isinstance(element, _HIDDEN) or (name is None and not isinstance(element, _ITEMS)):
            continue
        start, end = span(file, element)
        if name is not None:
            item = Item(element, name.text or "…", start, end, name.start, name.end)
        else:
            line_end = file.text.content.find("\n", start, end)
            first_end = end if line_end < 0 else line_end
            label = " ".join(file.text.content[start:first_end].removesuffix("{").split()) or "…"
            item = Item(element, label, start, end, start, first_end)
        around = element.eContainer()
        while around is not None and around not in items_by_element:
            around = around.eContainer()
        items_by_element[element] = item
        (roots if around is None else items_by_element[around].items).append(item)
    return roots


def folds(file: File) -> list[tuple[int, int]]:
    """Return the foldable ranges of a text, as offsets.

    Each range is a definition of several lines, up to its last brace.
    """
    return [span(file, element) for element in own_elements(file) if isinstance(element, _FOLDED)]


def around(file: File, offset: int) -> list[tuple[int, int]]:
    """Return the ranges of all elements that contain an offset or end at it, from the innermost to the whole text."""
    spans = {(0, len(file.text.content))}
    name = file.name_at(offset)
    if name is not None:
        spans.add((name.start, name.end))
    for element in own_elements(file):
        start, end = span(file, element)
        if start <= offset <= end:
            spans.add((start, end))
    # A selection can only grow: ranges that do not contain the previous one are dropped.
    ranges: list[tuple[int, int]] = []
    for start, end in sorted(spans, key=lambda place: (place[1] - place[0], place)):
        if not ranges or (start <= ranges[-1][0] and ranges[-1][1] <= end):
            ranges.append((start, end))
    return ranges


def span(file: File, element: Any) -> tuple[int, int]:
    """Return the range of an element in its text (offsets)."""
    place = element.source.span
    start = file.text.offset(place.line, place.column)
    return start, max(start, file.text.offset(place.end_line, place.end_column))


def own_elements(file: File) -> Iterator[Any]:
    """Yield all elements that appear in the text itself, each before its contents.

    Elements created from a ROS definition appear in no text: they are below the reference that names the ROS type. The
    time is linear in the number of elements, however deep they are nested.
    """
    pending = [] if file.base is None else [file.base]
    while pending:
        element = pending.pop()
        if element.source is not None:
            yield element
        if not isinstance(element, rsc.InterfaceTypeReference):
            pending += reversed([inner for _, inner in contents(element)])
