"""Static variable order that keeps related variables close together.

The search starts from the given order and from an order by breadth (Cuthill, McKee: Reducing the bandwidth of sparse
symmetric matrices, ACM 1969). It improves each with FORCE (Aloul, Markov, Sakallah: FORCE, a fast and easy-to-implement
variable-ordering heuristic, GLSVLSI 2003), and then with a sliding window that tries all permutations of a few
neighbors, as CIF does (Lousberg, Thuijsman, Reniers: DSM-based variable ordering heuristic for reduced computational
effort of symbolic supervisor synthesis, WODES 2020).

A hub is a vertex of almost every edge, such as an observer or a logger. It would pull all other vertices to itself, and
apart from their neighbors. The search therefore leaves hubs out and puts them last.
"""

from __future__ import annotations

from collections import Counter
from functools import cache, reduce
from itertools import permutations
from operator import add, itemgetter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    #: Members of an edge in a window, and whether it continues above and below.
    _Kind = tuple[int, bool, bool]
    _Places = Callable[[Sequence[int]], Sequence[int]]

_WINDOW = 4
#: Maximum total span of the order by breadth, relative to that of the given order.
_LONGER = 1.25
#: Minimum share of the edges that a hub belongs to, and maximum share of hubs among the vertices.
_HUB = 3 / 4
_HUBS = 1 / 3


