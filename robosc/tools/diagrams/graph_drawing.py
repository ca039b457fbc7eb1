"""Drawing of a diagram of a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.diagrams.graph_layout import HEAD, INDENT, LINE, MARK, PADDING, ROW_SIZE, lay_out, lines
from robosc.tools.diagrams.picture import MARGIN, TITLE, Pen, text_width

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.tools.diagrams.graph import Arrow, DiagramNode, Graph, Group
    from robosc.tools.diagrams.graph_layout import GraphLayout, Rectangle
    from robosc.tools.diagrams.picture import Picture, Point

_GAP, _FRAME = 16.0, 14.0
#: Frames are placed side by side up to this width.
_WIDTH = 1100.0
_HEAD_LENGTH, _HEAD_WIDTH = 9.0, 4.0


def draw(graph: Graph) -> Picture:
    """Lay out and draw a diagram: groups with titles as frames in rows with downward arrows, others rightwards."""
    pen = Pen()
    x, y, row, width = MARGIN, MARGIN + TITLE, 0.0, 1.1 * text_width(graph.title, 18)
    for group in graph.groups:
        panel = _Panel(group)
        if x > MARGIN and x + panel.width > _WIDTH:
            x, y, row = MARGIN, y + row + _GAP, 0.0
        panel.draw(pen, x, y)
        x += panel.width + _GAP
        row = max(row, panel.height)
        width = max(width, x - _GAP - MARGIN)
    return pen.picture(graph.title, width, y + row)


def _draw_head(pen: Pen, tip: Point, way: Point) -> None:
    """Draw an arrowhead in a direction."""
    back = (tip[0] - way[0] * _HEAD_LENGTH, tip[1] - way[1] * _HEAD_LENGTH)
    side = (way[1] * _HEAD_WIDTH, way[0] * _HEAD_WIDTH)
    pen.tip("head", [(back[0] + side[0], back[1] + side[1]), tip, (back[0] - side[0], back[1] - side[1])])


class _Panel:
    """A group with its frame."""

    def __init__(self, group: Group) -> None:
        self.group = group
        self.framed = bool(group.title)
        self.layout: GraphLayout = lay_out(group, downwards=self.framed)
        above = HEAD + LINE * len(group.remarks) if self.framed else 0.0
        inset = _FRAME if self.framed else 0.0
        texts = [1.15 * text_width(group.title, 14), *(text_width(remark, ROW_SIZE) for remark in group.remarks)]
        self.start = (inset, above + inset)
        self.width = max(self.layout.width, *texts) + 2 * inset
        self.height = self.layout.height + above + 2 * inset

    def draw(self, pen: Pen, x: float, y: float) -> None:
        if self.framed:
            pen.origin = (x, y)
            pen.box("frame", (0.0, 0.0), (self.width, self.height), 6)
            pen.text("group", _FRAME, 22, self.group.title)
            for number, remark in enumerate(self.group.remarks):
                pen.text("remark", _FRAME, 22 + LINE * (number + 1), remark)
        pen.origin = (x + self.start[0], y + self.start[1])
        for node in self.group.nodes:
            self.node(pen, node, self.layout.nodes[node.key])
        for arrow, corner, points in zip(self.group.arrows, self.layout.labels, self.layout.routes, strict=True):
            self.arrow(pen, arrow, corner, points)

    def node(self, pen: Pen, node: DiagramNode, place: Rectangle) -> None:
        radius = {"state": 9, "every": 9, "topic": 13}.get(node.kind, 3)
        pen.box(node.kind, (place.x, place.y), (place.width, place.height), radius)
        if node.marked:
            pen.box("inside", (place.x + 3, place.y + 3), (place.width - 6, place.height - 6), radius - 3)
        if node.initial:
            start, end = (place.x - MARK + 5, place.y + HEAD / 2), (place.x, place.y + HEAD / 2)
            pen.box("mark", (start[0] - 4, start[1] - 4), (8, 8), 4)
            pen.line("arrow", [start, _short(end, (1, 0))])
            _draw_head(pen, end, (1, 0))
        rows = lines(node.rows)
        height = HEAD + (LINE * len(rows) + 8 if rows else 0.0)
        top = place.y + (place.height - height) / 2
        style = "title light" if node.kind == "controller" else "title"
        pen.text(style, place.x + place.width / 2, top + 18, node.title)
        if rows:
            pen.line("rule", [(place.x + 3, top + HEAD), (place.x + place.width - 3, top + HEAD)])
        for number, (indent, text) in enumerate(rows):
            pen.text("row", place.x + PADDING + indent, top + HEAD + LINE * (number + 1), text)

    def arrow(self, pen: Pen, arrow: Arrow, corner: Point | None, points: Sequence[Point]) -> None:
        axis = int(self.framed)
        drawn = [*points[:-1], _short(points[-1], _way(points, axis))]
        _draw_head(pen, points[-1], _way(points, axis))
        if arrow.both:
            drawn[0] = _short(points[0], _way(points[::-1], axis))
            _draw_head(pen, points[0], _way(points[::-1], axis))
        pen.line("arrow", drawn, downwards=self.framed)
        if corner is not None:
            for number, (indent, text) in enumerate(lines(arrow.labels)):
                pen.text("label", corner[0] + INDENT / 2 + indent, corner[1] + LINE * (number + 1) - 3, text)


def _way(points: Sequence[Point], axis: int) -> Point:
    """Return the direction in which a path arrives at its last point, along an axis (0: across, 1: down)."""
    end = points[-1][axis]
    before = next((point[axis] for point in reversed(points) if point[axis] != end), end - 1)
    step = 1.0 if end > before else -1.0
    return (step, 0.0) if axis == 0 else (0.0, step)


def _short(point: Point, way: Point) -> Point:
    """Return the end of a line, shortened so that it does not show beside the tip of its head."""
    return point[0] - way[0] * (_HEAD_LENGTH - 1), point[1] - way[1] * (_HEAD_LENGTH - 1)
