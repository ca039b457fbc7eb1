"""Drawing of a class diagram."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.diagrams.layers import Link, Route, arrange
from robosc.tools.diagrams.picture import MARGIN, TITLE, Pen, text_width

if TYPE_CHECKING:
    from robosc.tools.diagrams.classes import Class, ClassDiagram, Feature
    from robosc.tools.diagrams.picture import Picture

_ROW, _PADDING, _TIP = 17.0, 8.0, 13.0
#: The kinds of links, those with the most weight for the layout first.
_KINDS = ("inheritance", "containment", "reference")


class _Shape:
    """The rectangle of a class with its texts; heights are measured from its upper edge.

    Links of features start at `ports`. Inheritance links start and end at the `middle` of the head, references end
    `low` in it.
    """

    def __init__(self, shown: Class) -> None:
        self.shown = shown
        self.notes = ["«enumeration»"] if shown.literals else []
        self.notes += [f"extends {foreign_parent}" for foreign_parent in shown.foreign_parents]
        self.rows = [*shown.literals, *(_row(feature, shown) for feature in shown.features)]
        self.line = _PADDING + _ROW * (1 + len(self.notes))
        self.middle, self.low = self.line / 2, self.line - 5
        self.ports = [self.line + _PADDING / 2 + _ROW * (index + 0.5) for index in range(len(shown.features))]
        widths = [1.12 * text_width(shown.name, 13), 60.0, *(text_width(row, 12) for row in self.rows)]
        width = max(*widths, *(text_width(note, 10) for note in self.notes))
        self.size = (width + 2 * _PADDING, self.line + (_PADDING + _ROW * len(self.rows) if self.rows else 0.0))

    def draw(self, pen: Pen) -> None:
        kind = "enumeration" if self.shown.literals else "abstract" if self.shown.abstract else "class"
        width, _ = self.size
        pen.box(kind, (0.0, 0.0), self.size, 3, self.shown.documentation)
        for index, note in enumerate(self.notes):
            pen.text("note", width / 2, _ROW * (index + 0.5) + _PADDING, note)
        style = "title italic" if self.shown.abstract else "title"
        pen.text(style, width / 2, self.line - _PADDING / 2 - 4, self.shown.name)
        if self.rows:
            pen.line("rule", [(0.0, self.line), (width, self.line)])
        for index, row in enumerate(self.rows):
            pen.text("feature", _PADDING, self.line + _PADDING / 2 + _ROW * (index + 0.75), row)


def draw(diagram: ClassDiagram) -> Picture:
    """Lay out and draw a diagram. Inheritance and containment run from left to right, except in cycles."""
    shapes = {shown.name: _Shape(shown) for shown in diagram.classes}
    links = _links(diagram, shapes)
    arranged = arrange({name: shape.size for name, shape in shapes.items()}, [link for _, link in links])
    pen = Pen()
    pen.origin = (MARGIN, MARGIN + TITLE)
    for (kind, _), route in zip(links, arranged.routes, strict=True):
        _draw_link(pen, kind, route)
    for name, shape in shapes.items():
        x, y = arranged.places[name]
        pen.origin = (MARGIN + x, MARGIN + TITLE + y)
        shape.draw(pen)
    return pen.picture(diagram.name, arranged.width, arranged.height + MARGIN + TITLE)


def _links(diagram: ClassDiagram, shapes: dict[str, _Shape]) -> list[tuple[str, Link]]:
    """Return the links with their kinds."""
    links: list[tuple[str, Link]] = []
    for shown in diagram.classes:
        own = shapes[shown.name]
        links += [
            ("inheritance", Link(parent, shown.name, shapes[parent].middle, own.middle, True))
            for parent in shown.parents
        ]
        for feature, port in zip(shown.features, own.ports, strict=True):
            if _is_drawn(feature, shown):
                kind = "containment" if feature.containment else "reference"
                ranking = feature.containment or not feature.reference
                links.append((kind, Link(shown.name, feature.type, port, shapes[feature.type].low, ranking)))
    return sorted(links, key=lambda placed: _KINDS.index(placed[0]))


def _is_drawn(feature: Feature, owner: Class) -> bool:
    return feature.own and feature.type != owner.name


def _row(feature: Feature, owner: Class) -> str:
    many = "" if feature.multiplicity == "1" else f" [{feature.multiplicity}]"
    mark = "" if not feature.reference or _is_drawn(feature, owner) else "◆ " if feature.containment else "→ "
    return f"{mark}{feature.name}: {feature.type}{many}"


def _draw_link(pen: Pen, kind: str, route: Route) -> None:
    """Draw a link with its tip: a triangle or a diamond at the start, or the arrowhead of a reference at the end."""
    (x, y), (end_x, end_y), way = route.points[0], route.points[-1], route.leaves
    start = x + way * (_TIP if kind == "inheritance" else _TIP - 1)
    points = route.points if kind == "reference" else [(start, y), *route.points[1:]]
    pen.line(f"{kind} open", points)
    match kind:
        case "inheritance":
            pen.tip(kind, [(x, y), (start, y - 6), (start, y + 6)])
        case "containment":
            middle = (x + start) / 2
            pen.tip(kind, [(x, y), (middle, y - 4.5), (start, y), (middle, y + 4.5)])
        case _:
            back = end_x - route.arrives * 8
            pen.tip(kind, [(back, end_y - 4.5), (end_x, end_y), (back, end_y + 4.5)], closed=False)