def variable_order(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """Order the vertices 0 … size-1 of a hypergraph with a small total span; deterministic.

    The result of the order by breadth is preferred if it is not much longer: in practice it costs least. If two orders
    have equal spans, the one whose edges lie farther up wins. Hubs come last.
    """
    last = hubs(size, edges)
    if last:
        others = [[vertex for vertex in edge if vertex not in last] for edge in edges]
        return [vertex for vertex in _connected_order(size, others) if vertex not in last] + last
    return _connected_order(size, edges)


def hubs(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """Return the vertices that belong to almost every edge of at least two vertices, ascending.

    Returns no vertices if many belong to almost every edge: no order can then keep the edges short.
    """
    joining = [edge for edge in edges if len(edge) > 1]
    degree = Counter(vertex for edge in joining for vertex in edge)
    central = [vertex for vertex in range(size) if degree[vertex] > _HUB * len(joining)]
    return central if len(central) <= _HUBS * size else []


def _connected_order(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """Return the order of `variable_order` for a hypergraph without hubs."""
    graph = _Hypergraph(size, edges)
    by_index, broad = _improved(list(range(size)), graph), _improved(_by_breadth(graph), graph)
    span, other = graph.span(_places(by_index)), graph.span(_places(broad))
    if other > _LONGER * span:
        return by_index
    return by_index if other == span and _weighted_span(broad, graph) >= _weighted_span(by_index, graph) else broad


class _Hypergraph:
    """Edges that join at least two vertices. Equal edges are stored once with their number as weight."""

    def __init__(self, size: int, edges: Iterable[Sequence[int]]) -> None:
        """Count the edges; `edges_of` holds the indices of the edges of each vertex."""
        multiplicities = Counter(tuple(edge) for edge in edges if len(edge) > 1)
        self.edges, self.weights = list(multiplicities), list(multiplicities.values())
        self.edges_of: list[list[int]] = [[] for _ in range(size)]
        for index, edge in enumerate(self.edges):
            for vertex in edge:
                self.edges_of[vertex].append(index)
        self.places_of: list[_Places] = [itemgetter(*edge) for edge in self.edges]

    def span(self, place: Sequence[int]) -> int:
        """Return the total span."""
        ends = (own(place) for own in self.places_of)
        return sum(weight * (max(places) - min(places)) for weight, places in zip(self.weights, ends, strict=True))

    def ends(self, edge: int, place: Sequence[int]) -> tuple[int, int]:
        """Return the first and the last place of an edge."""
        places = self.places_of[edge](place)
        return min(places), max(places)


def _improved(start: list[int], graph: _Hypergraph) -> list[int]:
    """Return the best order that the search reaches from `start`."""
    return _slide(min(start, _force(start, graph), key=lambda order: graph.span(_places(order))), graph)


def _weighted_span(order: Sequence[int], graph: _Hypergraph) -> int:
    """Return the total span with each distance weighted by how far down its edge ends."""
    place = _places(order)
    ends = (graph.ends(edge, place) for edge in range(len(graph.edges)))
    return sum(
        weight * (last - first + 1) * (last + 1) for weight, (first, last) in zip(graph.weights, ends, strict=True)
    )


def _places(order: Sequence[int]) -> list[int]:
    place = [0] * len(order)
    for index, vertex in enumerate(order):
        place[vertex] = index
    return place


def _by_breadth(graph: _Hypergraph) -> list[int]:
    """Order each connected part layer by layer from one end to the other."""
    degree = [sum(graph.weights[edge] * len(graph.edges[edge]) for edge in incident) for incident in graph.edges_of]
    order: list[int] = []
    placed = [False] * len(degree)
    for vertex in sorted(range(len(degree)), key=degree.__getitem__):
        if not placed[vertex]:
            far_end = _layers(vertex, graph, degree)[-1]
            part = _layers(far_end, graph, degree)
            order += part
            for member in part:
                placed[member] = True
    return order


def _layers(start: int, graph: _Hypergraph, degree: Sequence[int]) -> list[int]:
    """Return all vertices connected with `start`, the near ones first; at equal distance by ascending degree."""
    order, seen_edges = [start], set[int]()
    seen = {start}
    for vertex in order:
        fresh = [edge for edge in graph.edges_of[vertex] if edge not in seen_edges]
        seen_edges.update(fresh)
        neighbours = dict.fromkeys(
            neighbour for edge in fresh for neighbour in graph.edges[edge] if neighbour not in seen
        )
        seen.update(neighbours)
        order += sorted(neighbours, key=degree.__getitem__)
    return order


def _force(order: list[int], graph: _Hypergraph) -> list[int]:
    """Move every vertex to the mean of the centers of its edges, repeatedly, until an order recurs."""
    # An edge pulls once for each of its copies.
    pulling = [[edge for edge in own for _ in range(graph.weights[edge])] for own in graph.edges_of]
    place = _places(order)
    best, least = order, graph.span(place)
    seen = {tuple(order)}
    for _ in range(10 * max(1, len(order).bit_length())):
        centre = [sum(places) / len(places) for places in (own(place) for own in graph.places_of)]
        # Not `sum`: it rounds differently from Python 3.12 on, and the order must be the same in all versions.
        pull = [
            reduce(add, map(centre.__getitem__, own)) / len(own) if own else float(place[vertex])
            for vertex, own in enumerate(pulling)
        ]
        # The sort is stable: vertices with equal pull keep their order.
        order = sorted(order, key=pull.__getitem__)
        place = _places(order)
        span = graph.span(place)
        if span < least:
            best, least = order, span
        # This order occurred before, so the sequence repeats from here.
        if tuple(order) in seen:
            break
        seen.add(tuple(order))
    return best


@cache
def _permutations(size: int) -> tuple[list[tuple[int, ...]], Mapping[_Kind, list[int]]]:
    """Return all orders of `size` neighbors, and the span of each kind of edge in each of these orders.

    The members of an edge are a bit set. An edge that continues above and below has the same span in each order and is
    left out.
    """
    orders = list(permutations(range(size)))
    spans: dict[_Kind, list[int]] = {}
    for members in range(1, 1 << size):
        places = [[place for place, vertex in enumerate(order) if members >> vertex & 1] for order in orders]
        first, last = [min(occupied) for occupied in places], [max(occupied) for occupied in places]
        spans[members, False, False] = [end - start for start, end in zip(first, last, strict=True)]
        spans[members, True, False] = last
        spans[members, False, True] = [-start for start in first]
    return orders, spans


def _shortest(size: int, edges: Iterable[tuple[_Kind, int]]) -> tuple[int, ...]:
    """Return the first order of a window with the least total span of the edges, given with their numbers."""
    orders, spans = _permutations(size)
    rows = [
        spans[kind] if number == 1 else [number * span for span in spans[kind]]
        for kind, number in edges
        if kind in spans
    ]
    if not rows:
        return orders[0]
    total = list(map(sum, zip(*rows, strict=True)))
    return orders[total.index(min(total))]


def _slide(order: list[int], graph: _Hypergraph) -> list[int]:
    """Put the vertices of each window in their best order, window by window, until none changes.

    A window is skipped until a window that overlaps with it changes.
    """
    order = list(order)
    place = _places(order)
    ends = [graph.ends(edge, place) for edge in range(len(graph.edges))]
    known: dict[tuple[int, frozenset[tuple[_Kind, int]]], tuple[int, ...]] = {}
    pending = [True] * (len(order) - 1)
    while True in pending:
        for start in range(len(pending)):
            if not pending[start]:
                continue
            pending[start] = False
            window = order[start : start + _WINDOW]
            members = _members(window, graph.edges_of)
            # The kind of an edge: its members in the window, and whether it continues above and below.
            end = start + len(window)
            alike: dict[_Kind, int] = {}
            for edge, inside in members.items():
                first, last = ends[edge]
                kind = inside, first < start, last >= end
                alike[kind] = alike.get(kind, 0) + graph.weights[edge]
            key = len(window), frozenset(alike.items())
            if key not in known:
                known[key] = _shortest(*key)
            moved = [window[index] for index in known[key]]
            if moved != window:
                order[start:end] = moved
                for index, vertex in enumerate(moved, start):
                    place[vertex] = index
                for edge in members:
                    ends[edge] = graph.ends(edge, place)
                first, last = max(0, start + 1 - _WINDOW), min(len(pending), end)
                pending[first:last] = [other != start for other in range(first, last)]
    return order


def _members(window: Sequence[int], edges_of: Sequence[Sequence[int]]) -> dict[int, int]:
    """Return the edges of the vertices in a window, each with its members as a bit set."""
    members: dict[int, int] = {}
    for index, vertex in enumerate(window):
        for edge in edges_of[vertex]:
            members[edge] = members.get(edge, 0) | 1 << index
    return members
