"""Positions of the nodes, labels and arrows of a group."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, pairwise
from typing import TYPE_CHECKING

import networkx as nx

from robosc.tools.diagrams.layers import Link, arrange
from robosc.tools.diagrams.picture import text_width

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.tools.diagrams.graph import Arrow, DiagramNode, Group, Label
    from robosc.tools.diagrams.layers import Arrangement
    from robosc.tools.diagrams.picture import Point

TITLE_SIZE, ROW_SIZE = 13, 11
#: Height of the title part of a node, and of each line below it.
HEAD, LINE = 26.0, 15.0
PADDING, INDENT = 10.0, 10.0
#: Room for the mark before an initial state.
MARK = 22.0
#: Minimum distance between two arrows on one side of a node.
_PORT = 16.0
#: Gap between ranks, for downward and for rightward arrows.
_GAPS = (30.0, 64.0)
#: Number of ranks after which a layout is folded; pages may be long.
_MOST_RANKS = 60


@dataclass(frozen=True)
class Rectangle:
    """A rectangle by its upper left corner and its size."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class GraphLayout:
    """Rectangles of nodes, corners of the labels of arrows (None without labels), points of arrows, and the size."""

    nodes: Mapping[str, Rectangle]
    labels: Sequence[Point | None]
    routes: Sequence[Sequence[Point]]
    width: float
    height: float


def lines(labels: Iterable[Label]) -> list[tuple[float, str]]:
    """Return the lines of labels in order with their indent; continuation lines are indented."""
    return [(0.0 if number == 0 else INDENT, text) for label in labels for number, text in enumerate(label)]


def lay_out(group: Group, *, downwards: bool) -> GraphLayout:
    """Arrange a group: arrows run downwards, or else to the right, except in cycles."""
    return _Layouter(group, downwards).layout()


