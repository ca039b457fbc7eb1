"""The static variable order: things that occur together stand close together.

From the given order and from one by breadth (Cuthill, McKee: Reducing the bandwidth of sparse symmetric matrices, ACM
1969), FORCE (Aloul, Markov, Sakallah: FORCE, a fast and easy-to-implement variable-ordering heuristic, GLSVLSI 2003),
then a sliding window that tries all permutations of a few neighbours, as CIF does (Lousberg, Thuijsman, Reniers:
DSM-based variable ordering heuristic for reduced computational effort of symbolic supervisor synthesis, WODES 2020).
"""

from __future__ import annotations

from collections import Counter
from itertools import permutations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    _Order = tuple[tuple[int, ...], list[int], list[int]]

_WINDOW = 4
#: How many times as long the total span of the order by breadth may be.
_LONGER = 1.25


def total_span(order: Sequence[int], edges: Sequence[Sequence[int]]) -> int:
    """The sum over all edges of the distance between their first and their last vertex in the order."""
    place = _places(order)
    return sum(last - first for first, last in (_ends(edge, place) for edge in edges))


def variable_order(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """An order of the vertices 0 … size-1 of a hypergraph with a small total span; the same for the same input.

    What begins with the order by breadth is taken where it is not much longer: it costs least in practice. Of equally
    long ones, the one whose edges lie farther up.
    """
    edges = [edge for edge in edges if len(edge) > 1]
    given, broad = _improved(list(range(size)), edges), _improved(_by_breadth(size, edges), edges)
    span, other = total_span(given, edges), total_span(broad, edges)
    if other > _LONGER * span:
        return given
    return given if other == span and _weighted_span(broad, edges) >= _weighted_span(given, edges) else broad


def _improved(start: list[int], edges: Sequence[Sequence[int]]) -> list[int]:
    """The best that comes of an order."""
    return _slide(min(start, _force(start, edges), key=lambda order: total_span(order, edges)), edges)


def _weighted_span(order: Sequence[int], edges: Sequence[Sequence[int]]) -> int:
    """The same sum as the total span, each distance times how far down its edge ends."""
    place = _places(order)
    return sum((last - first + 1) * (last + 1) for first, last in (_ends(edge, place) for edge in edges))


def _places(order: Sequence[int]) -> list[int]:
    place = [0] * len(order)
    for index, vertex in enumerate(order):
        place[vertex] = index
    return place


def _ends(edge: Sequence[int], place: Sequence[int]) -> tuple[int, int]:
    """The first and the last place of an edge."""
    places = [place[vertex] for vertex in edge]
    return min(places), max(places)


def _incidence(size: int, edges: Sequence[Sequence[int]]) -> list[list[int]]:
    edges_of: list[list[int]] = [[] for _ in range(size)]
    for index, edge in enumerate(edges):
        for vertex in edge:
            edges_of[vertex].append(index)
    return edges_of


def _by_breadth(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """Layer by layer from one end of each connected part to the other."""
    edges_of = _incidence(size, edges)
    degree = [sum(len(edges[edge]) for edge in incident) for incident in edges_of]
    order: list[int] = []
    placed = [False] * size
    for vertex in sorted(range(size), key=degree.__getitem__):
        if not placed[vertex]:
            far_end = _layers(vertex, edges, edges_of, degree)[-1]
            part = _layers(far_end, edges, edges_of, degree)
            order += part
            for member in part:
                placed[member] = True
    return order


def _layers(
    start: int, edges: Sequence[Sequence[int]], edges_of: Sequence[Sequence[int]], degree: Sequence[int]
) -> list[int]:
    """All vertices connected with one, the near ones first, of equally near ones those with few neighbours."""
    order, seen_edges = [start], set[int]()
    seen = {start}
    for vertex in order:
        fresh = [edge for edge in edges_of[vertex] if edge not in seen_edges]
        seen_edges.update(fresh)
        neighbours = dict.fromkeys(neighbour for edge in fresh for neighbour in edges[edge] if neighbour not in seen)
        seen.update(neighbours)
        order += sorted(neighbours, key=degree.__getitem__)
    return order


def _force(order: list[int], edges: Sequence[Sequence[int]]) -> list[int]:
    """Moves every vertex to the mean of the centres of its edges until that no longer helps."""
    edges_of = _incidence(len(order), edges)
    best, least = order, total_span(order, edges)
    for _ in range(10 * max(1, len(order).bit_length())):
        place = _places(order)
        centre = [sum(place[vertex] for vertex in edge) / len(edge) for edge in edges]
        pull = [
            sum(centre[edge] for edge in edges_of[vertex]) / len(edges_of[vertex])
            if edges_of[vertex]
            else float(place[vertex])
            for vertex in range(len(order))
        ]
        moved = sorted(order, key=lambda vertex: (pull[vertex], place[vertex]))
        span = total_span(moved, edges)
        if span < least:
            best, least = moved, span
        if moved == order:
            break
        order = moved
    return best


def _permutations(size: int) -> list[_Order]:
    """Each order of so many neighbours, with the first and the last place of each set of them, given by its bits."""
    found = []
    for order in permutations(range(size)):
        places = [
            [place for place, vertex in enumerate(order) if members >> vertex & 1] for members in range(1, 1 << size)
        ]
        found.append((order, [0, *map(min, places)], [0, *map(max, places)]))
    return found


def _shortest(orders: Iterable[_Order], edges: Mapping[tuple[int, bool, bool], int]) -> tuple[int, ...]:
    """The first of the orders of a window in which the edges, so many of each kind, have the least total span."""
    kinds = [(*kind, number) for kind, number in edges.items()]
    best: tuple[int, ...] = ()
    least = None
    for candidate, first, last in orders:
        span = 0
        for inside, above, below, number in kinds:
            span += number * ((0 if below else last[inside]) - (0 if above else first[inside]))
        if least is None or span < least:
            best, least = candidate, span
    return best


def _slide(order: list[int], edges: Sequence[Sequence[int]]) -> list[int]:
    """Puts the vertices of each window in their best order, window by window, until none changes."""
    order = list(order)
    edges_of = _incidence(len(order), edges)
    place = _places(order)
    ends = [_ends(edge, place) for edge in edges]
    orders = {size: _permutations(size) for size in range(2, _WINDOW + 1)}
    changed = True
    while changed:
        changed = False
        for start in range(len(order) - 1):
            window = order[start : start + _WINDOW]
            members: dict[int, int] = {}
            for index, vertex in enumerate(window):
                for edge in edges_of[vertex]:
                    members[edge] = members.get(edge, 0) | 1 << index
            # What matters of an edge: its members in the window, and whether it goes on above and below.
            alike = Counter(
                (inside, ends[edge][0] < start, ends[edge][1] >= start + len(window))
                for edge, inside in members.items()
            )
            moved = [window[index] for index in _shortest(orders[len(window)], alike)]
            if moved != window:
                order[start : start + _WINDOW] = moved
                for index, vertex in enumerate(moved, start):
                    place[vertex] = index
                for edge in members:
                    ends[edge] = _ends(edges[edge], place)
                changed = True
    return order
