"""A class diagram as boxes and lines with coordinates, for the template of SVG to print."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.diagrams.layers import Link, Route, arrange
from robosc.diagrams.shapes import coordinate as _at
from robosc.diagrams.shapes import path, text_width

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.diagrams.classes import Class, ClassDiagram, Feature

_MARGIN = 24.0
_TITLE = 34.0
_ROW = 17.0
_PADDING = 8.0
_END = 13.0


@dataclass(frozen=True)
class Text:
    """A line of text in a box: its baseline, and how it is set (`name`, `abstract`, `note` or `row`)."""

    y: float
    text: str
    style: str


@dataclass(frozen=True)
class Box:
    """A class: its rectangle, the line below its head, its texts."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    line: float
    texts: Sequence[Text]
    documentation: str


@dataclass(frozen=True)
class Line:
    """A link: its kind (`inheritance`, `containment`, `reference`), its path, and the shape at its end."""

    kind: str
    path: str
    end: str


@dataclass(frozen=True)
class Drawing:
    """All boxes and lines."""

    width: float
    height: float
    boxes: Sequence[Box]
    lines: Sequence[Line]


@dataclass(frozen=True)
class _Head:
    """The texts of a class before they have a place; `ports` of the features are heights below its upper edge."""

    notes: Sequence[str]
    rows: Sequence[str]
    ports: Sequence[float]
    line: float
    width: float
    height: float

    @property
    def middle(self) -> float:
        """Where inheritance leaves and arrives."""
        return self.line / 2

    @property
    def low(self) -> float:
        """Where references arrive: beside inheritance, not on it."""
        return self.line - 5


def draw(diagram: ClassDiagram) -> Drawing:
    """Lays the diagram out. Inheritance and containment run from left to right where they form no circle."""
    heads = {shown.name: _head(shown) for shown in diagram.classes}
    kinds, links = _links(diagram, heads)
    arranged = arrange({name: (head.width, head.height) for name, head in heads.items()}, links)
    boxes = [
        _box(
            shown,
            heads[shown.name],
            *(offset + margin for offset, margin in zip(arranged.places[shown.name], _ORIGIN, strict=True)),
        )
        for shown in diagram.classes
    ]
    lines = [_line(kind, route) for kind, route in zip(kinds, arranged.routes, strict=True)]
    return Drawing(round(arranged.width + 2 * _MARGIN), round(arranged.height + 2 * _MARGIN + _TITLE), boxes, lines)


_ORIGIN = (_MARGIN, _MARGIN + _TITLE)


def _links(diagram: ClassDiagram, heads: dict[str, _Head]) -> tuple[list[str], list[Link]]:
    """The links with their kinds; those that matter most for the layout first."""
    found: list[tuple[str, Link]] = []
    for shown in diagram.classes:
        head = heads[shown.name]
        found += [
            ("inheritance", Link(parent, shown.name, heads[parent].middle, head.middle, True))
            for parent in shown.parents
        ]
        for feature, port in zip(shown.features, head.ports, strict=True):
            if _is_drawn(feature, shown):
                kind = "containment" if feature.containment else "reference"
                ranking = feature.containment or not feature.reference
                found.append((kind, Link(shown.name, feature.type, port, heads[feature.type].low, ranking)))
    order = ("inheritance", "containment", "reference")
    found.sort(key=lambda placed: order.index(placed[0]))
    return [kind for kind, _ in found], [link for _, link in found]


def _is_drawn(feature: Feature, owner: Class) -> bool:
    return feature.own and feature.type != owner.name


def _head(shown: Class) -> _Head:
    notes = ["«enumeration»"] if shown.literals else []
    notes += [f"extends {foreign_parent}" for foreign_parent in shown.foreign_parents]
    rows = [*shown.literals, *(_row(feature, shown) for feature in shown.features)]
    line = _PADDING + _ROW * (1 + len(notes))
    width = max(
        1.12 * text_width(shown.name, 13),
        *(text_width(row, 12) for row in rows),
        *(text_width(note, 10) for note in notes),
        60,
    )
    return _Head(
        notes=notes,
        rows=rows,
        ports=[line + _PADDING / 2 + _ROW * (index + 0.5) for index in range(len(shown.features))],
        line=line,
        width=width + 2 * _PADDING,
        height=line + (_PADDING + _ROW * len(rows) if rows else 0),
    )


def _row(feature: Feature, owner: Class) -> str:
    many = "" if feature.multiplicity == "1" else f" [{feature.multiplicity}]"
    mark = "" if not feature.reference or _is_drawn(feature, owner) else "◆ " if feature.containment else "→ "
    return f"{mark}{feature.name}: {feature.type}{many}"


def _box(shown: Class, head: _Head, x: float, y: float) -> Box:
    texts = [Text(_at(y + _ROW * (index + 0.5) + _PADDING), note, "note") for index, note in enumerate(head.notes)]
    name = "abstract" if shown.abstract else "name"
    texts.append(Text(_at(y + head.line - _PADDING / 2 - 4), shown.name, name))
    texts += [
        Text(_at(y + head.line + _PADDING / 2 + _ROW * (index + 0.75)), row, "row")
        for index, row in enumerate(head.rows)
    ]
    kind = "enumeration" if shown.literals else "abstract" if shown.abstract else "class"
    return Box(
        kind,
        _at(x),
        _at(y),
        _at(head.width),
        _at(head.height),
        _at(y + head.line),
        texts,
        shown.documentation,
    )


def _line(kind: str, route: Route) -> Line:
    points = [(x + _ORIGIN[0], y + _ORIGIN[1]) for x, y in route.points]
    (x, y), (end_x, end_y), way = points[0], points[-1], route.leaves
    match kind:
        case "inheritance":
            end = f"M{_at(x)} {_at(y)}l{way * _END} -6v12z"
            points[0] = (x + way * _END, y)
        case "containment":
            half = way * (_END - 1) / 2
            end = f"M{_at(x)} {_at(y)}l{half} -4.5l{half} 4.5l{-half} 4.5z"
            points[0] = (x + way * (_END - 1), y)
        case _:
            tip = f"{_at(end_x)} {_at(end_y)}"
            end = f"M{_at(end_x - route.arrives * 8)} {_at(end_y - 4.5)}L{tip}l{-route.arrives * 8} 4.5"
    return Line(kind, path(points), end)
