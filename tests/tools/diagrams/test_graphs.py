"""Diagrams of robots: their content, and that model texts stay inside their places."""

import re
import shutil
import subprocess
from functools import cache
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.base.diagnostics.visible import visible
from robosc.language.reading import read
from robosc.tools.diagrams import GRAPH_NOTATIONS, behaviour_graph, diagram, plants_graph, ros_graph
from robosc.tools.diagrams.graph import Arrow, DiagramNode, Graph, Group
from robosc.tools.diagrams.graph_drawing import draw
from robosc.tools.diagrams.graph_layout import lay_out
from tests.searching import examples

YARD = Path(__file__).with_name("yard")
ENDINGS = {"mermaid": "mmd", "dot": "dot", "svg": "svg"}
KINDS = ("behaviour", "ros-graph", "plants")
EACH = pytest.mark.parametrize(
    ("kind", "notation"), [(kind, graph_notation) for kind in KINDS for graph_notation in GRAPH_NOTATIONS]
)


@cache
def graph(kind: str) -> Graph:
    robot = robosc.load(YARD / "yard.rscd")
    if kind == "behaviour":
        return behaviour_graph(robot)
    return ros_graph(robosc.to_rosgraph(robot)) if kind == "ros-graph" else plants_graph(robosc.to_sct(robot))


@EACH
def test_diagrams(kind: str, notation: str, golden) -> None:
    golden(YARD / f"{kind}.{ENDINGS[notation]}", diagram(graph(kind), notation))


def test_an_unknown_notation() -> None:
    with pytest.raises(ValueError, match="no diagram in png"):
        diagram(graph("plants"), "png")


# Content of diagrams


def test_behaviour() -> None:
    crane, front, rear = graph("behaviour").groups
    assert (crane.title, front.title, rear.title) == ("Crane", "Front", "Rear")
    assert crane.remarks[:2] == ["lifted: boolean = false", "part: integer(0..4)"]
    everywhere, resting, swinging, broken = crane.nodes
    assert (everywhere.kind, everywhere.rows) == ("every", [("on response from heard", "do ^state := value")])
    assert (resting.initial, resting.marked, swinging.initial, swinging.marked) == (True, True, False, False)
    assert resting.rows == [("on request to lift",), ("on response from lift", "do lifted := value")]
    guard = "transition if lifted and part < 4"
    arrows = {(arrow.source, arrow.target): arrow.labels for arrow in crane.arrows}
    assert arrows == {
        (everywhere.key, resting.key): (("on response from Rear.stop",),),
        (resting.key, swinging.key): ((guard, "do part := part + 1,", "lifted := false"),),
        (swinging.key, resting.key): (("on response from swing",), ("on error from swing",)),
        (swinging.key, broken.key): (("on cancel from swing",),),
        (broken.key, resting.key): (("transition",),),
    }


def test_behaviour_of_a_library() -> None:
    library = read(str(Path(robosc.__file__).parent / "stdlib" / "emergency_stop.rscd")).base
    assert library is not None
    (group,) = behaviour_graph(library).groups
    assert [node.title for node in group.nodes] == ["in_service", "stopped"]


def test_ros_graph() -> None:
    (group,) = graph("ros-graph").groups
    shown = {node.title: (node.kind, node.rows) for node in group.nodes}
    assert shown["/echo"] == ("topic", [("std_msgs/String",), ("Crane.heard",), ("Crane.echo",)])
    assert shown["lift"] == ("service", [("crane_msgs/Lift",), ("Crane.lift",)])
    assert shown["/crane/swing"] == ("action", [("crane_msgs/Swing",), ("Crane.swing",)])
    assert shown["yard_controller"] == ("controller", ())
    names = {node.key: node.title for node in group.nodes}
    ways = {(names[arrow.source], names[arrow.target], arrow.both) for arrow in group.arrows}
    assert ways == {
        ("/echo", "yard_controller", True),
        *((topic, "yard_controller", False) for topic in ("/stop", "/continue", "/rear/stop", "/rear/continue")),
        ("yard_controller", "lift", True),
        ("yard_controller", "/crane/swing", True),
    }


