"""Each construct of the second edition, as C and as CIF: `verify` refutes every wrong translation."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.analysis.verify import validate_c, validate_cif, validate_loop
from robosc.analysis.verify.verdict import Outcome
from robosc.language.configuration import Configuration
from robosc.m2t import cif, supervisor
from robosc.m2t.models import Models

if TYPE_CHECKING:
    from robosc.model import sct

pytestmark = pytest.mark.slow

CIF = {
    "several transitions on one event": (
        r"when not \((message_Front_seen.i_response = 2)\)\n( *and message_Front_seen.i_response)",
        r"when \1\n\2",
    ),
    "what is left where none holds": (r"    edge message_scan.u_response when not message_scan.i_response_c2;\n", ""),
    "what the node computes": (r"when message_scan.i_response_c1 and", "when message_scan.i_response_c2 and"),
    "an argument of an instance": (r"(plant component_Rear:\n  disc int\[0..2\] count =) 1", r"\1 0"),
    "all of the instances": (r"component_Front.clear and component_Rear.clear", "component_Front.clear or true"),
    "a count of instances": (r"component_Rear.count > 0: false", "component_Rear.count > 0: true"),
    "a function": (r"if message_level.i_response > 1: 1 else 0 end;", "0;"),
    "a condition": (r"not \(component_Battery.charge <= 1\) goto", "not (component_Battery.charge <= 2) goto"),
    "mod": (r"component_Battery.charge \+ component_Front.count != 3", "component_Battery.charge != 3"),
    "abs": (
        r"component_Rear.count <= component_Battery.charge \+ 1",
        "component_Rear.count <= component_Battery.charge",
    ),
    "max": (
        r"elif component_Rear.count > component_Front.count: component_Battery",
        "elif component_Rear.count < component_Front.count: component_Battery",
    ),
    "a time": (r"    edge u_after1 goto far;\n", ""),
    "a silence in every state": (r"    edge u_after2;\n", ""),
    "after each": (r"edge message_halt.c_trigger goto waiting", "edge message_halt.c_trigger"),
    "at most": (r"requirement_2.count < 2", "requirement_2.count <= 2"),
    "since": (r"    edge message_move.c_trigger do count := 0;\n", "    edge message_move.c_trigger;\n"),
    "a transition of an automaton": (r"edge service_dock.c_trigger goto yours", "edge service_dock.c_trigger"),
    "what an automaton forbids of what comes": (r"requirement service_dock.u_error needs requirement_Turns.yours;", ""),
    "never": (r"invariant not \(component_Base.moving and", "invariant not (component_Base.still and"),
}
C = {
    "several transitions on one event": (
        r"Front_clear && inputs->message_Front_seen_i_response == 2U",
        "Front_clear && inputs->message_Front_seen_i_response >= 1U",
    ),
    "what the node computes": (r"far && inputs->message_scan_i_response_c1 (.*\n *state->)", r"far && true \1"),
    "an argument of an instance": (r"component_Rear_count = 1;", "component_Rear_count = 0;"),
    "all of the instances": (
        r"component_Front_clear && (state->component_Rear == gate_)",
        r"component_Front_clear || \1",
    ),
    "a count of instances": (r"component_Rear_count > 0U \? \(int32_t\)1", "component_Rear_count > 0U ? (int32_t)0"),
    "a function": (r"message_level_i_response - 1\)", "message_level_i_response)"),
    "a condition": (r"yours && state->component_Battery_charge > 1U", "yours && state->component_Battery_charge > 0U"),
    "mod": (r"% 3 > 0", "% 2 > 0"),
    "abs": (r"component_Battery_charge\)\) <= 1$", "component_Battery_charge)) <= 2"),
    "max": (
        r"component_Rear_count > state->component_Front_count",
        "component_Rear_count < state->component_Front_count",
    ),
    "a time": (r"(case gate_component_Eye_u_after1:\n        return )state.*;", r"\1true;"),
    "after each": (r"state->requirement_1 = gate_requirement_1_waiting;\n        break", "break"),
    "at most": (r"requirement_2_count < 2U", "requirement_2_count <= 2U"),
    "since": (r"        state->requirement_2_count = 0;\n", ""),
    "a transition of an automaton": (r"state->requirement_Turns = gate_requirement_Turns_yours;", ""),
    "never": (r"            && state->component_Base == gate_component_Base_still /\* added", "/*"),
}
#: Faults in the control loop.
TIMES = {
    "a time's length": (r"^    2000U,$", "    2001U,"),
    "a time that starts anew": (
        r"(case gate_component_Eye_u_after2:(?:\n.*){5}\n)            begin_time\(self, 0U\);\n",
        r"\1",
    ),
    "the silence of a message": (r"        begin_time\(self, 1U\);\n        break;", "        break;"),
}


@pytest.fixture(scope="module")
def gate() -> sct.SupervisoryControlModel:
    model = robosc.to_sct(robosc.load(Path(__file__).with_name("gate.rscd")))
    robosc.synthesize(model)
    return model


def _changed(text: str, pattern: str, replacement: str) -> str:
    made, count = re.subn(pattern, replacement, text, flags=re.MULTILINE)
    assert count == 1, f"{pattern} is there {count} times"
    return made


@pytest.mark.parametrize("construct", CIF)
def test_cif_that_says_it_otherwise_is_refuted(gate: sct.SupervisoryControlModel, construct: str) -> None:
    files = cif.generate(Models(gate), Configuration())
    assert validate_cif(gate, files).outcome is Outcome.PROVED
    spoiled = {**files, "Gate.cif": _changed(files["Gate.cif"], *CIF[construct])}
    assert validate_cif(gate, spoiled).outcome is Outcome.REFUTED


def _spoiled_c(gate: sct.SupervisoryControlModel, pattern: str, replacement: str) -> dict[str, str]:
    files = supervisor.generate(Models(gate), Configuration())
    return {**files, "gate_supervisor.c": _changed(files["gate_supervisor.c"], pattern, replacement)}


@pytest.mark.build
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
@pytest.mark.parametrize("construct", C)
def test_c_that_does_it_otherwise_is_refuted(gate: sct.SupervisoryControlModel, construct: str) -> None:
    verdict = validate_c(gate, _spoiled_c(gate, *C[construct]))
    assert verdict.outcome is Outcome.REFUTED
    assert re.search("in the generated C and not in the model|the generated C has `", verdict.explanation)


@pytest.mark.build
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
@pytest.mark.parametrize("construct", TIMES)
def test_times_in_c_that_are_others_are_refuted(gate: sct.SupervisoryControlModel, construct: str) -> None:
    verdict = validate_loop(gate, _spoiled_c(gate, *TIMES[construct]))
    assert verdict.outcome is Outcome.REFUTED
    assert "control loop of the generated C" in verdict.explanation


@pytest.mark.build
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
def test_c_as_it_is_made_is_proved(gate: sct.SupervisoryControlModel) -> None:
    files = supervisor.generate(Models(gate), Configuration())
    assert validate_c(gate, files).outcome is Outcome.PROVED
    assert validate_loop(gate, files).outcome in {Outcome.PROVED, Outcome.SAMPLED}
