"""`robosc diagram`: models and metamodels as pictures."""

from pathlib import Path

import pytest

import robosc
from robosc.tools.diagrams import (
    GRAPH_NOTATIONS,
    METAMODELS,
    NOTATIONS,
    behaviour_graph,
    diagram,
    metamodel_diagram,
    plants_graph,
    ros_graph,
)

from .conftest import Run


@pytest.mark.parametrize("name", METAMODELS)
@pytest.mark.parametrize("notation", NOTATIONS)
def test_printed(run: Run, name: str, notation: str) -> None:
    answer = run("diagram", "--metamodel", name, "--format", notation)
    assert (answer.exit_code, answer.stdout) == (0, metamodel_diagram(name, notation))


def test_written(run: Run) -> None:
    answer = run("diagram", "--metamodel", "sct", "--format", "svg", "-o", "pictures/sct.svg")
    assert (answer.exit_code, answer.output) == (0, "")
    assert Path("pictures/sct.svg").read_text() == metamodel_diagram("sct", "svg")


@pytest.mark.parametrize("notation", GRAPH_NOTATIONS)
def test_models(run: Run, door: Path, notation: str) -> None:
    robot = robosc.load(door)
    graphs = {
        (): behaviour_graph(robot),
        ("--kind", "behaviour"): behaviour_graph(robot),
        ("--kind", "ros-graph"): ros_graph(robosc.to_rosgraph(robot)),
        ("--kind", "plants"): plants_graph(robosc.to_sct(robot)),
    }
    for call, graph in graphs.items():
        answer = run("diagram", door, *call, "--format", notation)
        assert (answer.exit_code, answer.stdout) == (0, diagram(graph, notation))


@pytest.mark.parametrize("kind", ["behaviour", "ros-graph", "plants"])
def test_saved_models_give_the_same(run: Run, door: Path, kind: str) -> None:
    assert run("transform", door, "--to", "xmi", "-o", "saved").exit_code == 0
    printed = run("diagram", door, "--kind", kind).stdout
    ending = {"behaviour": "robosc", "ros-graph": "rosgraph", "plants": "sct"}[kind]
    answer = run("diagram", f"saved/Door.{ending}.xmi", "--kind", kind)
    assert (answer.exit_code, answer.stdout) == (0, printed)


@pytest.mark.parametrize("kind", ["behaviour", "ros-graph"])
def test_what_a_saved_model_does_not_say(run: Run, door: Path, kind: str) -> None:
    run("transform", door, "--to", "xmi", "-o", "saved")
    answer = run("diagram", "saved/Door.sct.xmi", "--kind", kind)
    assert (answer.exit_code, answer.stdout) == (2, "")
    assert "use --kind plants" in answer.stderr


def test_a_library_has_behaviour_but_no_plants(run: Run) -> None:
    library = Path(robosc.__file__).parent / "stdlib" / "emergency_stop.rscd"
    assert "in_service" in run("diagram", library).stdout
    assert run("diagram", library, "--kind", "plants").exit_code == 2


def test_a_model_with_errors(run: Run, broken: Path) -> None:
    answer = run("diagram", broken)
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert "unresolved-reference" in answer.stderr


@pytest.mark.parametrize(
    "call",
    [
        ("--metamodel", "uml"),
        ("--metamodel", "sct", "--format", "png"),
        (),
        ("--metamodel", "sct", "--format", "dot"),
        ("--metamodel", "sct", "--kind", "plants"),
        ("door.rscd", "--metamodel", "sct"),
        ("door.rscd", "--format", "plantuml"),
        ("door.rscd", "--kind", "metamodel"),
        ("nowhere.rscd",),
    ],
)
@pytest.mark.usefixtures("door")
def test_a_wrong_call(run: Run, call: tuple[str, ...]) -> None:
    assert run("diagram", *call).exit_code == 2


def test_a_place_that_can_not_be_written(run: Run) -> None:
    Path("file").touch()
    answer = run("diagram", "--metamodel", "sct", "-o", "file/sct.mmd")
    assert answer.exit_code == 2
    assert answer.stderr.startswith("Error: ")


def test_what_to_draw_must_be_said(run: Run) -> None:
    assert "give a MODEL or --metamodel NAME" in run("diagram").stderr
