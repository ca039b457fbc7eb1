"""The static variable order: things that occur together stand close together.

From the given order and from one by breadth (Cuthill, McKee: Reducing the bandwidth of sparse symmetric matrices, ACM
1969), FORCE (Aloul, Markov, Sakallah: FORCE, a fast and easy-to-implement variable-ordering heuristic, GLSVLSI 2003),
then a sliding window that tries all permutations of a few neighbours, as CIF does (Lousberg, Thuijsman, Reniers:
DSM-based variable ordering heuristic for reduced computational effort of symbolic supervisor synthesis, WODES 2020).
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_WINDOW = 4


def total_span(order: Sequence[int], edges: Sequence[Sequence[int]]) -> int:
    """The sum over all edges of the distance between their first and their last vertex in the order."""
    place = _places(order)
    return sum(_span(edge, place) for edge in edges)


def variable_order(size: int, edges: Sequence[Sequence[int]]) -> list[int]:
    """An order of the vertices 0 … size-1 of a hypergraph with a small total span; the same for the same input."""
    edges = [edge for edge in edges if len(edge) > 1]
    starts = list(range(size)), _by_breadth(size, edges)
    candidates = [candidate for start in starts for candidate in (start, _force(start, edges))]
    return _slide(min(candidates, key=lambda order: total_span(order, edges)), edges)


def _places(order: Sequence[int]) -> list[int]:
    place = [0] * len(order)
    for index, vertex in enumerate(order):
        place[vertex] = index
    return place


def _span(edge: Sequence[int], place: Sequence[int]) -> int:
    places = [place[vertex] for vertex in edge]
    return max(places) - min(places)


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


def _slide(order: list[int], edges: Sequence[Sequence[int]]) -> list[int]:
    """Puts the vertices of each window in their best order, window by window, until none changes."""
    order = list(order)
    edges_of = _incidence(len(order), edges)
    place = _places(order)
    changed = True
    while changed:
        changed = False
        for start in range(len(order) - 1):
            window = order[start : start + _WINDOW]
            touched = sorted({edge for vertex in window for edge in edges_of[vertex]})
            best, least = window, None
            for candidate in permutations(window):
                for index, vertex in enumerate(candidate, start):
                    place[vertex] = index
                span = sum(_span(edges[edge], place) for edge in touched)
                if least is None or span < least:
                    best, least = list(candidate), span
            for index, vertex in enumerate(best, start):
                place[vertex] = index
            if best != window:
                order[start : start + _WINDOW] = best
                changed = True
    return order
