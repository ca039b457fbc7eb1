"""The static variable order."""

import random
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.synthesis.order import hubs, variable_order


def total_span(order, edges):
    """The sum over all edges of the distance between their first and their last vertex in the order."""
    place = {vertex: position for position, vertex in enumerate(order)}
    positions = [[place[vertex] for vertex in edge] for edge in edges]
    return sum(max(edge) - min(edge) for edge in positions)


def hypergraphs():
    sizes = st.integers(1, 12)
    return sizes.flatmap(
        lambda size: st.tuples(
            st.just(size), st.lists(st.lists(st.integers(0, size - 1), min_size=1, unique=True), max_size=12)
        )
    )


@pytest.mark.slow
@given(hypergraphs())
def test_it_is_an_order_and_never_much_longer_than_the_given_one(hypergraph):
    size, edges = hypergraph
    order = variable_order(size, edges)
    assert sorted(order) == list(range(size))
    central = hubs(size, edges)
    others = [vertex for vertex in order if vertex not in central]
    assert order == others + central
    rest = [[others.index(vertex) for vertex in edge if vertex not in central] for edge in edges]
    rest = [edge for edge in rest if edge]
    given = sorted(range(len(others)), key=others.__getitem__)
    assert total_span(range(len(others)), rest) <= 1.25 * total_span(given, rest)


def test_a_scrambled_chain_is_put_straight():
    names = list(range(60))
    random.Random(1).shuffle(names)  # noqa: S311
    edges = [[a, b] for a, b in pairwise(names)]
    assert total_span(range(60), edges) > 1000
    assert total_span(variable_order(60, edges), edges) == 59


def test_cells_that_share_nothing_are_kept_together():
    edges = [[cell, cell + 30, cell + 60] for cell in range(30)]
    assert total_span(variable_order(90, edges), edges) == 60


def test_an_observer_of_a_ring_comes_last_and_leaves_the_order_of_the_ring():
    ring = [[place, (place + 1) % 20] for place in range(20)]
    observed = [[*edge, 20] for edge in ring]
    assert hubs(21, observed) == [20]
    assert variable_order(21, observed) == [*variable_order(20, ring), 20]


def test_a_vertex_of_three_quarters_of_the_edges_is_no_hub():
    assert hubs(4, [[0, 1], [0, 2], [0, 3], [2, 3]]) == []
    assert hubs(4, [[0, 1], [0, 2], [0, 3], [3], [2]]) == [0]


def test_vertices_are_no_hubs_if_most_of_them_belong_to_most_edges():
    assert hubs(3, [[0, 1, 2]] * 4) == []
