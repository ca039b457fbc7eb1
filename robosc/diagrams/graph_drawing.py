"""A diagram of a robot as rectangles, paths and texts with coordinates, for the template of SVG to print."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.diagrams.graph_layout import HEAD, INDENT, LINE, MARK, PADDING, ROW_SIZE, lay_out, lines
from robosc.diagrams.shapes import coordinate as _at
from robosc.diagrams.shapes import path, text_width

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.diagrams.graph import Arrow, Graph, Group, Node
    from robosc.diagrams.graph_layout import Layout, Rectangle
    from robosc.diagrams.shapes import Point

_MARGIN, _TITLE, _GAP, _FRAME = 20.0, 34.0, 16.0, 14.0
#: Frames stand side by side up to this width.
_WIDTH = 1100.0
_HEAD_LENGTH, _HEAD_WIDTH = 9.0, 4.0


@dataclass(frozen=True)
class Text:
    """A line of text: where its baseline starts, or its middle for a `title`."""

    style: str
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Box:
    """A rectangle: a `frame`, a node by its kind, the `mark` of an initial state, a line `inside` a marked one."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    radius: float


@dataclass(frozen=True)
class Line:
    """A path of a kind: `arrow`, `head`, `rule`."""

    kind: str
    path: str


@dataclass(frozen=True)
class Picture:
    """All there is to draw, in this order."""

    title: str
    width: float
    height: float
    boxes: Sequence[Box]
    lines: Sequence[Line]
    texts: Sequence[Text]


def draw(graph: Graph) -> Picture:
    """Lays the diagram out: groups with titles as frames in rows, their arrows downwards; others to the right."""
    pen = _Pen()
    x, y, row, width = _MARGIN, _MARGIN + _TITLE, 0.0, 1.1 * text_width(graph.title, 18)
    for group in graph.groups:
        panel = _Panel(group)
        if x > _MARGIN and x + panel.width > _WIDTH:
            x, y, row = _MARGIN, y + row + _GAP, 0.0
        panel.draw(pen, x, y)
        x += panel.width + _GAP
        row = max(row, panel.height)
        width = max(width, x - _GAP - _MARGIN)
    return Picture(graph.title, round(width + 2 * _MARGIN), round(y + row + _MARGIN), pen.boxes, pen.lines, pen.texts)


class _Pen:
    """Collects what is drawn, moved to where the current group is."""

    def __init__(self) -> None:
        self.boxes: list[Box] = []
        self.lines: list[Line] = []
        self.texts: list[Text] = []
        self.origin: Point = (0.0, 0.0)

    def text(self, style: str, x: float, y: float, text: str) -> None:
        self.texts.append(Text(style, _at(self.origin[0] + x), _at(self.origin[1] + y), text))

    def box(self, kind: str, place: Rectangle | tuple[float, float, float, float], radius: float) -> None:
        x, y, width, height = place if isinstance(place, tuple) else (place.x, place.y, place.width, place.height)
        corner = (_at(self.origin[0] + x), _at(self.origin[1] + y))
        self.boxes.append(Box(kind, *corner, _at(width), _at(height), radius))

    def line(self, kind: str, points: Sequence[Point], *, downwards: bool = False) -> None:
        moved = [(self.origin[0] + x, self.origin[1] + y) for x, y in points]
        self.lines.append(Line(kind, path(moved, downwards=downwards)))

    def head(self, tip: Point, way: Point) -> None:
        """An arrowhead that points one way."""
        x, y = self.origin[0] + tip[0], self.origin[1] + tip[1]
        back = (x - way[0] * _HEAD_LENGTH, y - way[1] * _HEAD_LENGTH)
        side = (way[1] * _HEAD_WIDTH, way[0] * _HEAD_WIDTH)
        corners = [(back[0] + side[0], back[1] + side[1]), (x, y), (back[0] - side[0], back[1] - side[1])]
        self.lines.append(
            Line("head", "M" + "L".join(f"{_at(corner)} {_at(other)}" for corner, other in corners) + "z")
        )


