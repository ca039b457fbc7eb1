"""Generated C and CIF match the supervised model; every change to them is refuted, with its position."""

import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from robosc.analysis.verify import Effort, validate, validate_c, validate_cif
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.language.configuration import Configuration
from robosc.m2t import cif, supervisor
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.synthesis import synthesize
from tests.examples.conftest import MODELS, SCENARIOS, models_of
from tests.m2t.supervisor import corners
from tests.random_sct import sct_models
from tests.sct_models import disables, edge, model, needs, plant
from tests.searching import examples

pytestmark = pytest.mark.slow

TRANSLATIONS = ["c-translation", "loop-translation", "cif-translation"]


def supervised(made: sct.SupervisoryControlModel) -> sct.SupervisoryControlModel:
    made.supervisor = synthesize(made).supervisor
    return made


def pump() -> sct.SupervisoryControlModel:
    """Return a robot with a negative range, data, a requirement, and a guard from synthesis."""
    return supervised(
        model(
            [
                plant(
                    "message_level",
                    {"ready": [edge("u_response")]},
                    kind="message",
                    uncontrollable={"u_response": ["i_response"]},
                    inputs={"i_response": "-5..5"},
                ),
                plant("message_move", {"ready": [edge("c_trigger")]}, kind="message", controllable=["c_trigger"]),
                plant(
                    "component_Gauge",
                    {
                        "idle": [
                            edge("message_level.u_response", "metering", do={"level": "message_level.i_response"})
                        ],
                        "metering": [
                            edge("message_level.u_response", do={"level": "level + message_level.i_response"}),
                            edge("c_tau1", "idle", when="level > 2", do={"level": "0"}),
                        ],
                    },
                    controllable=["c_tau1"],
                    variables={"level": "-3..4"},
                    origin="Gauge",
                ),
                plant(
                    "component_Pump",
                    {
                        "rest": [edge("c_tau1", "run", do={"strokes": "strokes + 1"}), edge("c_tau2")],
                        "run": [edge("c_tau2", "rest", when="strokes != 3")],
                    },
                    controllable=["c_tau1", "c_tau2"],
                    variables={"strokes": "0..3"},
                    origin="Pump",
                ),
            ],
            [needs("message_move.c_trigger", "component_Gauge.metering and component_Gauge.level < 3")],
            name="Pump",
        )
    )


def c_of(made: sct.SupervisoryControlModel) -> dict[str, str]:
    return supervisor.generate(Models(made), Configuration())


def cif_of(made: sct.SupervisoryControlModel) -> dict[str, str]:
    return cif.generate(Models(made), Configuration())


def changed(text: str, pattern: str, replacement: str) -> str:
    """Change one place of a text; the pattern must match once."""
    made, count = re.subn(pattern, replacement, text, flags=re.MULTILINE)
    assert count == 1, pattern
    return made


def with_changed_c(pattern: str, replacement: str, effort: Effort | None = None) -> Verdict:
    made = pump()
    files = c_of(made)
    source = changed(files["pump_supervisor.c"], pattern, replacement)
    return validate_c(made, {**files, "pump_supervisor.c": source}, effort)


def with_changed_cif(pattern: str, replacement: str, kind: str = "supervised.cif") -> Verdict:
    made = pump()
    files = cif_of(made)
    name = f"{made.name}.{kind}"
    return validate_cif(made, {**files, name: changed(files[name], pattern, replacement)})


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_examples_are_translated_faithfully(name: str, verified: Callable[[Path], Any]) -> None:
    in_c, loop, in_cif = verified(MODELS[name])["properties"][-3:]
    assert [verdict["property"] for verdict in (in_c, loop, in_cif)] == TRANSLATIONS
    assert [(verdict["outcome"], verdict["explanation"]) for verdict in (in_c, in_cif)] == [("proved", None)] * 2
    assert (loop["outcome"] in {"proved", "sampled"}, loop["explanation"]) == (True, None)
    assert in_c["evidence"].startswith(f"{models_of(name).sct.supervisor.controlledStates:,} states, ")


