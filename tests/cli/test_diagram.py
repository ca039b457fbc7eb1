"""`robosc diagram`: metamodels as pictures."""

from pathlib import Path

import pytest

from robosc.diagrams import METAMODELS, NOTATIONS, metamodel_diagram

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


@pytest.mark.parametrize("call", [("--metamodel", "uml"), ("--metamodel", "sct", "--format", "png"), ()])
def test_a_wrong_call(run: Run, call: tuple[str, ...]) -> None:
    assert run("diagram", *call).exit_code == 2


def test_a_place_that_can_not_be_written(run: Run) -> None:
    Path("file").touch()
    answer = run("diagram", "--metamodel", "sct", "-o", "file/sct.mmd")
    assert answer.exit_code == 2
    assert answer.stderr.startswith("Error: ")
