"""The examples of the language's second edition, each in a small model, in all views."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner

import robosc
from robosc.m2t.targets import TARGETS
from robosc.tools.cli import main
from robosc.tools.diagrams import GRAPH_NOTATIONS, behaviour_graph, diagram, plants_graph, ros_graph
from tests.fuzz.valid import compared, compiled, taken_through

if TYPE_CHECKING:
    from tests.fuzz.valid import Robot

pytestmark = pytest.mark.slow

FOLDER = Path(__file__).parent / "every_view"
NAMES = ["data", "failures", "fleets", "names", "requirements", "templates", "transitions", "stored"]
EACH = pytest.mark.parametrize("name", NAMES)


def in_all_views(name: str, folder: Path) -> Robot:
    """Check that a model has no errors and a supervisor, equals its saved form and its CIF, and yields all packages."""
    copied = shutil.copytree(FOLDER, folder / "models")
    # Seeds that are multiples of five also save the models as XMI and read them back.
    _, robot = taken_through(copied / f"{name}.rscd", 5 * NAMES.index(name))
    assert robot is not None
    return robot


def test_all_are_there() -> None:
    assert sorted(path.stem for path in FOLDER.glob("*.rscd")) == sorted([*NAMES, "ArmLibrary"])


@EACH
def test_views(name: str, tmp_path: Path) -> None:
    models = in_all_views(name, tmp_path).models
    assert models.robosc is not None
    assert models.rosgraph is not None
    graphs = behaviour_graph(models.robosc), plants_graph(models.sct), ros_graph(models.rosgraph)
    assert all(diagram(graph, notation) for graph in graphs for notation in GRAPH_NOTATIONS)
    assert not TARGETS["ros2-layer"].findings(models, robosc.Configuration())
    assert robosc.generate("ros2-layer", models)


@EACH
def test_the_layout_is_canonical(name: str) -> None:
    done = CliRunner().invoke(main, ["format", "--check", str(FOLDER / f"{name}.rscd")])
    assert (done.exit_code, done.output) == (0, "")


@EACH
def test_it_can_be_simulated(name: str) -> None:
    done = CliRunner().invoke(main, ["simulate", str(FOLDER / f"{name}.rscd"), "--random", "50", "--seed", "1"])
    assert done.exit_code == 0, done.output
    assert len(done.stdout.splitlines()) == 50


@pytest.mark.build
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
@EACH
def test_the_engine_in_c_does_what_the_interpreter_does(name: str, tmp_path: Path) -> None:
    robot = in_all_views(name, tmp_path)
    compared(robot, compiled([robot], tmp_path, ["-O0", "-fsanitize=undefined", "-fno-sanitize-recover=all"]))