@settings(max_examples=examples(6), suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(sct_models(requirements=True))
def test_random_models_are_translated_faithfully(made: sct.SupervisoryControlModel) -> None:
    if supervised(made).supervisor is None:
        made.supervisor = sct.Supervisor(
            guards=[
                sct.EventGuard(event=event) for plant in made.plants for event in plant.events if event.controllable
            ]
        )
    in_c, _, in_cif = validate(Models(made), Configuration())
    assert [(verdict.outcome, verdict.explanation) for verdict in (in_c, in_cif)] == [(Outcome.PROVED, "")] * 2


@pytest.mark.parametrize("corner", [corner for corner in corners.ALL if corner is not corners.wide])
def test_corners_are_translated_faithfully(corner) -> None:
    made = corner()
    assert validate_c(made, c_of(made)).outcome is Outcome.PROVED


C_MUTANTS = {
    "a requirement is weaker": (
        r"component_Gauge_level < 3U?\b",
        "component_Gauge_level <= 3",
        ["message_level.u_response(i_response = 3)"],
        (
            "`message_move.c_trigger` can happen in the generated C and not in the model"
            " where `Gauge.metering and Gauge.level = 3`"
        ),
    ),
    "a guard is flipped": (
        r"component_Gauge_level > 2U?\b",
        "component_Gauge_level <= 2",
        ["message_level.u_response(i_response = -5)"],
        (
            "`component_Gauge.c_tau1` can happen in the generated C and not in the model"
            " where `Gauge.metering and Gauge.level = -3`"
        ),
    ),
    "what synthesis added is weaker": (
        r"component_Pump_strokes <= 1U?\b",
        "component_Pump_strokes <= 2",
        ["component_Pump.c_tau1", "component_Pump.c_tau2"] * 2,
        (
            "`component_Pump.c_tau1` can happen in the generated C and not in the model"
            " where `Pump.rest and Pump.strokes = 2`"
        ),
    ),
    "a target is swapped": (
        r"(state->component_Gauge = pump_component_Gauge_)idle;$",
        r"\1metering;",
        ["message_level.u_response(i_response = 3)"],
        (
            "after `component_Gauge.c_tau1`, the generated C has `Gauge.metering` and the model `Gauge.idle`"
            " where `Gauge.metering and Gauge.level = 3`"
        ),
    ),
    "an update is dropped": (
        r"state->component_Pump_strokes = .*;$",
        "",
        [],
        (
            "after `component_Pump.c_tau1`, the generated C has `Pump.strokes = 0` and the model `Pump.strokes = 1`"
            " where `Pump.rest and Pump.strokes = 0`"
        ),
    ),
    "a value saturates elsewhere": (
        r"(inputs->message_level_i_response, -3, )4(\);\n *\} else)",
        r"\g<1>9\2",
        [],
        (
            "after `message_level.u_response(i_response = 5)`, the generated C has `Gauge.level = 5` and the model"
            " `Gauge.level = 4` where `Gauge.idle and Gauge.level = 0`"
        ),
    ),
    "the start is another": (
        r"self->state.component_Gauge_level = 0;",
        "self->state.component_Gauge_level = -1;",
        [],
        "at the start the generated C has `Gauge.level = -1` and the model `Gauge.level = 0`",
    ),
    "an event has another name": (
        r'"message_move.c_trigger"',
        '"message_move.c_triger"',
        [],
        "the generated C has no event `message_move.c_trigger`",
    ),
}


@pytest.mark.parametrize(("pattern", "replacement", "trace", "explanation"), C_MUTANTS.values(), ids=C_MUTANTS)
def test_changed_c_is_refuted(pattern: str, replacement: str, trace: list[str], explanation: str) -> None:
    verdict = with_changed_c(pattern, replacement)
    assert (verdict.outcome, verdict.explanation) == (Outcome.REFUTED, explanation)
    assert [str(step) for step in verdict.trace] == trace


def test_c_that_changes_something_when_asked_in_vain_is_refuted() -> None:
    broken = "    if (event == pump_component_Gauge_c_tau1) { self->state.component_Pump_strokes = 1; }\n"
    verdict = with_changed_c(r"^(bool pump_perform\(.*\n\{\n)", rf"\1{broken}")
    assert verdict.explanation.startswith(
        "after `component_Gauge.c_tau1`, which can not happen, the generated C has `Pump.strokes = 1`"
    )
    refusing = with_changed_c(r"^(bool pump_perform\(.*\n\{\n)", r"\1    (void)self; (void)event; return false;\n")
    assert "is enabled but does not happen in the generated C" in refusing.explanation


def test_c_that_is_none_is_refuted() -> None:
    verdict = with_changed_c(r"^bool pump_enabled\(.*$", "bool pump_enabled(")
    assert verdict.outcome is Outcome.REFUTED
    assert re.match(r"\w+ does not compile the generated C: pump_supervisor.c:\d+:\d+: error: ", verdict.explanation)


def test_c_that_crashes_is_refuted() -> None:
    verdict = with_changed_c(r"^(bool pump_perform\(.*\n\{\n)", r"\1    (void)*(volatile char *)0;\n")
    assert verdict.explanation.startswith("the generated C ends with status -")


def test_too_many_states_are_sampled() -> None:
    few = Effort(states=44, walk=1000)
    made = pump()
    verdict = validate_c(made, c_of(made), few)
    assert (verdict.outcome, verdict.evidence) == (Outcome.SAMPLED, "1,000 random steps")
    pattern, replacement, _, explanation = C_MUTANTS["what synthesis added is weaker"]
    found = with_changed_c(pattern, replacement, few)
    assert (found.outcome, found.explanation) == (Outcome.REFUTED, explanation)


def test_the_explorer_gives_up_by_itself() -> None:
    made = pump()
    made.supervisor.controlledStates = 1
    for effort in (Effort(states=44, walk=1000), Effort(steps=500, walk=1000)):
        assert validate_c(made, c_of(made), effort).outcome is Outcome.SAMPLED


def test_too_many_values_are_sampled() -> None:
    made = pump()
    made.plants[0].inputs[0].type.maximum = 2**31 - 1
    made = supervised(made)
    assert validate_c(made, c_of(made)).outcome is Outcome.SAMPLED
    files = c_of(made)
    wrong = changed(
        files["pump_supervisor.c"], r"(inputs->message_level_i_response, -3, )4(\);\n *\} else)", r"\g<1>3\2"
    )
    found = validate_c(made, {**files, "pump_supervisor.c": wrong})
    assert "the generated C has `Gauge.level = 3` and the model `Gauge.level = 4`" in found.explanation


def test_without_a_compiler_c_is_skipped(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    made = pump()
    verdict = validate_c(made, c_of(made))
    assert (verdict.outcome, verdict.explanation) == (
        Outcome.SKIPPED,
        "no C compiler found (cc, gcc, clang)",
    )


@pytest.mark.parametrize(
    "said", ["ld: final link failed: No space left on device", "gcc: fatal error: Killed signal terminated program cc1"]
)
def test_without_room_for_the_compiler_c_is_skipped(said: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "cc").write_text(f"#!/bin/sh\necho '{said}' >&2\nexit 1\n")
    (tmp_path / "cc").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    made = pump()
    verdict = validate_c(made, c_of(made))
    assert (verdict.outcome, said in verdict.explanation) == (Outcome.SKIPPED, True)


def test_without_a_folder_for_temporary_files_c_is_skipped(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    made = pump()
    verdict = validate_c(made, c_of(made))
    assert (verdict.outcome, "No such file or directory" in verdict.explanation) == (Outcome.SKIPPED, True)


def test_what_cannot_be_generated_is_skipped() -> None:
    made = pump()
    made.plants[2].variables[0].type.minimum = -1
    made.plants[2].variables[0].type.maximum = 2**31 - 2
    verdicts = validate(Models(supervised(made)), Configuration())
    assert verdicts[-1].outcome is Outcome.SKIPPED
    assert "CIF cannot express this" in verdicts[-1].explanation


IN_MODEL = "can happen in the model and not in the generated CIF"
IN_CIF = "can happen in the generated CIF and not in the model"
NEVER_REACHED = "in a state that the robot never reaches"
CIF_MUTANTS = {
    "a requirement is weaker": (
        r"level < 6",
        "level <= 6",
        ["message_level.u_response(i_response = 3)"],
        f"`message_move.c_trigger` {IN_CIF} where `Gauge.metering and Gauge.level = 3`",
    ),
    "a requirement is dropped": (
        r"^supervisor invariant .*;$",
        "",
        [],
        f"`message_move.c_trigger` {IN_CIF} where `Gauge.idle and Gauge.level = 0`",
    ),
    "a requirement is turned round": (
        r"^supervisor invariant (\S+) needs (.*);$",
        r"supervisor invariant \2 disables \1;",
        [],
        f"`message_move.c_trigger` {IN_CIF} where `Gauge.idle and Gauge.level = 0`",
    ),
    "a self-loop is dropped": (
        r"^    edge c_tau2;\n",
        "",
        [],
        f"`component_Pump.c_tau2` {IN_MODEL} where `Pump.rest and Pump.strokes = 0`",
    ),
    "a self-loop of the supervisor is dropped": (
        r"^    edge component_Pump.c_tau2;\n",
        "",
        [],
        f"`component_Pump.c_tau2` {IN_MODEL} where `Pump.rest and Pump.strokes = 0`",
    ),
    "a requirement is left": (
        r"^supervisor invariant",
        r"requirement component_Pump.c_tau2 needs component_Pump.run;\n\g<0>",
        [],
        f"`component_Pump.c_tau2` {IN_MODEL} where `Pump.rest and Pump.strokes = 0`",
    ),
    "what synthesis added is weaker": (
        r"component_Pump.strokes <= 1;",
        "component_Pump.strokes <= 2;",
        ["component_Pump.c_tau1", "component_Pump.c_tau2"] * 2,
        f"`component_Pump.c_tau1` {IN_CIF} where `Pump.rest and Pump.strokes = 2`",
    ),
    "a target is swapped": (
        r" goto idle;",
        ";",
        ["message_level.u_response(i_response = 3)"],
        (
            "after `component_Gauge.c_tau1`, the generated CIF has `Gauge.metering` and the model `Gauge.idle`"
            " where `Gauge.metering and Gauge.level = 3`"
        ),
    ),
    "an update is dropped": (
        r" do level := 3 goto idle;",
        " goto idle;",
        ["message_level.u_response(i_response = 3)"],
        (
            "after `component_Gauge.c_tau1`, the generated CIF has `Gauge.level = 3` and the model `Gauge.level = 0`"
            " where `Gauge.metering and Gauge.level = 3`"
        ),
    ),
    "a shift is forgotten": (
        r"i_response < 2: 2(\s+else)",
        r"i_response < 2: 5\1",
        [],
        (
            "after `message_level.u_response(i_response = -5)`, the generated CIF has `Gauge.level = 0` and the model"
            " `Gauge.level = -3` where `Gauge.idle and Gauge.level = 0`"
        ),
    ),
    "a value is outside of its range": (
        r"message_level.i_response > 9: 9(\s+elif)",
        r"message_level.i_response > 9: 10\1",
        [],
        f"`message_level.u_response(i_response = 5)` {IN_MODEL} where `Gauge.idle and Gauge.level = 0`",
    ),
    "a guard changes where nothing leads": (
        r" when strokes != 3 goto rest;",
        " goto rest;",
        [],
        f"`component_Pump.c_tau2` {IN_CIF} where `Pump.run and Pump.strokes = 3`, {NEVER_REACHED}",
    ),
    "the start is another": (
        r"(disc int\[0\.\.7\] level = )3;",
        r"\g<1>0;",
        [],
        "at the start the generated CIF has `Gauge.level = -3` and the model `Gauge.level = 0`",
    ),
}


@pytest.mark.parametrize(("pattern", "replacement", "trace", "explanation"), CIF_MUTANTS.values(), ids=CIF_MUTANTS)
def test_changed_cif_is_refuted(pattern: str, replacement: str, trace: list[str], explanation: str) -> None:
    verdict = with_changed_cif(pattern, replacement)
    assert (verdict.outcome, verdict.explanation) == (Outcome.REFUTED, explanation)
    assert [str(step) for step in verdict.trace] == trace


@pytest.mark.parametrize(
    ("pattern", "replacement", "wrong"),
    [
        (
            r"^  uncontrollable u_response;",
            "  controllable u_response;",
            "it has 'u_response' of 'message_level' controllable",
        ),
        (r"^  location metering:\n", r"\g<0>    marked;\n", "'metering' of 'component_Gauge' is marked in it"),
        (r"int\[0\.\.3\] strokes", "int[0..4] strokes", "the values of 'strokes' of 'component_Pump' are others"),
        (
            r"int\[0\.\.3\] strokes = 0",
            "int[1..4] strokes = 1",
            "the values of 'strokes' of 'component_Pump' are others",
        ),
        (r"^  disc .* strokes", "  disc bool strokes", "'strokes' is bool and its initial value int[0..0]"),
        (r"^plant message_level(?s:.*?)^end", "", "there is no 'message_level.u_response'"),
        (
            r"^end\n\nsupervisor inv",
            "end plant x: location: initial; end supervisor inv",
            "its plants are message_level, message_move",
        ),
        (
            r"^  location run:",
            "  location more; location run:",
            "its locations of 'component_Pump' are rest, more, run, not",
        ),
        (
            r"component_Gauge:(?s:(.*?)  location idle):",
            r"component_Gauge:\1  location metering_:",
            "there is no 'idle'",
        ),
        (r"goto rest;", "goto nowhere;", "there is no 'nowhere'"),
        (r"goto rest;", "goto strokes;", "'strokes' is not a location of 'component_Pump'"),
        (r"strokes != 3", "c_tau1 != 3", "'c_tau1' has no value"),
        (r"^    edge c_tau2;", "    edge strokes;", "'strokes' is not an event"),
        (r"do level := 3", "do idle := 3", "'idle' is not a variable"),
        (
            r"^    edge c_tau2;",
            "    edge c_tau2; edge c_tau2;",
            "two edges for component_Pump.c_tau2 are enabled at once",
        ),
        (
            r"(alphabet .*), component_Pump.c_tau2;",
            r"\1;",
            "'component_Pump.c_tau2' is not in the alphabet of 'sup'",
        ),
        (
            r"^  controllable c_tau2;",
            "  controllable c_tau1;",
            "the name 'c_tau1' is declared twice",
        ),
        (r"goto rest;", "goto rest", "Expected ';'"),
    ],
)
def test_cif_that_is_another_system_is_refuted(pattern: str, replacement: str, wrong: str) -> None:
    verdict = with_changed_cif(pattern, replacement)
    assert verdict.outcome is Outcome.REFUTED
    assert re.match(rf"the generated CIF is wrong: (line \d+, column \d+: )?{re.escape(wrong)}", verdict.explanation)


@pytest.mark.parametrize(("opening", "closing"), [("(", ")"), ("not ", ""), ("if true: ", " else true end")])
def test_cif_is_compared_however_deep_it_is_nested(opening: str, closing: str) -> None:
    def nested(levels: int) -> Verdict:
        condition = f"{opening * levels}true{closing * levels}"
        return with_changed_cif(
            r"^    edge component_Pump.c_tau2;", f"    edge component_Pump.c_tau2 when {condition};"
        )

    assert nested(50).outcome is Outcome.PROVED
    assert nested(2_000).outcome is Outcome.PROVED


def chosen() -> sct.SupervisoryControlModel:
    """Return data chosen by a state, under a supervisor."""
    given = model(
        [
            plant("message_go", {"ready": [edge("c_trigger")]}, kind="message", controllable=["c_trigger"]),
            plant(
                "data_go",
                {"none": (), "d1": (), "d2": ()},
                everywhere=[
                    edge("c_d1", "d1", when="door.open"),
                    edge("c_d2", "d2", when="door.shut and not door.locked"),
                    edge("c_none", "none", when="not door.open and not door.shut"),
                ],
                controllable=["c_d1", "c_d2", "c_none"],
                kind="data",
                marked=["none", "d1", "d2"],
                origin="Door.go",
            ),
            plant(
                "door",
                {
                    "shut": [edge("moved", "open"), edge("turned", do={"locked": "not locked"})],
                    "open": [edge("moved", "shut"), edge("turned")],
                    "torn": [edge("moved")],
                },
                uncontrollable=["moved", "turned"],
                variables={"locked": "bool"},
                origin="Door",
            ),
        ],
        [needs("message_go.c_trigger", "door.shut"), disables("message_go.c_trigger", "door.locked")],
        name="Chosen",
    )
    return supervised(given)


IN_MODEL_FILE = "can happen in the generated CIF without supervisor and not in the model"
MISSING_THERE = "can happen in the model and not in the generated CIF without supervisor"
BOTH, MODEL_FILE = ("cif", "supervised.cif"), ("cif",)
#: Mutants: the files, the change, the shortest trace, and the message, in which FILE is a placeholder for the file.
CHOSEN_MUTANTS = {
    "a requirement is weaker": (
        MODEL_FILE,
        r"^requirement (\S+) needs door.shut;$",
        r"requirement \1 needs door.shut or door.open;",
        ["door.moved"],
        f"by the requirements `message_go.c_trigger` {IN_MODEL_FILE} where `Door.open and !Door.locked`",
    ),
    "a requirement is dropped": (
        MODEL_FILE,
        r"^requirement .* disables .*;$",
        "",
        ["door.turned"],
        f"by the requirements `message_go.c_trigger` {IN_MODEL_FILE} where `Door.shut and Door.locked`",
    ),
    "a requirement is turned round": (
        MODEL_FILE,
        r"^requirement (\S+) needs (.*);$",
        r"requirement \2 disables \1;",
        [],
        f"by the requirements `message_go.c_trigger` {MISSING_THERE} where `Door.shut and !Door.locked`",
    ),
    "a requirement is the plant's": (
        MODEL_FILE,
        r"^requirement (\S+) needs door.shut;$",
        r"plant invariant \1 needs door.shut;",
        [],
        "the generated CIF without supervisor is wrong: it has statements of a supervisor",
    ),
    "a requirement asks of another event": (
        MODEL_FILE,
        r"^requirement \S+ needs door.shut;$",
        "requirement door.turned needs door.shut;",
        ["door.moved"],
        f"by the requirements `message_go.c_trigger` {IN_MODEL_FILE} where `Door.open and !Door.locked`",
    ),
    "a target is swapped": (
        MODEL_FILE,
        r"^    edge moved goto shut;$",
        "    edge moved;",
        ["door.moved"],
        (
            "after `door.moved`, the generated CIF without supervisor has `Door.open` and the model `Door.shut`"
            " where `Door.open`"
        ),
    ),
    "a choice has another number": (
        BOTH,
        r"do choice := 1;",
        "do choice := 2;",
        ["door.moved"],
        ("after `data_go.c_d1`, FILE has `Door.go.d2` and the model `Door.go.d1`"),
    ),
    "a choice is guarded otherwise": (
        BOTH,
        r"edge c_d2 when door.shut and not door.locked",
        "edge c_d2 when door.shut",
        ["door.turned"],
        "`data_go.c_d2` can happen in FILE and not in the model",
    ),
    "another choice at the start": (BOTH, r"choice = 0;", "choice = 1;", [], "at the start FILE has"),
    "more choices": (
        BOTH,
        r"int\[0\.\.2\] choice",
        "int[0..3] choice",
        [],
        "FILE is wrong: the values of 'choice' of 'data_go' are not the numbers of 3 locations",
    ),
    "a choice is not marked": (
        BOTH,
        r"(choice = 0;\n\n  location:\n    initial;) marked;",
        r"\1",
        [],
        "FILE is wrong: 'none' of 'data_go' is not marked in it",
    ),
}


@pytest.mark.parametrize(
    ("kind", "pattern", "replacement", "trace", "explanation"),
    [(kind, *mutant) for kinds, *mutant in CHOSEN_MUTANTS.values() for kind in kinds],
    ids=[f"{name}-{kind}" for name, (kinds, *_) in CHOSEN_MUTANTS.items() for kind in kinds],
)
def test_either_file_of_cif_is_compared(
    kind: str, pattern: str, replacement: str, trace: list[str], explanation: str
) -> None:
    made = chosen()
    files, name = cif_of(made), f"Chosen.{kind}"
    verdict = validate_cif(made, files)
    assert (verdict.outcome, verdict.evidence) == (Outcome.PROVED, "6 events in both files, each in every state")
    verdict = validate_cif(made, {**files, name: changed(files[name], pattern, replacement)})
    file = "the generated CIF" if kind == "supervised.cif" else "the generated CIF without supervisor"
    assert verdict.outcome is Outcome.REFUTED
    assert verdict.explanation.startswith(explanation.replace("FILE", file))
    assert [str(step) for step in verdict.trace] == trace
