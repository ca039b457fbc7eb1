"""Commands whose data the supervisor reads: everything is proved, and seeded faults are found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from robosc.analysis.verify import (
    LoopEffort,
    Outcome,
    Verdict,
    validate_c,
    validate_cif,
    validate_controller,
    validate_loop,
    validate_model,
    verify,
    verify_system,
)
from robosc.analysis.verify.sent_data import data_can_comply
from robosc.base.diagnostics import Severity
from robosc.language.configuration import Configuration
from robosc.m2m import robosc_to_sct, sct_to_engine
from robosc.m2t import cif, supervisor
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.evaluation import literal
from robosc.model.semantics.roles import event_name
from tests.analysis.verify.commands import COURIER, GUARD, ROBOTS, models_of
from tests.analysis.verify.seeding import seed
from tests.language.checks.test_rule_pages import models as models_on_page

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from robosc.m2t.models import Models

_PLANTS, _ENGINE = "m2m.robosc_to_sct", "m2m.sct_to_engine.combine_guards"
LEVEL = "message_level.c_trigger"


def guard_of(models: Models, event: str) -> sct.EventGuard:
    assert models.sct.supervisor is not None
    return next(guard for guard in models.sct.supervisor.guards if event_name(guard.event) == event)


def refuted(verdicts: Sequence[Verdict]) -> dict[str, str]:
    """Return the explanations of refuted properties."""
    return {verdict.property: verdict.explanation for verdict in verdicts if verdict.outcome is Outcome.REFUTED}


def generated_c(models: Models) -> dict[str, str]:
    return dict(supervisor.generate(models, Configuration()))


@pytest.mark.slow
@pytest.mark.build
@pytest.mark.parametrize("name", ROBOTS)
def test_all_rows_hold(name: str, tmp_path: Path) -> None:
    verdicts = verify(models_of(ROBOTS[name], tmp_path), Configuration())
    wrong = [verdict for verdict in verdicts if verdict.outcome not in (Outcome.PROVED, Outcome.SAMPLED)]
    assert wrong == []
    sampled = {verdict.property for verdict in verdicts if verdict.outcome is Outcome.SAMPLED}
    assert sampled <= {"loop-translation"}


@pytest.mark.parametrize("name", ROBOTS)
def test_readings_and_properties_hold(name: str, tmp_path: Path) -> None:
    models = models_of(ROBOTS[name], tmp_path)
    verdicts = [
        *verify_system(models.sct),
        validate_model(models.robosc, models.sct),
        validate_controller(models),
        validate_cif(models.sct, dict(cif.generate(models, Configuration()))),
        data_can_comply(models),
    ]
    assert [verdict for verdict in verdicts if verdict.outcome is not Outcome.PROVED] == []


# The guard


def test_a_lost_conjunct_on_an_input_breaks_the_requirement(tmp_path: Path) -> None:
    models = models_of(GUARD, tmp_path)
    guard = guard_of(models, LEVEL)
    assert isinstance(guard.requirement, ex.Disjunction)
    assert isinstance(guard.requirement.right, ex.Conjunction)
    guard.requirement.right = guard.requirement.right.right
    found = next(verdict for verdict in verify_system(models.sct) if verdict.property.startswith("requirement level"))
    assert (found.outcome, found.explanation) == (
        Outcome.REFUTED,
        "request to `Base.level` (value = 4) can happen where `Person.near`",
    )
    assert [str(step) for step in found.trace] == [
        "message_seen.u_response(i_response = true)",
        f"{LEVEL}(i_trigger = 4)",
    ]


def test_synthesis_adds_a_condition_on_an_input(tmp_path: Path) -> None:
    models = models_of(GUARD, tmp_path)
    guard_of(models, LEVEL).synthesis = None
    assert refuted(verify_system(models.sct)) == {
        "requirement never Base.fast and Person.near (line 27)": "it is violated where `Base.fast and Person.near`"
    }


def test_a_guard_that_forbids_some_data_is_needless(tmp_path: Path) -> None:
    models = models_of(GUARD, tmp_path)
    guard = guard_of(models, LEVEL)
    [carried] = guard.event.inputs
    no_three = ex.Inequation(left=_read(carried), right=ex.IntegerLiteral(value=3))
    guard.synthesis = no_three if guard.synthesis is None else ex.Conjunction(left=guard.synthesis, right=no_three)
    assert refuted(verify_system(models.sct))["maximal permissiveness"] == (
        "request to `Base.level` (value = 3) is forbidden here without a reason"
    )


def _read(carried: sct.Input) -> ex.Expression:
    return sct.InputReference(input=carried)


# Some data


#: A person forbids all data but one, and synthesis forbids that one: some data are allowed without a person only.
SOME = GUARD.replace("value < 4 and value >= 3", "value > 4")


@pytest.mark.build
@pytest.mark.parametrize(("wide", "sides"), [(True, ("controller", "model")), (False, ("model", "controller"))])
def test_where_some_data_are_allowed(wide: bool, sides: tuple[str, str], tmp_path: Path) -> None:
    models = models_of(SOME, tmp_path)
    guard = guard_of(models, LEVEL)
    assert guard.someData is not None
    assert validate_controller(models).outcome is Outcome.PROVED
    assert validate_c(models.sct, generated_c(models)).outcome is Outcome.PROVED
    models = models_of(SOME, tmp_path)
    guard_of(models, LEVEL).someData = None if wide else ex.BooleanLiteral(value=False)
    found = validate_controller(models)
    assert (found.outcome, found.explanation) == (
        Outcome.REFUTED,
        f"request to `Base.level` is allowed with any data in the {sides[0]}, and not in the {sides[1]}",
    )
    found = validate_c(models.sct, generated_c(models))
    assert found.outcome is Outcome.REFUTED
    assert f"can happen in the {'generated C' if wide else 'model'} and not in" in found.explanation


def test_the_controller_without_a_condition_on_data(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, _ENGINE, "            data.append(term)\n", "")
    found = validate_controller(models_of(GUARD, tmp_path))
    assert (found.outcome, found.explanation) == (
        Outcome.REFUTED,
        "request to `Base.velocity` is allowed with its data in the controller, and not in the model",
    )


# The generated texts


@pytest.mark.build
@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_the_incremental_loop(name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sct_to_engine, "POLLED", 0)
    models = models_of(ROBOTS[name], tmp_path)
    files = generated_c(models)
    assert not any("evaluates all guards" in text for text in files.values())
    assert validate_c(models.sct, files).outcome is Outcome.PROVED
    assert validate_loop(models.sct, files, LoopEffort(10_000, 2_000)).outcome in (Outcome.PROVED, Outcome.SAMPLED)


@pytest.mark.build
@pytest.mark.slow
def test_the_c_without_its_condition_on_data(tmp_path: Path) -> None:
    models = models_of(GUARD, tmp_path)
    files = generated_c(models)
    (source,) = [name for name in files if name.endswith("_supervisor.c")]
    condition = "    if (!inputs_permitted(&self->state, &self->inputs, event)) {\n        return false;\n    }\n"
    assert files[source].count(condition) == 1
    files[source] = files[source].replace(condition, "")
    explanation = validate_c(models.sct, files).explanation
    assert explanation.endswith("can happen in the generated C and not in the model where `Base.idle and Person.far`")
    assert validate_loop(models.sct, files).outcome is Outcome.REFUTED


@pytest.mark.parametrize(
    ("file", "before", "after"),
    [
        ("Guard.cif", "when message_level.i_trigger > 3 goto busy", "goto busy"),
        ("Guard.cif", "component_Person.far or message_velocity.i_trigger_c1", "component_Person.far"),
        ("Guard.supervised.cif", "component_Person.far or message_velocity.i_trigger_c1", "component_Person.far"),
        ("Guard.supervised.cif", "component_Person.far or message_velocity.i_trigger_c1", "true"),
    ],
)
def test_the_cif_without_an_input(file: str, before: str, after: str, tmp_path: Path) -> None:
    models = models_of(GUARD, tmp_path)
    files = dict(cif.generate(models, Configuration()))
    assert files[file].count(before) == 1
    files[file] = files[file].replace(before, after)
    assert validate_cif(models.sct, files).outcome is Outcome.REFUTED


# The text


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (
            "elif origin in RUNNING and end not in RUNNING:",
            "elif False:",
            "`Base.go.goal_i_trigger` is -1 by the text",
        ),
        (
            "elif origin in RUNNING and end not in RUNNING:",
            "elif origin in RUNNING and end not in (*RUNNING, IDLE):",
            "`Base.go.goal_i_trigger` is -1 by the text",
        ),
        (
            "value=sct.InputReference(input=input_element)",
            "value=copy_tree(variable.initial)",
            "stays as it was in the",
        ),
        ("initial=first_value(carried.type)", "initial=literal(0)", "begins at -1 by the text, at 0 in the model"),
        (
            "condition=self.expressions(requirement.condition, within, port)",
            "condition=literal(True)",
            "is forbidden by",
        ),
    ],
)
def test_other_plants(before: str, after: str, said: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(robosc_to_sct, "literal", literal, raising=False)
    seed(monkeypatch, _PLANTS, before, after)
    models = models_of(COURIER, tmp_path)
    found = validate_model(models.robosc, models.sct)
    assert found.outcome is Outcome.REFUTED
    assert said in found.explanation


# Constant data


def test_data_that_are_never_sent(tmp_path: Path) -> None:
    text = GUARD.replace("x: 0.2", "x: 0.5").replace("with 0\n", "with 5\n").replace("with 3 if", "with 1 if")
    found = data_can_comply(models_of(text, tmp_path))
    assert (found.outcome, found.evidence) == (Outcome.WARNED, "4 statements with constant data")
    assert [(finding.rule, finding.severity, finding.span.line) for finding in found.findings] == [
        ("never-sent", Severity.WARNING, 23),
        ("never-sent", Severity.WARNING, 25),
        ("never-sent", Severity.WARNING, 26),
    ]
    causes = [finding.message.partition("data: ")[2] for finding in found.findings]
    assert causes == [
        "`requirement velocity needs Person.far or value.linear.x <= 0.3` (line 21) forbids them in every such state",
        "no component accepts them where the statement applies",
        "the supervisor forbids them, because the robot could reach a state that it must not reach",
    ]


def test_pages_of_never_sent(tmp_path: Path) -> None:
    [wrong], [right] = (models_on_page("never-sent", heading) for heading in ("Wrong", "Right"))
    [finding] = data_can_comply(models_of(wrong, tmp_path)).findings
    assert finding.rule == "never-sent"
    assert "`requirement speed needs Person.far or value <= 1` (line 15) forbids them" in finding.message
    assert data_can_comply(models_of(right, tmp_path)).outcome is Outcome.PROVED


def test_the_trace_has_data_that_the_guard_allows(tmp_path: Path) -> None:
    """A trace shows inputs with which the supervisor allows the command."""
    text = GUARD.replace("provide Base.level with 0\n", "provide Base.level with 0\n  property never Base.busy\n")
    found = next(v for v in verify_system(models_of(text, tmp_path).sct) if v.property.startswith("property"))
    assert [str(step) for step in found.trace] == [f"{LEVEL}(i_trigger = 3)"]