class _Panel:
    """A group with its frame."""

    def __init__(self, group: Group) -> None:
        self.group = group
        self.framed = bool(group.title)
        self.layout: Layout = lay_out(group, downwards=self.framed)
        above = HEAD + LINE * len(group.remarks) if self.framed else 0.0
        inset = _FRAME if self.framed else 0.0
        texts = [1.15 * text_width(group.title, 14), *(text_width(remark, ROW_SIZE) for remark in group.remarks)]
        self.start = (inset, above + inset)
        self.width = max(self.layout.width, *texts) + 2 * inset
        self.height = self.layout.height + above + 2 * inset

    def draw(self, pen: _Pen, x: float, y: float) -> None:
        if self.framed:
            pen.origin = (x, y)
            pen.box("frame", (0.0, 0.0, self.width, self.height), 6)
            pen.text("group", _FRAME, 22, self.group.title)
            for number, remark in enumerate(self.group.remarks):
                pen.text("remark", _FRAME, 22 + LINE * (number + 1), remark)
        pen.origin = (x + self.start[0], y + self.start[1])
        for node in self.group.nodes:
            self.node(pen, node, self.layout.nodes[node.key])
        for arrow, corner, points in zip(self.group.arrows, self.layout.labels, self.layout.routes, strict=True):
            self.arrow(pen, arrow, corner, points)

    def node(self, pen: _Pen, node: Node, place: Rectangle) -> None:
        radius = {"state": 9, "every": 9, "topic": 13}.get(node.kind, 3)
        pen.box(node.kind, place, radius)
        if node.marked:
            pen.box("inside", (place.x + 3, place.y + 3, place.width - 6, place.height - 6), radius - 3)
        if node.initial:
            start, end = (place.x - MARK + 5, place.y + HEAD / 2), (place.x, place.y + HEAD / 2)
            pen.box("mark", (start[0] - 4, start[1] - 4, 8, 8), 4)
            pen.line("arrow", [start, _short(end, (1, 0))])
            pen.head(end, (1, 0))
        rows = lines(node.rows)
        height = HEAD + (LINE * len(rows) + 8 if rows else 0.0)
        top = place.y + (place.height - height) / 2
        style = "title light" if node.kind == "controller" else "title"
        pen.text(style, place.x + place.width / 2, top + 18, node.title)
        if rows:
            pen.line("rule", [(place.x + 3, top + HEAD), (place.x + place.width - 3, top + HEAD)])
        for number, (indent, text) in enumerate(rows):
            pen.text("row", place.x + PADDING + indent, top + HEAD + LINE * (number + 1), text)

    def arrow(self, pen: _Pen, arrow: Arrow, corner: Point | None, points: Sequence[Point]) -> None:
        axis = int(self.framed)
        drawn = [*points[:-1], _short(points[-1], _way(points, axis))]
        pen.head(points[-1], _way(points, axis))
        if arrow.both:
            drawn[0] = _short(points[0], _way(points[::-1], axis))
            pen.head(points[0], _way(points[::-1], axis))
        pen.line("arrow", drawn, downwards=self.framed)
        if corner is not None:
            for number, (indent, text) in enumerate(lines(arrow.labels)):
                pen.text("label", corner[0] + INDENT / 2 + indent, corner[1] + LINE * (number + 1) - 3, text)


def _way(points: Sequence[Point], axis: int) -> Point:
    """One step in the direction in which a path arrives at its last point, along an axis (0: across, 1: down)."""
    end = points[-1][axis]
    before = next((point[axis] for point in reversed(points) if point[axis] != end), end - 1)
    step = 1.0 if end > before else -1.0
    return (step, 0.0) if axis == 0 else (0.0, step)


def _short(point: Point, way: Point) -> Point:
    """Where a line ends, so that it does not show beside the tip of its head."""
    return point[0] - way[0] * (_HEAD_LENGTH - 1), point[1] - way[1] * (_HEAD_LENGTH - 1)
