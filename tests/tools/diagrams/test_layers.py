"""The layered layout: nothing overlaps, and no link runs through a box."""

from itertools import combinations, pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.tools.diagrams.layers import Link, arrange
from tests.searching import examples


@st.composite
def graphs(draw: st.DrawFn) -> tuple[dict[str, tuple[float, float]], list[Link]]:
    sizes = {
        f"b{index}": (draw(st.integers(20, 200)), draw(st.integers(20, 90)))
        for index in range(draw(st.integers(1, 14)))
    }
    pairs = st.tuples(st.sampled_from(list(sizes)), st.sampled_from(list(sizes))).filter(
        lambda pair: pair[0] != pair[1]
    )
    chosen = draw(st.lists(pairs, max_size=20)) if len(sizes) > 1 else []
    links = [
        Link(source, target, draw(st.integers(1, 19)), draw(st.integers(1, 19)), draw(st.booleans()))
        for source, target in chosen
    ]
    return sizes, links


@settings(max_examples=examples(50), deadline=None)
@given(graph=graphs())
def test_nothing_is_in_the_way(graph: tuple[dict[str, tuple[float, float]], list[Link]]) -> None:
    sizes, links = graph
    arranged = arrange(sizes, links)
    boxes = {name: (x, y, x + sizes[name][0], y + sizes[name][1]) for name, (x, y) in arranged.places.items()}
    assert boxes.keys() == sizes.keys()
    for box in boxes.values():
        assert min(box) >= 0
        assert (box[2] <= arranged.width, box[3] <= arranged.height + 0.001) == (True, True)
    for (left, top, right, bottom), (other_left, other_top, other_right, other_bottom) in combinations(
        boxes.values(), 2
    ):
        apart = right < other_left or other_right < left or bottom < other_top + 0.001 or other_bottom < top + 0.001
        assert apart
    for link, route in zip(links, arranged.routes, strict=True):
        (x, y), (end_x, end_y) = route.points[0], route.points[-1]
        left, top, right, _ = boxes[link.source]
        assert (x, round(y - top, 6)) == (right if route.leaves > 0 else left, link.source_port)
        left, top, right, _ = boxes[link.target]
        assert (end_x, round(end_y - top, 6)) == (left if route.arrives > 0 else right, link.target_port)
        assert not [
            name for name, box in boxes.items() for start, end in pairwise(route.points) if _crosses(box, start, end)
        ]


def _crosses(box: tuple[float, ...], start: tuple[float, float], end: tuple[float, float]) -> bool:
    """Return whether a segment of a route touches the inside of a box; only horizontal segments are at boxes."""
    left, top, right, bottom = box
    within = max(left, min(start[0], end[0])) < min(right, max(start[0], end[0])) - 0.001
    return within and top + 0.001 < max(start[1], end[1]) and min(start[1], end[1]) < bottom - 0.001


def test_ranking_links_run_to_the_right() -> None:
    sizes = dict.fromkeys("abcd", (50.0, 20.0))
    links = [
        Link("a", "b", 10, 10, True),
        Link("b", "c", 10, 10, True),
        Link("c", "a", 10, 10, True),
        Link("d", "c", 5, 5, False),
    ]
    arranged = arrange(sizes, links)
    assert [arranged.places[name][0] for name in "abcd"] == [0, 114, 228, 114]
    assert [route.leaves for route in arranged.routes] == [1, 1, -1, 1]


def test_many_ranks_are_folded() -> None:
    names = [f"b{index}" for index in range(15)]
    links = [Link(source, target, 5, 5, True) for source, target in pairwise(names)]
    arranged = arrange(dict.fromkeys(names, (50.0, 20.0)), links)
    columns = [round(arranged.places[name][0] / 114) for name in names]
    assert columns == [0, 1, 2, 3, 4, 5, 6, 7, 6, 5, 4, 3, 2, 1, 0]
