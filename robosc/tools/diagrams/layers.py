"""A layered layout: boxes in columns, and links between them that cross no box.

The method is that of Sugiyama, Tagawa and Toda, "Methods for Visual Understanding of Hierarchical System Structures"
(1981). Boxes get ranks along the links. Long links get a position in every column that they cross. Barycenters improve
the order in the columns. Isotonic regression computes the heights and keeps that order. If there are many ranks, the
columns turn back half way, so that the drawing does not become a ribbon.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import networkx as nx

from robosc.tools.diagrams.picture import total

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

_SWEEPS = 24
_COLUMN_GAP = 64.0
_ROW_GAP = 22.0
_LINK_GAP = 9.0
_BESIDE = 8.0
#: Number of ranks after which a layout is folded.
_MOST_COLUMNS = 9


@dataclass(frozen=True)
class Link:
    """A link between two boxes.

    Ports are measured from the upper edges of the boxes. Only `ranking` links determine ranks.
    """

    source: str
    target: str
    source_port: float
    target_port: float
    ranking: bool


@dataclass(frozen=True)
class Route:
    """The path of a link: points from its source to its target.

    `leaves` and `arrives` are the directions at the source and at the target: 1 to the right, -1 to the left.
    """

    points: Sequence[tuple[float, float]]
    leaves: int
    arrives: int


@dataclass(frozen=True)
class Arrangement:
    """The upper left corners of the boxes, the routes of the links, and the total size."""

    places: Mapping[str, tuple[float, float]]
    routes: Sequence[Route]
    width: float
    height: float


@dataclass(eq=False)
class _Item:
    """A box in its column, or (without a name) a position at which a link crosses the column."""

    name: str
    column: int
    height: float
    top: float = 0.0
    #: Neighbors in the next and in the previous column: the item there, its port, the own port.
    right: list[tuple[_Item, float, float]] = field(default_factory=list)
    left: list[tuple[_Item, float, float]] = field(default_factory=list)


def arrange(
    sizes: Mapping[str, tuple[float, float]],
    links: Sequence[Link],
    column_gap: float = _COLUMN_GAP,
    most_columns: int = _MOST_COLUMNS,
) -> Arrangement:
    """Arrange boxes by their widths and heights. Ranking links run from rank to rank, except in cycles.

    More ranks than `most_columns` are folded. A link from a box to itself is not allowed.
    """
    columns = _columns(sizes, links, most_columns)
    boxes = {name: _Item(name, columns[name], height) for name, (_, height) in sizes.items()}
    chains = [_chain(boxes, link) for link in links]
    layers: list[list[_Item]] = [[] for _ in range(max(columns.values(), default=-1) + 1)]
    for item in _ordered(boxes.values(), chains):
        layers[item.column].append(item)
    layers = _fewest_crossings(layers)
    _set_tops(layers)
    return _Geometry(sizes, layers, boxes, chains, column_gap).arrangement(links)


def _columns(names: Iterable[str], links: Sequence[Link], most: int) -> dict[str, int]:
    """Return the column of each box: its rank, or a column on the way back."""
    ranks = _ranks(names, links)
    last = max(ranks.values(), default=0)
    if last < most:
        return ranks
    middle = (last + 1) // 2
    return {name: rank if rank <= middle else 2 * middle - rank for name, rank in ranks.items()}


def _ranks(names: Iterable[str], links: Sequence[Link]) -> dict[str, int]:
    graph = nx.DiGraph()
    graph.add_nodes_from(names)
    for link in links:
        if link.ranking and not nx.has_path(graph, link.target, link.source):
            graph.add_edge(link.source, link.target)
    ranks: dict[str, int] = {}
    order = list(nx.lexicographical_topological_sort(graph, key=list(graph).index))
    for name in order:
        ranks[name] = max((ranks[predecessor] + 1 for predecessor in graph.predecessors(name)), default=0)
    for name in reversed(order):
        after = [ranks[successor] for successor in graph.successors(name)]
        if not graph.in_degree(name):
            # A box without a ranking predecessor is placed right before the boxes to which it links.
            after = after or [ranks[link.target] for link in links if link.source == name]
            ranks[name] = max(min(after, default=1) - 1, 0)
    return ranks


def _chain(boxes: Mapping[str, _Item], link: Link) -> list[_Item]:
    """Return the items of a link from its source to its target, and connect them if their columns differ."""
    first, last = boxes[link.source], boxes[link.target]
    way = 1 if first.column < last.column else -1
    between = [_Item("", column, 0.0) for column in range(first.column + way, last.column, way)]
    if first.column == last.column:
        return [first, last]
    chain = [first, *between, last]
    for item, following in pairwise(chain):
        item_port = link.source_port if item is first else 0.0
        following_port = link.target_port if following is last else 0.0
        (item.right if way > 0 else item.left).append((following, following_port, item_port))
        (following.left if way > 0 else following.right).append((item, item_port, following_port))
    return chain


def _ordered(boxes: Iterable[_Item], chains: Sequence[Sequence[_Item]]) -> list[_Item]:
    """Return all items, with linked items near each other."""
    ordered: dict[_Item, None] = {}
    pending = list(boxes)[::-1]
    while pending:
        item = pending.pop()
        if item not in ordered:
            ordered[item] = None
            pending += [neighbour for neighbour, _, _ in reversed(item.right)]
    return list(ordered | dict.fromkeys(neighbour for chain in chains for neighbour in chain))


def _fewest_crossings(layers: list[list[_Item]]) -> list[list[_Item]]:
    best, least = [list(layer) for layer in layers], _crossings(layers)
    for sweep in range(_SWEEPS):
        forward = sweep % 2 == 0
        for layer in layers if forward else reversed(layers):
            positions = {item: index for layer in layers for index, item in enumerate(layer)}
            layer.sort(key=lambda item: _barycenter(item, positions, forward=forward))
        crossings = _crossings(layers)
        if crossings < least:
            best, least = [list(layer) for layer in layers], crossings
    return best


def _barycenter(item: _Item, positions: Mapping[_Item, int], *, forward: bool) -> float:
    near = item.left if forward else item.right
    if not near:
        return positions[item]
    # The port decides between links of one box: a lower row belongs lower.
    return total(positions[neighbour] + port / (neighbour.height + 1) for neighbour, port, _ in near) / len(near)


def _crossings(layers: Sequence[Sequence[_Item]]) -> int:
    total = 0
    for layer, following in pairwise(layers):
        below = {item: index for index, item in enumerate(following)}
        ends = [
            (index + own / (item.height + 1), below[other] + port / (other.height + 1))
            for index, item in enumerate(layer)
            for other, port, own in item.right
        ]
        ends.sort()
        total += sum(end[1] > later[1] for number, end in enumerate(ends) for later in ends[number + 1 :])
    return total


def _set_tops(layers: Sequence[Sequence[_Item]]) -> None:
    for layer in layers:
        _place(layer, [0.0] * len(layer))
    for sweep in range(_SWEEPS):
        forward = sweep % 2 == 0
        for layer in layers if forward else layers[::-1]:
            ideals = []
            for item in layer:
                near = (item.left if forward else item.right) or item.left or item.right
                heights = [neighbour.top + port - own for neighbour, port, own in near]
                ideals.append(total(heights) / len(heights) if heights else item.top)
            _place(layer, ideals)
    highest = min((item.top for layer in layers for item in layer), default=0.0)
    for layer in layers:
        for item in layer:
            item.top -= highest


def _place(layer: Sequence[_Item], ideal: Sequence[float]) -> None:
    """Move items as close to the wanted heights as their order and gaps allow (least squares)."""
    offsets, offset = [], 0.0
    for item, following in zip(layer, [*layer[1:], None], strict=True):
        offsets.append(offset)
        if following is not None:
            gap = _ROW_GAP if item.name and following.name else _LINK_GAP
            offset += item.height + gap
    # Pools of adjacent items that touch each other: the mean of their wanted heights, and their number.
    pools: list[tuple[float, int]] = []
    for height, base in zip(ideal, offsets, strict=True):
        pools.append((height - base, 1))
        while len(pools) > 1 and pools[-2][0] >= pools[-1][0]:
            (upper, few), (lower, more) = pools[-2:]
            pools[-2:] = [((upper * few + lower * more) / (few + more), few + more)]
    tops = [mean for mean, count in pools for _ in range(count)]
    for item, top, base in zip(layer, tops, offsets, strict=True):
        item.top = top + base


class _Geometry:
    """Converts columns and heights to coordinates."""

    def __init__(
        self,
        sizes: Mapping[str, tuple[float, float]],
        layers: Sequence[Sequence[_Item]],
        boxes: Mapping[str, _Item],
        chains: Sequence[Sequence[_Item]],
        column_gap: float,
    ) -> None:
        self._sizes = sizes
        self._boxes = boxes
        self._chains = chains
        self._height = max((item.top + item.height for layer in layers for item in layer), default=0.0)
        #: Left and right edge of each column; links within a column widen the gap beside it.
        self._edges: list[tuple[float, float]] = []
        self._width = left = 0.0
        for column, layer in enumerate(layers):
            right = left + max((sizes[item.name][0] for item in layer if item.name), default=0.0)
            inside = sum(chain[0].column == chain[-1].column == column for chain in chains)
            self._edges.append((left, right))
            self._width = right + (_BESIDE * (inside + 2) if inside else 0.0)
            left = right + column_gap + _BESIDE * inside
        self._beside = [0] * len(layers)

    def arrangement(self, links: Sequence[Link]) -> Arrangement:
        """Return all coordinates."""
        places = {name: (self._edges[item.column][0], item.top) for name, item in self._boxes.items()}
        routes = [self._route(link, chain) for link, chain in zip(links, self._chains, strict=True)]
        return Arrangement(places, routes, self._width, self._height)

    def _route(self, link: Link, chain: Sequence[_Item]) -> Route:
        first, *between, last = chain
        start, end = first.top + link.source_port, last.top + link.target_port
        if first.column == last.column:
            return self._route_beside(first, last, start, end)
        way = 1 if first.column < last.column else -1
        points = self._leave(first, start, way)
        for item in between:
            left, right = self._edges[item.column]
            points += [(left, item.top), (right, item.top)][::way]
        return Route([*points, *self._leave(last, end, -way)[::-1]], way, way)

    def _route_beside(self, first: _Item, last: _Item, start: float, end: float) -> Route:
        """Return a route through the gap to the right of the column, where each link has its own line."""
        self._beside[first.column] += 1
        outside = self._edges[first.column][1] + _BESIDE * (self._beside[first.column] + 1)
        points = [self._leave(first, start, 1)[0], (outside, start), (outside, end), self._leave(last, end, 1)[0]]
        return Route(points, 1, -1)

    def _leave(self, item: _Item, height: float, way: int) -> list[tuple[float, float]]:
        """Return the points from a side of a box to the edge of its column."""
        left, right = self._edges[item.column]
        if way < 0:
            return [(left, height)]
        return [(left + self._sizes[item.name][0], height), (right, height)]