def test_requests_come_to_servers() -> None:
    text = """robot R {
      interface inspection use Fibonacci from example_interfaces
      component C {
        outgoing service start with request: none, response: none
        outgoing action inspect with request: none, response: none, feedback: none links inspection
      }
    }"""
    (group,) = ros_graph(robosc.to_rosgraph(robosc.load(text=text))).groups
    names = {node.key: node.title for node in group.nodes}
    ways = {(names[arrow.source], names[arrow.target], arrow.both) for arrow in group.arrows}
    assert ways == {("start", "r_controller", False), ("inspect", "r_controller", False)}


def test_plants() -> None:
    groups = {group.title: group for group in graph("plants").groups}
    crane, data = groups["component_Crane"], groups["data_swing"]
    assert crane.remarks == ["lifted: boolean = false", "part: integer(0..4) = 0"]
    assert crane.nodes[0].rows == [("message_heard.u_response",)]
    assert (("c_tau1", "if lifted and part < 4", "part := part + 1", "lifted := false"),) in [
        arrow.labels for arrow in crane.arrows
    ]
    assert [arrow.labels for arrow in data.arrows] == [
        (("c_d1", "if component_Crane.part < 2"),),
        (("c_d2",),),
        (("c_none", "if false"),),
    ]
    assert {arrow.source for arrow in data.arrows} == {data.nodes[0].key}
    # Two states with transitions from each to the other do not count as "everywhere".
    assert [node.kind for node in groups["component_Front"].nodes] == ["state", "state"]


# Arbitrary texts in a model

TEXTS = st.text(st.characters(codec="utf-8") | st.sampled_from('"\\#;:<>&{}[]()|%-\n\r\t\u2028'), max_size=12)
HOSTILE = [
    'a"] b [label="c',
    "end",
    "\\",
    "--> c1_2 : x",
    "</text><script>alert(1)</script>",
    "x\n  c1_9 : y",
    "%%{init: {}}%%",
    "#quot; &quot; \\N \\G",
    "\udc80",
    "click t1 href",
    "`**x**`",
]


def made(title: str, text: str, *, states: bool) -> Graph:
    """Return a diagram with texts in every place, escaped as all builders do."""
    title, text = visible(title), visible(text)
    kind, other = ("state", "every") if states else ("topic", "controller")
    nodes = [
        DiagramNode("c1_1", kind, title, [(text, title)], initial=True, marked=True),
        DiagramNode("c1_2", other, text),
    ]
    arrow = Arrow("c1_1", "c1_2", ((text,),))
    group = Group("c1", title or "t", [text], nodes, [arrow]) if states else Group("c1", "", (), nodes, [arrow])
    return Graph(title, [group])


def skeleton(notation: str, text: str) -> list[str]:
    """Return a diagram without its texts, in which a text outside its place would remain."""
    if notation == "dot":
        return re.sub(r'"(?:[^"\\\n]|\\.)*"', "TEXT", text).splitlines()
    if notation == "mermaid":
        label = r"(?:[A-Za-z0-9_ .,/()=+*-]|#\d+;|<br/>)*"
        return [re.sub(rf'(?<=")({label})(?=")|(?<= : )({label})$', "TEXT", line) for line in text.splitlines()]
    root = ElementTree.fromstring(text)  # noqa: S314 - our own
    return [node.tag.rpartition("}")[2] for node in root.iter()]


@pytest.mark.slow
@pytest.mark.parametrize("notation", GRAPH_NOTATIONS)
@pytest.mark.parametrize("states", [True, False])
@settings(max_examples=examples(30), deadline=None)
@given(title=TEXTS | st.sampled_from(HOSTILE), text=TEXTS | st.sampled_from(HOSTILE))
def test_no_text_gets_out_of_its_place(notation: str, states: bool, title: str, text: str) -> None:
    drawn = diagram(made(title, text, states=states), notation)
    drawn.encode()
    plain = diagram(made("name", "words", states=states), notation)
    assert skeleton(notation, drawn) == skeleton(notation, plain)


