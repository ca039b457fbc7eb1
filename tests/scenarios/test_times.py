"""`after` in all views of a model: each test holds a sentence of the language's page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from jsonschema import Draft202012Validator

import robosc
from robosc.analysis.verify import validate_loop
from robosc.analysis.verify.verdict import Outcome
from robosc.analysis.wording import words
from robosc.base.files.json_reading import json_value
from robosc.base.files.resources import locate
from robosc.language.configuration import Configuration, ControlLoop
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.m2m.sct_to_engine import transform
from robosc.m2t import cif
from robosc.m2t.c import engine
from robosc.m2t.models import Models
from robosc.model import sct, xmi
from robosc.model.semantics.definition import definition
from robosc.model.validity import load

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

GATE = """\
robot Gate {
  component Eye {
    outgoing message seen with identifier: "/seen", type: none
  }
  component Door {
    incoming message open with identifier: "/open", type: none
    incoming message shut with identifier: "/shut", type: none

    behaviour {
      initial marked state closed {
        on request to open goto opened
      }
      state opened {
        after 3.0 s goto waiting
        after 500 ms without seen goto waiting
        on request to shut goto closed
      }
      state waiting {
        on response from seen goto opened
        on request to shut goto closed
      }
    }
  }
  requirement shut needs Door.waiting
}
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    found = tmp_path / "gate.rscd"
    found.write_text(GATE)
    return found


@pytest.fixture
def model(path: Path) -> sct.SupervisoryControlModel:
    made = robosc.to_sct(robosc.load(path))
    robosc.synthesize(made)
    return made


def timeouts(model: sct.SupervisoryControlModel) -> Iterator[sct.Event]:
    return (event for plant in model.plants for event in plant.events if event.timer is not None)


def test_to_synthesis_it_is_an_uncontrollable_event(model: sct.SupervisoryControlModel) -> None:
    """To synthesis an `after` is an uncontrollable event `component_X.u_after1…` (text order)."""
    found = list(timeouts(model))
    assert [(event.name, event.controllable, event.kind.name) for event in found] == [
        ("u_after1", False, "timeout"),
        ("u_after2", False, "timeout"),
    ]


def test_it_is_possible_while_its_state_lasts(model: sct.SupervisoryControlModel) -> None:
    """Possible at any time while its state lasts, and nowhere else."""
    where = {
        edge.event.name: location.name
        for location in model.plants[3].locations
        for edge in location.edges
        if edge.event.timer is not None
    }
    assert where == {"u_after1": "opened", "u_after2": "opened"}
    assert [words(event) for event in timeouts(model)] == [
        "timeout of `Door` after 3 s in line 14",
        "timeout of `Door` after 500 ms without Eye.seen in line 15",
    ]


def test_what_is_proven_holds_for_all_durations(path: Path, model: sct.SupervisoryControlModel) -> None:
    """Two models that differ in durations only have the same supervisor."""
    path.write_text(GATE.replace("3.0 s", "2 min").replace("500 ms", "1 ms"))
    other = robosc.to_sct(robosc.load(path))
    robosc.synthesize(other)
    assert model.supervisor is not None
    assert other.supervisor is not None
    assert other.supervisor.controlledStates == model.supervisor.controlledStates == 3
    assert (
        cif.generate(Models(other), Configuration())["Gate.cif"]
        .replace("2 min", "3 s")
        .replace("after 1 ms", "after 500 ms")
        == (cif.generate(Models(model), Configuration())["Gate.cif"])
    )


def test_cif_has_a_plain_uncontrollable_event(model: sct.SupervisoryControlModel) -> None:
    text = cif.generate(Models(model), Configuration())["Gate.cif"]
    assert "uncontrollable u_after1;" in text
    assert "edge u_after1 goto waiting;" in text


def test_the_layout_keeps_it() -> None:
    formatted, findings = format_text(Text("gate.rscd", GATE.replace("after 3.0 s goto", "after\n3.0   s\ngoto")))
    assert (formatted, findings) == (GATE, [])


def test_a_saved_model_is_the_same(model: sct.SupervisoryControlModel, tmp_path: Path) -> None:
    file = tmp_path / "Gate.sct.xmi"
    file.write_text(xmi.to_texts({"Gate.sct.xmi": model})["Gate.sct.xmi"])
    assert engine.generate(transform(load(file)), ControlLoop()) == engine.generate(transform(model), ControlLoop())


def test_the_definition_tells_the_time(path: Path) -> None:
    robot = robosc.load(path)
    robosc.synthesize(robosc.to_sct(robot))
    told = definition(robosc.to_rosgraph(robot))
    steps = [step for component in told["components"] for step in component["transitions"] if "after" in step]
    assert [step["after"] for step in steps] == ["3 s", "500 ms without Eye.seen"]
    schema = json_value(locate("robosc/schemas/definition.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(told)


#: What is wrong with the times of a generated engine.
MUTANTS = [
    ("    500U", "    501U"),
    (
        "leave(self, 1U);",
        "",
    ),
    ("begin_time(self, 1U);", ""),
    ("    if (back) {", "    if (!back) {"),
    ("left < HALF", "left > HALF"),
]


@pytest.mark.build
@pytest.mark.parametrize("mutant", MUTANTS, ids=range(len(MUTANTS)))
def test_verify_catches_a_wrong_time_in_c(model: sct.SupervisoryControlModel, mutant: tuple[str, str]) -> None:
    files = engine.generate(transform(model), ControlLoop())
    assert validate_loop(model, files).outcome is not Outcome.REFUTED
    spoiled = {name: text.replace(*mutant) for name, text in files.items()}
    assert spoiled != files
    assert validate_loop(model, spoiled).outcome is Outcome.REFUTED
