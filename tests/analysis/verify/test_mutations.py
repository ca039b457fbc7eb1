"""Changes to a correct supervised model are refuted."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.verify import Outcome, verify_system
from robosc.m2t.models import Models
from robosc.model import expression as ex
from robosc.model import sct, xmi
from robosc.model.semantics.roles import event_name
from robosc.tools.cli import main
from tests.examples.conftest import MODELS


def models_of(name: str) -> Models:
    """Return an example's models with supervisor, which tests may change."""
    robot = robosc.load(MODELS[name])
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)


def guard_of(model: sct.SupervisoryControlModel, event: str) -> sct.EventGuard:
    return next(guard for guard in model.supervisor.guards if event_name(guard.event) == event)


def weaken_a_requirement(model: sct.SupervisoryControlModel) -> None:
    """Drop one part of a conjunction."""
    guard = guard_of(model, "message_move.c_trigger")
    assert isinstance(guard.requirement, ex.Conjunction)
    guard.requirement = guard.requirement.right


def remove_a_guard(model: sct.SupervisoryControlModel) -> None:
    guard_of(model, "message_halt.c_trigger").requirement = None


def forbid_an_event(model: sct.SupervisoryControlModel) -> None:
    guard_of(model, "message_halt.c_trigger").synthesis = ex.BooleanLiteral(value=False)


def forbid_it_in_one_state(model: sct.SupervisoryControlModel) -> None:
    blocked = next(location for plant in model.plants for location in plant.locations if location.name == "blocked")
    reference = ex.Negation(operand=sct.LocationReference(location=blocked))
    guard_of(model, "message_halt.c_trigger").synthesis = reference


def drop_a_self_loop(model: sct.SupervisoryControlModel) -> None:
    """Drop the self-loop with which a component accepts irrelevant messages."""
    component = next(plant for plant in model.plants if plant.name == "component_LineDetector")
    location = next(location for location in component.locations if location.name == "searching")
    loop = next(edge for edge in location.edges if edge.target is location)
    location.edges.remove(loop)


def lower_the_bound(model: sct.SupervisoryControlModel) -> None:
    model.supervisor.settlingBound = 0


#: Changes to the line follower, and the properties that each refutes.
MUTATIONS = {
    weaken_a_requirement: {
        "requirement move needs LineDetector.following and Lidar.free and EmergencyStop.in_service (line 61)"
    },
    remove_a_guard: {
        "requirement halt needs LineDetector.searching or Lidar.blocked or EmergencyStop.stopped (line 62)"
    },
    forbid_an_event: {"no dead events", "maximal permissiveness"},
    forbid_it_in_one_state: {"maximal permissiveness"},
    drop_a_self_loop: {"input-enabledness"},
    lower_the_bound: {"bounded response"},
}


@pytest.mark.parametrize("mutate", MUTATIONS, ids=lambda mutation: mutation.__name__)
def test_a_mutation_is_found(mutate: Callable[[sct.SupervisoryControlModel], None]) -> None:
    model = models_of("line_follower").sct
    assert {verdict.outcome for verdict in verify_system(model)} == {Outcome.PROVED}
    mutate(model)
    refuted = {verdict.property for verdict in verify_system(model) if verdict.outcome is Outcome.REFUTED}
    assert refuted == MUTATIONS[mutate]


def saved(models: Models, folder: Path) -> Path:
    for name, text in robosc.generate("xmi", models).items():
        (folder / name).write_text(text)
    return folder / f"{models.sct.name}.sct.xmi"


@pytest.mark.slow
def test_the_supervisor_of_a_saved_model_is_taken_as_it_is(tmp_path: Path) -> None:
    models = models_of("line_follower")
    weaken_a_requirement(models.sct)
    file = saved(models, tmp_path)
    answer = CliRunner().invoke(main, ["verify", str(file)])
    assert answer.exit_code == 1
    assert "line 61)" in answer.stdout
    assert answer.stdout.endswith(" proved, 1 refuted, 1 sampled, 2 skipped\n")


def test_a_saved_model_without_a_guard_is_refused(tmp_path: Path) -> None:
    models = models_of("line_follower")
    models.sct.supervisor.guards.remove(guard_of(models.sct, "message_halt.c_trigger"))
    file = tmp_path / "line_follower.sct.xmi"
    # Save the plants alone: the engine model requires a complete supervisor.
    file.write_text(xmi.to_texts({file.name: models.sct})[file.name])
    answer = CliRunner().invoke(main, ["verify", str(file)])
    assert answer.exit_code == 1
    assert "the event 'message_halt.c_trigger' has no guard" in answer.stderr