@pytest.mark.parametrize("text", HOSTILE)
def test_a_picture_shows_what_the_model_says(text: str) -> None:
    root = ElementTree.fromstring(diagram(made("name", text, states=True), "svg"))  # noqa: S314 - our own
    assert [node.text for node in root.iter() if node.text == visible(text)] == [visible(text)] * 4


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
@pytest.mark.parametrize("text", [None, *HOSTILE])
def test_graphviz_reads_it(text: str | None) -> None:
    shown = map(graph, KINDS) if text is None else (made(text, text, states=value) for value in (True, False))
    for drawn in shown:
        done = subprocess.run(["dot", "-Tplain"], input=diagram(drawn, "dot").encode(), capture_output=True, check=True)
        nodes = [line.split()[1] for line in done.stdout.decode().splitlines() if line.startswith("node ")]
        assert {node.key for node in drawn.nodes} == {name for name in nodes if not name.endswith("_initial")}
        assert done.stderr == b""


# The layout


@st.composite
def groups(draw: st.DrawFn, *, downwards: bool) -> Group:
    count = draw(st.integers(1, 7))
    titles = draw(st.lists(st.integers(1, 20).map("x".__mul__), min_size=count, max_size=count))
    rows = draw(st.lists(st.sampled_from([(), [("row",)]]), min_size=count, max_size=count))
    nodes = [
        DiagramNode(f"n{number}", "state", title, lines, initial=downwards and number == 0)
        for number, (title, lines) in enumerate(zip(titles, rows, strict=True))
    ]
    pairs = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)).filter(lambda pair: pair[0] != pair[1])
    chosen = draw(st.lists(pairs, max_size=12, unique=True)) if count > 1 else []
    labels = (("a label",),) if draw(st.booleans()) else ()
    return Group("n", "title", (), nodes, [Arrow(f"n{source}", f"n{target}", labels) for source, target in chosen])


@settings(max_examples=examples(40), deadline=None)
@given(data=st.data(), downwards=st.booleans())
def test_nothing_overlaps_and_arrows_join_their_nodes(data: st.DataObject, downwards: bool) -> None:
    group = data.draw(groups(downwards=downwards))
    layout = lay_out(group, downwards=downwards)
    boxes = [layout.nodes[node.key] for node in group.nodes]
    for first, second in combinations(boxes, 2):
        apart_x = first.x + first.width < second.x or second.x + second.width < first.x
        assert apart_x or first.y + first.height < second.y or second.y + second.height < first.y
    for box in boxes:
        assert min(box.x, box.y) >= 0
        assert (box.x + box.width <= layout.width + 0.01, box.y + box.height <= layout.height + 0.01) == (True, True)
    for arrow, route in zip(group.arrows, layout.routes, strict=True):
        for key, (x, y) in ((arrow.source, route[0]), (arrow.target, route[-1])):
            box = layout.nodes[key]
            assert box.x - 0.01 <= x <= box.x + box.width + 0.01
            assert box.y - 0.01 <= y <= box.y + box.height + 0.01
            along, ends = (y, (box.y, box.y + box.height)) if downwards else (x, (box.x, box.x + box.width))
            assert min(abs(along - end) for end in ends) < 0.01


def test_frames_are_inside_the_picture() -> None:
    picture = draw(graph("plants"))
    frames = [box for box in picture.boxes if box.kind == "frame"]
    assert len(frames) == len(graph("plants").groups)
    for box in picture.boxes:
        assert box.x + box.width <= picture.width
        assert box.y + box.height <= picture.height
    for frame, other in combinations(frames, 2):
        assert frame.x + frame.width < other.x or frame.y + frame.height < other.y or other.y + other.height < frame.y