class _Layouter:
    """Works in two directions, along the ranks and across them.

    Labels are boxes on the way of their arrows.
    """

    def __init__(self, group: Group, downwards: bool) -> None:
        self.group = group
        self.downwards = downwards
        self.forward = _forward(group)
        #: Arrows at each side of each node, by number; side 0 is before the node, side 1 behind it.
        self.sides: dict[tuple[str, int], list[int]] = {}
        for number, arrow in enumerate(group.arrows):
            self.sides.setdefault((arrow.source, int(self.forward[number])), []).append(number)
            self.sides.setdefault((arrow.target, int(not self.forward[number])), []).append(number)

    def layout(self) -> GraphLayout:
        sizes = {node.key: self.size(node) for node in self.group.nodes}
        sizes |= {_label(number): _label_size(arrow) for number, arrow in enumerate(self.group.arrows) if arrow.labels}
        first = self.arranged(sizes)
        # Second pass: sorts the arrows at each side of a node by the positions of their labels.
        for (key, _), numbers in self.sides.items():
            numbers.sort(key={number: self.neighbour(first, sizes, key, number) for number in numbers}.__getitem__)
        arranged = self.arranged(sizes)
        swapped = {key: self.swap(place) for key, place in arranged.places.items()}
        marks = {node.key: MARK if node.initial else 0.0 for node in self.group.nodes}
        width, height = self.swap((arranged.width, arranged.height))
        return GraphLayout(
            {
                key: Rectangle(swapped[key][0] + mark, swapped[key][1], sizes[key][0] - mark, sizes[key][1])
                for key, mark in marks.items()
            },
            [swapped.get(_label(number)) for number in range(len(self.group.arrows))],
            self.routes(arranged),
            width,
            height,
        )

    def arranged(self, sizes: Mapping[str, Point]) -> Arrangement:
        boxes = {key: self.swap(size) for key, size in sizes.items()}
        return arrange(boxes, list(chain.from_iterable(self.links(sizes))), _GAPS[not self.downwards], _MOST_RANKS)

    def links(self, sizes: Mapping[str, Point]) -> list[list[Link]]:
        """Return, for each arrow, its links from its earlier node to its later one."""
        links = []
        for number, arrow in enumerate(self.group.arrows):
            ends = (arrow.source, arrow.target) if self.forward[number] else (arrow.target, arrow.source)
            ports = [self.port(sizes, end, side, number) for end, side in zip(ends, (1, 0), strict=True)]
            if arrow.labels:
                middle = 0.0 if self.downwards else sizes[_label(number)][1]
                stops = [(ends[0], ports[0]), (_label(number), middle), (ends[1], ports[1])]
            else:
                stops = list(zip(ends, ports, strict=True))
            links.append(
                [
                    Link(source, target, source_port, target_port, True)
                    for (source, source_port), (target, target_port) in pairwise(stops)
                ]
            )
        return links

    def port(self, sizes: Mapping[str, Point], key: str, side: int, number: int) -> float:
        numbers = self.sides[key, side]
        start = MARK if self.downwards and any(node.key == key and node.initial for node in self.group.nodes) else 0.0
        across = sizes[key][0 if self.downwards else 1] - start
        return start + across * (numbers.index(number) + 1) / (len(numbers) + 1)

    def neighbour(self, arranged: Arrangement, sizes: Mapping[str, Point], key: str, number: int) -> float:
        """Return the position across the ranks of the other end of an arrow's first link."""
        arrow = self.group.arrows[number]
        if arrow.labels:
            return arranged.places[_label(number)][1]
        other = arrow.target if key == arrow.source else arrow.source
        return arranged.places[other][1] + self.swap(sizes[other])[1] / 2

    def routes(self, arranged: Arrangement) -> list[list[Point]]:
        routes, rest = [], iter(arranged.routes)
        for number, arrow in enumerate(self.group.arrows):
            pieces = [next(rest) for _ in range(2 if arrow.labels else 1)]
            points = [self.swap(point) for piece in pieces for point in piece.points]
            routes.append(points if self.forward[number] else points[::-1])
        return routes

    def size(self, node: DiagramNode) -> Point:
        """Return width and height of a node, with room for all its arrows and its mark."""
        rows = lines(node.rows)
        texts = [1.1 * text_width(node.title, TITLE_SIZE), *(x + text_width(text, ROW_SIZE) for x, text in rows)]
        most = max(len(self.sides.get((node.key, side), ())) for side in (0, 1))
        width = max(*texts, 44.0) + 2 * PADDING
        height = HEAD + (LINE * len(rows) + 8 if rows else 0.0)
        room = _PORT * (most + 1)
        width, height = (max(width, room), height) if self.downwards else (width, max(height, room))
        return width + (MARK if node.initial else 0.0), height

    def swap(self, point: Point) -> Point:
        return point[::-1] if self.downwards else point


def _label_size(arrow: Arrow) -> Point:
    texts = lines(arrow.labels)
    return max(x + text_width(text, ROW_SIZE) for x, text in texts) + 2 * PADDING, LINE * len(texts) + 2


def _label(number: int) -> str:
    return f"label {number}"


def _forward(group: Group) -> list[bool]:
    """Return which arrows lead forward; the others close a cycle, seen from the initial states."""
    reached = nx.DiGraph()
    reached.add_nodes_from(node.key for node in group.nodes)
    reached.add_edges_from((arrow.source, arrow.target) for arrow in group.arrows)
    starts = [node.key for node in group.nodes if node.initial]
    depths = nx.multi_source_dijkstra_path_length(reached, starts, weight=None) if starts else {}
    order = sorted(range(len(group.arrows)), key=lambda number: depths.get(group.arrows[number].source, 0))
    onwards = nx.DiGraph()
    onwards.add_nodes_from(reached)
    forward = [False] * len(group.arrows)
    for number in order:
        arrow = group.arrows[number]
        forward[number] = not nx.has_path(onwards, arrow.target, arrow.source)
        if forward[number]:
            onwards.add_edge(arrow.source, arrow.target)
    return forward
