"""Saved models with one fault: a changed reference, a doubled, dropped or retyped element, or an extreme attribute."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

#: Attribute values that must not crash the tool: numbers, booleans, empty text, line breaks and escapes of them.
EXTREMES = (
    *("", "0", "-1", "1", "3", "true", "false", "none", "x", "a b", "../../etc/passwd", "nan", "1e308", "0.5"),
    *(str(number) for number in (2**31 - 1, -(2**31), 2**63 - 1, -(2**63), 2**63, 10**400)),
    *("\x85", "\u2028", "\u202e", "\x9b31m", "\u200b", "&#10;", "&quot;&lt;&amp;", "\U0001f916", "9" * 5000),
)
_TAG = re.compile(r"<(/?)([\w:]+)((?:\s+[\w:]+=\"[^\"]*\")*)\s*(/?)>|<\?[^>]*\?>")
_ATTRIBUTE = re.compile(r"([\w:]+)=\"([^\"]*)\"")
_REFERENCE = re.compile(r"(?:[\w.]*#)?//\S*")


@dataclass
class Node:
    """An element: its position in the text, its reference path, the positions of its attributes, its children."""

    start: int
    tag: str
    kind: str
    path: str
    end: int = 0
    attributes: dict[str, tuple[int, int]] = field(default_factory=dict)
    children: list[Node] = field(default_factory=list)

    def all(self) -> Iterator[Node]:
        """Yield this element and all its descendants."""
        yield self
        for child in self.children:
            yield from child.all()


def parsed(text: str) -> Node:
    """Return the root element of a saved model."""
    stack: list[Node] = []
    counts: list[dict[str, int]] = [{}]
    root = None
    for found in _TAG.finditer(text):
        if found[2] is None:
            continue
        if found[1]:
            stack.pop().end = found.end()
            counts.pop()
            continue
        index = counts[-1].get(found[2], 0)
        counts[-1][found[2]] = index + 1
        path = f"{stack[-1].path}/@{found[2]}.{index}" if stack else "/"
        attributes = {match[1]: (match.start(2), match.end(2)) for match in _ATTRIBUTE.finditer(text, *found.span(3))}
        kind = text[slice(*attributes["xsi:type"])] if "xsi:type" in attributes else found[2]
        node = Node(found.start(), found[2], kind, path, found.end(), attributes)
        root = root or node
        if stack:
            stack[-1].children.append(node)
        if not found[4]:
            stack.append(node)
            counts.append({})
    assert root is not None
    return root


def edits(texts: Mapping[str, str], name: str, choose: int | None = None) -> Iterator[tuple[str, str]]:
    """Yield description and new text of each edit of the file `name`, with at most `choose` targets for a reference."""
    text = texts[name]
    trees = {path: parsed(other) for path, other in texts.items()}
    elements = list(trees[name].all())
    paths = [
        (element.path if file == name else f"{file}#{element.path}", element.kind, element.tag)
        for file, tree in trees.items()
        for element in tree.all()
    ]
    kinds = sorted({element.kind for element in elements if ":" in element.kind})
    for element in elements:
        for attribute, (start, end) in element.attributes.items():
            value = text[start:end]
            at = f"{element.path} {attribute}"
            if attribute == "xsi:type":
                yield from ((f"{at} = {kind}", text[:start] + kind + text[end:]) for kind in kinds if kind != value)
            elif _REFERENCE.match(value):
                yield from _redirected(text, at, (start, value), paths, choose)
            elif not attribute.startswith("xm"):
                yield from ((f"{at} = {other[:20]!r}", text[:start] + other + text[end:]) for other in EXTREMES)
                same = sorted(
                    {text[slice(*node.attributes[attribute])] for node in elements if attribute in node.attributes}
                )
                yield from (
                    (f"{at} = {other}", text[:start] + other + text[end:]) for other in same[:choose] if other != value
                )
            left = text.rindex(attribute, 0, start)
            yield f"{at} dropped", text[:left] + text[end + 1 :]
        if element.path == "/":
            continue
        own = text[element.start : element.end]
        yield f"{element.path} doubled", text[: element.end] + own + text[element.end :]
        yield f"{element.path} dropped", text[: element.start] + text[element.end :]
        others = [alike for alike in elements if alike.tag == element.tag and alike.path != element.path]
        for alike in _spread(others, choose):
            moved = text[alike.start : alike.end]
            yield f"{element.path} replaced by {alike.path}", text[: element.start] + moved + text[element.end :]


def _redirected(
    text: str, at: str, place: tuple[int, str], paths: Sequence[tuple[str, str, str]], choose: int | None
) -> Iterator[tuple[str, str]]:
    start, value = place
    for found in _REFERENCE.finditer(value):
        own = found[0]
        kind = next((kind for path, kind, _ in paths if _same(path, own)), None)
        for alike in (True, False):
            chosen = [path for path, other, _ in paths if (other == kind) is alike and not _same(path, own)]
            for path in _spread(chosen, choose):
                changed = value[: found.start()] + path + value[found.end() :]
                yield f"{at}: {own} -> {path}", text[:start] + changed + text[start + len(value) :]
    first = value.split(maxsplit=1)[0]
    yield f"{at} twice", text[:start] + f"{value} {first}" + text[start + len(value) :]


def _same(path: str, other: str) -> bool:
    return re.sub(r"\.0(?=/|$)", "", path) == re.sub(r"\.0(?=/|$)", "", other)


def _spread(all_of_them: Sequence[Any], choose: int | None) -> Sequence[Any]:
    """Return at most `choose` elements, evenly distributed."""
    if choose is None or len(all_of_them) <= choose:
        return all_of_them
    return [all_of_them[number * len(all_of_them) // choose] for number in range(choose)]
