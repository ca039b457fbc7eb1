"""Edited saved models: redirected, duplicated, missing or extreme values end in findings."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.analysis.supervise import supervise
from robosc.base.diagnostics import ModelError, has_errors
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.m2t.models import Models
from robosc.m2t.targets import TARGETS
from robosc.model import robosc as rsc
from robosc.model import rosgraph
from robosc.model.validity import load
from robosc.run.node_tests.trace_test import trace_test_of
from robosc.run.simulation import Simulation
from tests.fuzz.hostile_xmi import edits
from tests.fuzz.trial import time_limit

if TYPE_CHECKING:
    from collections.abc import Mapping

EXAMPLE = Path(__file__).parents[2] / "examples" / "line_follower" / "line_follower.rscd"
#: The number of random changes per file.
TRIALS = 25

ROBOT, GRAPH = "LineFollower.robosc.xmi", "LineFollower.rosgraph.xmi"
#: Changes with their expected messages.
CHANGES = {
    "communication of another component": (
        ROBOT,
        r'(<communicationTypes [^>]*component="//@definitions)\.7"',
        r'\1.4"',
        "'move' is not a communication of 'LineDetector'",
    ),
    "state of another component": (
        ROBOT,
        r'(component="//@definitions)\.5" (item="//@definitions.5/)',
        r'\1.4" \2',
        "is not a state or variable of 'LineDetector'",
    ),
    "target in another component": (
        ROBOT,
        r'target="//@definitions.5/([^"]*)"',
        r'target="//@definitions.4/@type/@definitions.2/@automaton/@definitions.1"',
        "is another component's state",
    ),
    "property of another object": (
        "Warehouse.robosc.xmi",
        r'property="//@definitions.4/@properties.0"',
        'property="//@definitions.5/@properties.0"',
        "'x' is not a property of object Scan",
    ),
    "property of an array": (
        ROBOT,
        r'(<segments xsi:type="robosc:PropertySegment" [^>]*/>)',
        r"\1\1",
        "'ranges' is not a property of array",
    ),
    "component of another library": (
        ROBOT,
        r'(<library [^>]*href=")EmergencyStopLibrary',
        r"\1TurtlebotLibrary",
        "is not a component of TurtlebotLibrary",
    ),
    "component from itself": (
        "EmergencyStopLibrary.robosc.xmi",
        "</robosc:Library>",
        (
            '<definitions xsi:type="robosc:Component" name="C"><type xsi:type="robosc:ImportedComponent"><library'
            ' href="EmergencyStopLibrary.robosc.xmi#/"/><definition href="#//@definitions.3"/></type></definitions>'
            "</robosc:Library>"
        ),
        "'C' contains itself",
    ),
    "doubled step": (
        GRAPH,
        r'(\s*<steps [^>]*name="ranges"/>)',
        r"\1\1",
        "'ranges' has the type an array here, but an object elsewhere",
    ),
    "field in a number": (
        "Warehouse.rosgraph.xmi",
        r"(<path>pose</path>)\s*<path>x</path>",
        r"\1",
        "'pose' has the type an object here, but DoubleType elsewhere",
    ),
}


@pytest.fixture(scope="module")
def saved() -> Mapping[str, str]:
    """Return the saved models of the line follower by name."""
    robot = robosc.load(EXAMPLE)
    models = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    return robosc.generate("xmi", models)


def used(path: Path, target: str | None) -> None:
    """Use a saved model as the commands do. Raises ModelError if the model does not support this."""
    root = load(path)
    if isinstance(root, rsc.Base):
        found = check(root, [], RosTypes(()))
        if has_errors(found) or isinstance(root, rsc.Library):
            raise ModelError(found)
        models = Models(robosc.to_sct(root), robosc.to_rosgraph(root), root)
    else:
        models = Models(root.model, root) if isinstance(root, rosgraph.RosGraph) else Models(root)
    if models.sct.supervisor is None:
        supervise(models.sct)
    simulation, random = Simulation(models.sct, models.rosgraph), Random(1)  # noqa: S311
    for _ in range(5):
        simulation.random_step(random)
    if (
        target
        and models.rosgraph is not None
        and not has_errors(TARGETS[target].findings(models, robosc.Configuration()))
    ):
        made, settings = TARGETS[target], robosc.Configuration()
        made.files(models, settings, trace_test_of(made, models, settings))


@pytest.mark.parametrize("change", CHANGES)
def test_what_no_text_could_say_is_said(
    saved: Mapping[str, str], texts: Mapping[str, str], folder: Path, change: str
) -> None:
    file, pattern, replacement, message = CHANGES[change]
    for name, text in saved.items():
        (folder / name).write_text(text, encoding="utf-8")
    changed, count = re.subn(pattern, replacement, {**texts, **saved}[file], count=1)
    assert count == 1
    (folder / file).write_text(changed, encoding="utf-8")
    with pytest.raises(ModelError) as error:
        used(folder / file, None)
    assert any(message in diagnostic.message for diagnostic in error.value.diagnostics), error.value
    assert {diagnostic.rule for diagnostic in error.value.diagnostics} == {"xmi"}


#: Changes of a robot with a template (0) and its instances (1 and 2), with their expected messages.
OF_TEMPLATES = {
    "component of itself": (
        r'(InstantiatedComponent" [^>]*definition="//@definitions)\.0"',
        r'\1.1"',
        "'X' contains itself",
    ),
    "no template": (
        r'(InstantiatedComponent" [^>]*definition="//@definitions)\.0"',
        r'\1.2"',
        "'Y' is not a template",
    ),
    "template without text": (
        r'name="X">',
        r'name="X"><parameters name="m"><type xsi:type="robosc:IntegerDataType"/></parameters>',
        "the template 'X' has no content of its own",
    ),
    "template in place of a component": (
        r'(<left [^>]*component="//@definitions)\.1"',
        r'\1.0"',
        "the component of 'v' is missing",
    ),
}


@pytest.mark.parametrize("change", OF_TEMPLATES)
def test_what_no_text_could_say_of_templates_is_said(tmp_path: Path, change: str) -> None:
    robot = robosc.load(
        text="""robot R {
          component T(n: integer) {
            incoming message k with type: none
            behaviour { variable v: integer(0..5) = n initial marked state i { } }
          }
          component X is T(1)
          component Y is T(2)
          requirement X.k needs X.v < 1
        }"""
    )
    models = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    pattern, replacement, message = OF_TEMPLATES[change]
    saved = robosc.generate("xmi", models)["R.robosc.xmi"]
    changed, count = re.subn(pattern, replacement, saved, count=1)
    assert count == 1
    (tmp_path / "R.robosc.xmi").write_text(changed, encoding="utf-8")
    with pytest.raises(ModelError) as error, time_limit(60):
        used(tmp_path / "R.robosc.xmi", None)
    assert any(message in diagnostic.message for diagnostic in error.value.diagnostics), error.value


@pytest.mark.slow
@pytest.mark.parametrize("file", [ROBOT, GRAPH, "LineFollower.sct.xmi"])
def test_any_change_ends_in_findings(saved: Mapping[str, str], tmp_path: Path, file: str) -> None:
    for name, text in saved.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    random = Random(file)  # noqa: S311 - nothing here is secret
    ended = set()
    for number, (change, text) in enumerate(random.sample(list(edits(saved, file, 3)), TRIALS)):
        (tmp_path / file).write_text(text, encoding="utf-8")
        try:
            with time_limit(60):
                used(tmp_path / file, ("ros1", "ros2", None, None, None)[number % 5])
            ended.add(True)
        except ModelError as error:
            ended.add(not error.diagnostics)
        except Exception as error:
            raise AssertionError(f"{change}: {error!r}") from error
    assert ended == {True, False}
