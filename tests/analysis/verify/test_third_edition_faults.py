"""Seeded faults in the third edition: each is found by a row of `verify`, or by a test of the node or of the language.

`FAULTS` has the faults that a row refutes. `OUTSIDE` has those in parts that docs/verify.md lists as trusted: the
reading of the text, and the node around the control loop. It names the test that fails.

One pass instead of all in the inner fixpoint of synthesis, `keep_alive`, is no fault: the rounds around it repeat it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

from robosc.analysis.verify import (
    Outcome,
    Verdict,
    validate_c,
    validate_cif,
    validate_controller,
    validate_model,
    verify_system,
)
from robosc.language.configuration import Configuration
from robosc.m2t import cif, supervisor
from tests.analysis.verify.commands import models_of
from tests.analysis.verify.seeding import seed
from tests.analysis.verify.third_edition import ROBOTS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2t.models import Models

ROOT = Path(__file__).parents[3]
_PLANTS, _EXPRESSIONS, _DECLARATIONS = "m2m.robosc_to_sct", "m2m.expressions", "m2m.declarations"
_INSTANCES, _EXPANSION = "model.semantics.instances", "model.semantics.expansion"
_STORED, _INPUTS = "model.semantics.state_values", "model.semantics.inputs"
_GUARDS, _REASONS = "m2m.sct_to_engine.combine_guards", "m2m.sct_to_engine.name_reasons"
_CIF, _CIF_TEXT, _C = "m2m.sct_to_cif", "m2t.cif.specification", "m2t.c.engine"
_FIXPOINT, _COMPOSER = "synthesis.fixpoint", "run.runtime.core.composer"
_MODEL, _CONTROLLER, _TO_C, _TO_CIF = "model-translation", "controller-translation", "c-translation", "cif-translation"


class Fault(NamedTuple):
    """A changed text of a module, the robot that shows it, the row that refutes it, and a part of its explanation."""

    module: str
    before: str
    after: str
    robot: str
    row: str
    said: str


_ASSUMED_GUARD = "_edge(location, event, location).guard = self.expressions(assumption.condition, within)"
_COPIES = "else self.of(definition.template)\n        return [self"
_GUARD_PARTS = "junction(engine.And, others), junction(engine.And, assumed), s"
_DECLARED = "        return declared.minimum, declared.maximum"
_OF_ARRAYS = "splits = is_condition and isinstance(part, ex.Conjunction)"
_MISSING_ARRAY = "the plants have no input for a value computed from an array that may be missing"

FAULTS: Mapping[str, Fault] = {
    # Assumptions
    "the condition of an assumption is negated": Fault(
        *(_PLANTS, _ASSUMED_GUARD, _ASSUMED_GUARD.replace("self.", "ex.Negation(operand=self.") + ")", "Assumed"),
        *(_MODEL, "response from `Unit1.closed` can happen in the plants, and not by the text (line 21)"),
    ),
    "an assumption is about the first event of its set": Fault(
        *(_PLANTS, "for event in assumption.target.events):", "for event in assumption.target.events[:1]):"),
        *("Assumed", _MODEL, "response from `Unit1.closed` can happen in the plants, and not by the text (line 21)"),
    ),
    "an assumption with `each` misses an instance": Fault(
        *(_INSTANCES, _COPIES, _COPIES.replace("template)", "template)[:-1]"), "Assumed"),
        *(_MODEL, "`3` (line 22) is only in the text"),
    ),
    "the guards of the controller lack the assumptions": Fault(
        *(_GUARDS, _GUARD_PARTS, _GUARD_PARTS.replace("assumed", "[]"), "Assumed"),
        *(_TO_C, "`message_Unit1_opened.u_response` can happen in the generated C and not in the model"),
    ),
    "an assumption counts as a plant": Fault(
        *(_GUARDS, _GUARD_PARTS, "junction(engine.And, [*others, *assumed]), junction(engine.And, []), s", "Assumed"),
        *(_CONTROLLER, "response from `Unit1.opened` violates an assumption by the text, and its guard in the contr"),
    ),
    "an event violates an assumption whose condition holds": Fault(
        *(_REASONS, "lower.terms.opposite(holds), assumption_text", "holds, assumption_text", "Assumed"),
        *(_CONTROLLER, "response from `Unit1.opened` violates the assumption (line 21) by the text, and not in the"),
    ),
    "a violation is that of the first assumption": Fault(
        *(_REASONS, "reason.assumption = plant\n"),
        "reason.assumption = next(own for own in possible if own.kind == sct.PlantKind.assumption)\n",
        *("Assumed", _CONTROLLER, "response from `Unit1.opened` violates the assumption (line 21) by the text, and"),
    ),
    "no event violates an assumption": Fault(
        *(_REASONS, "element.reasons.extend(_of_assumptions(guards[event].by_plant, lower))", "pass", "Assumed"),
        *(_CONTROLLER, "response from `Unit1.opened` violates the assumption (line 21) by the text, and not in the"),
    ),
    "the C confuses the assumptions": Fault(
        *(_C, "(number[reason.assumption], self", "(len(plants) - 1 - number[reason.assumption], self", "Assumed"),
        *(_TO_C, "`message_Unit1_opened.u_response` violates `assume A1[Unit1]: { Unit1.opened, Unit1.closed } needs"),
    ),
    "in the C, an event that is not possible violates assumptions": Fault(
        *(_C, "possible = None if event.guard.plants is None else self._printer.lines(event.guard.plants)"),
        *("possible = None", "Assumed", _TO_C, 'violates `assume A2 "one after the other": { response from Unit1.move'),
    ),
    "the CIF lacks the plants of assumptions": Fault(
        *(_CIF, "model.plants.extend(map(self._plant, self._model.plants))"),
        "model.plants.extend(own for own in map(self._plant, self._model.plants) if own.kind.name != 'assumption')",
        *("Assumed", _TO_CIF, "the generated CIF without supervisor is wrong: its plants are message_Unit1_opened"),
    ),
    # Fleets and `each`
    "the number of an instance is one more": Fault(
        *(_INSTANCES, "own = {component.number: literal(number)}", "own = {component.number: literal(number + 1)}"),
        *("Assumed", _CONTROLLER, "`Unit1.opened` is `/unit1/opened` in ROS by the text, and `/unit2/opened` in the"),
    ),
    "a fleet misses its last instance": Fault(
        *(_INSTANCES, "return range(first, last + 1)", "return range(first, last)", "Shared"),
        *(_MODEL, "the text reads `value`, for which the plants have no input"),
    ),
    "`count` ranges over one instance less": Fault(
        *(_EXPANSION, "._instances.of(quantifier.template):", "._instances.of(quantifier.template)[:-1]:"),
        *("Fleet", _MODEL, "request to `Cell1.enter` is forbidden by the text (line 22), and not by the model"),
    ),
    "a quantifier within `each` is about its instance": Fault(
        *(_INSTANCES, "            if part.template is template:\n                continue\n", "", "Fleet"),
        *(_MODEL, "request to `Cell2.enter` is forbidden by the text (line 22), and not by the model"),
    ),
    "`each` is always the first instance": Fault(
        *(_INSTANCES, "= _copy_for(definition, instance)", "= _copy_for(definition, self.of(definition.template)[0])"),
        *("Fleet", _MODEL, "after response from `Cell1.enter`, requirement automaton 2 stays as it was by the text"),
    ),
    "the arguments of an instance are swapped": Fault(
        *(_INSTANCES, "(parameters[position] if position <", "(parameters[(0, 2, 1)[position]] if position <"),
        *("Fleet", _MODEL, "`Cell1.used` (line 7) begins at 0 by the text, at 2 in the model"),
    ),
    "a state of an automaton with `each` is that of the first instance": Fault(
        *(_INSTANCES, "instance = current.get(index.item) or self.instance(index.item, within, index.index)"),
        *("instance = self.of(automaton.template)[0]", "Fleet"),
        *(_MODEL, "request to `Gate.lamp` is forbidden by the model (line 28), and not by the text"),
    ),
    "the index of a fleet is ignored": Fault(
        *(_INSTANCES, "return self._fleets[component].get(number) if", "return self._fleets[component].get(1) if"),
        *("Fleet", _MODEL, "request to `Gate.lamp` is forbidden by the model (line 28), and not by the text"),
    ),
    # Enforced reachability
    "the premise is dropped": Fault(
        *(_PLANTS, "if claimed.premise is not None:", "if claimed.premise is not None and not is_enforced:", "Reached"),
        *(_MODEL, "the condition after `from` of a requirement (line 25) does not hold by the text and does in the"),
    ),
    "the goal is negated": Fault(
        *(_PLANTS, "claim.condition, text = condition, ", "claim.condition, text = ex.Negation(operand=condition), "),
        *("Reached", _MODEL, "the reachable condition of a requirement (line 25) holds by the text and does not in"),
    ),
    "synthesis knows only marked states": Fault(
        *(_FIXPOINT, "self.encoding.all_marked), *self.goals]\n"),
        *("self.encoding.all_marked)]\n", "Reached"),
        *('requirement R1 "can get home": reachable Base.docked', "from `Base.lost` no state with `Base.docked` can"),
    ),
    "synthesis ends after one round": Fault(
        *(_FIXPOINT, "if good == alive:", "if alive.satisfiable():"),
        *("Reached", 'requirement R1 "can get home"', "from `Base.side` no state with `Base.docked` can be reached"),
    ),
    "the first of all goals is enough": Fault(
        *(_FIXPOINT, "if unchanged >= len(goals):", "if True:", "Reached"),
        *('requirement R1 "can get home"', "from `Base.lost` no state with `Base.docked` can be reached"),
    ),
    "the CIF has no `from`": Fault(
        *(_CIF_TEXT, "if part is not None:", "if False:", "Reached"),
        *(_TO_CIF, "a requirement about reachable states differs in the state `Base.gone`"),
    ),
    "the CIF has no requirement about reachable states": Fault(
        *(_CIF_TEXT, "for required in self._model.reachabilityRequirements:", "for required in ():", "Reached"),
        *(_TO_CIF, "the generated CIF without supervisor has 0 requirements about reachable states, the model has 2"),
    ),
    # Comparing with stored values
    "a negation has the input of its operand, and is lost": Fault(
        *(_STORED, "yield self._input(part)\n", "yield part, self._input(part)[1]\n", "Stored"),
        *(_MODEL, "after response from `Lidar.pose`, `Lidar` is in `near` by the text (line 10), and stays as it was"),
    ),
    "a negation that reads an array of an error shares an input": Fault(
        _STORED,
        "while isinstance(part, ex.Negation) and not (\n"
        "            happens_anyway(self._context.event) and any(map(is_partial, parts(part)))\n        ):",
        *("while isinstance(part, ex.Negation):", "Stored", _MODEL, _MISSING_ARRAY),
    ),
    "a negation of data alone that reads an array shares an input": Fault(
        *(_INPUTS, _OF_ARRAYS, f"{_OF_ARRAYS[:-1]} | ex.Negation)", "Arrays", _MODEL, _MISSING_ARRAY),
    ),
    "an `or` that reads an array of an error is split": Fault(
        *(_INPUTS, _OF_ARRAYS, f"{_OF_ARRAYS[:-1]} | ex.Disjunction)", "Arrays", _MODEL, _MISSING_ARRAY),
    ),
    "an assigned `and` that reads an array of an error is split": Fault(
        *(_INPUTS, _OF_ARRAYS, _OF_ARRAYS.replace("is_condition and ", ""), "Arrays"),
        *(_MODEL, "the plants have no input for whether `value.parts[2]<0.5andvalue.parts[3]<0.5` can be read"),
    ),
    "a joined condition is split": Fault(
        *(_STORED, "            elif not smallest.isdisjoint(parts(part)):\n                largest.add(part)"),
        *("            else:\n                largest |= smallest", "Stored"),
        *(_MODEL, "the plants have several inputs for a condition that the node computes as one"),
    ),
    "an input is that of another component with the same text": Fault(
        *(_STORED, "else instances.instance_of(access, within)", "else next(iter(instances))", "Shared"),
        *(_MODEL, "the text reads `value`, for which the plants have no input"),
    ),
    "an input names the template instead of the instance": Fault(
        *(_STORED, "if owner is not None:\n                access", "if False:\n                access", "Shared"),
        *(_MODEL, "after response from `Judge.seen`, `Rover2` is in `quick` by the text (line 7), and stays as it was"),
    ),
    "the upper bound of a stored integer is one more": Fault(
        *(_STORED, _DECLARED, f"{_DECLARED} + 1", "Stored"),
        *(_MODEL, "the plants have another range for a value computed from data"),
    ),
    "the lower bound of a stored integer is one more": Fault(
        *(_STORED, _DECLARED, _DECLARED.replace("minimum", "minimum + 1"), "Stored"),
        *(_MODEL, "the plants have another range for a value computed from data"),
    ),
    "the upper bound of each computed integer is one less": Fault(
        *(_DECLARATIONS, "maximum=value.bounds[1])", "maximum=value.bounds[1] - 1)", "Stored"),
        *(_MODEL, "the plants have another range for a value computed from data"),
    ),
    # Ends of actions and services
    "a canceled goal is ready": Fault(
        *(_PLANTS, "(CANCELING, sct.EventKind.canceled, IDLE)", "(CANCELING, sct.EventKind.canceled, READY)", "Ends"),
        *(_MODEL, "after canceled from `Base.drive`, `Base.drive` is in `idle` by the text (line 3), and is in"),
    ),
    "a canceled goal that succeeds is idle": Fault(
        *(_PLANTS, "(CANCELING, sct.EventKind.response, READY)", "(CANCELING, sct.EventKind.response, IDLE)", "Ends"),
        *(_MODEL, "after response from `Base.drive`, `Base.drive` is in `ready` by the text (line 3), and is in"),
    ),
    "a canceled goal cannot fail": Fault(
        *(_PLANTS, "    (CANCELING, sct.EventKind.error, ERROR),\n", "", "Ends"),
        *(_MODEL, "error from `Base.drive` can happen by the text (lines 3, 16), and not in the plants"),
    ),
    "the controller decides when a goal is canceled": Fault(
        *(_PLANTS, "controllable = kind in CONT", "controllable = kind == sct.EventKind.canceled or kind in CONT"),
        *("Ends", _MODEL, "event `u_canceled` of `Base.drive` is only in the text"),
    ),
    "a canceled goal is not running": Fault(
        *(_EXPRESSIONS, "if location.name in RUNNING)", "if location.name in RUNNING[:-1])", "Ends"),
        *(_MODEL, "request to `Base.lamp` is forbidden by the text (line 28), and not by the model"),
    ),
    "a goal that has ended is running": Fault(
        *(_EXPRESSIONS, "if location.name in RUNNING)", "if location.name in (*RUNNING, 'ready'))", "Ends"),
        *(_MODEL, "request to `Base.lamp` is forbidden by the model (line 28), and not by the text"),
    ),
    "the last reason is missing": Fault(
        *(_DECLARATIONS, "last=possible[-1])", "last=possible[-2])", "Ends"),
        *(_MODEL, "`i_error_reason` of error from `Base.drive` (line 3) has values rejected, lost, aborted, canceled"),
    ),
    "all kinds have the same reasons": Fault(
        *(_DECLARATIONS, "if name in reasons(source.port.communication)]", "]", "Ends"),
        *(_MODEL, "`i_error_reason` of error from `Base.drive` (line 3) has values rejected, lost, aborted, canceled"),
    ),
    "the CIF has the reasons of all kinds": Fault(
        *(_CIF, "if not low <= place <= high:", "if False:", "Ends"),
        *(_TO_CIF, "is wrong: the values of 'i_error_reason' of 'action_drive' are others"),
    ),
}


class Outside(NamedTuple):
    """A changed text of a module that no row covers, and the test that fails."""

    module: str
    before: str
    after: str
    test: str


_LIMITS = "tests/test_limits.py"
OUTSIDE: Mapping[str, Outside] = {
    "limits of components apply after those outside": Outside(
        *(_INSTANCES, "limit: limit.within is None)", "limit: limit.within is not None)", f"{_LIMITS}::test_order"),
    ),
    "limits apply in the opposite order": Outside(
        *("m2m.robosc_to_rosgraph", "in self.instances.limits(port))", "in self.instances.limits(port)[::-1])"),
        f"{_LIMITS}::test_order",
    ),
    "a limit applies wherever the robot is": Outside(
        *(_COMPOSER, "if condition is None or self.data.value(condition, message):", "if True:"),
        f"{_LIMITS}::test_applies",
    ),
    "a limit reads the data before all limits": Outside(
        *(_COMPOSER, "assignments, message, deepcopy(message) if hands_on else message, fields)"),
        "assignments, message, self.__dict__.setdefault('first', deepcopy(message)), fields)",
        f"{_LIMITS}::test_applies",
    ),
    "the node does not check assumptions": Outside(
        *("run.runtime.core.event_handler", "violation = self._violations.check(event)", "violation = None"),
        "tests/test_assumptions.py::test_violation",
    ),
    "`hypot` overflows": Outside(
        *("model.semantics.operators", "math.hypot(as_double(x), as_double(y))", "(x * x + y * y) ** 0.5"),
        "tests/model/semantics/test_functions.py::test_the_length_of_a_vector",
    ),
    "`not` of an operand in brackets is lost": Outside(
        *("language.linking", "ex.Negation(operand=call.arguments[0], source=call.source)", "call.arguments[0]"),
        "tests/language/test_spellings.py",
    ),
    "`not` binds less than `!`": Outside(
        *("language.spellings", 'yield from ((tokens[index].start, tokens[index].end, "!") for', "yield from (() for"),
        "tests/language/test_spellings.py",
    ),
    "a negative constant of a ROS type loses its sign": Outside(
        *("language.ros_constants", "return ex.UnaryMinus(operand=number, source=source) if value < 0 else number"),
        *("return number", "tests/language/test_ros_constants.py::test_constants_of_each_type"),
    ),
}


def verdicts(models: Models) -> list[Verdict]:
    """Return the verdicts on a robot, without those that need a compiler."""
    return [
        *verify_system(models.sct),
        validate_model(models.robosc, models.sct),
        validate_controller(models),
        validate_cif(models.sct, dict(cif.generate(models, Configuration()))),
    ]


def c_verdict(models: Models) -> list[Verdict]:
    return [validate_c(models.sct, dict(supervisor.generate(models, Configuration())))]


@pytest.fixture(scope="module", autouse=True)
def _imported(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Import all modules: one that is first imported while a fault is seeded would keep it."""
    models = models_of(ROBOTS["Ends"], tmp_path_factory.mktemp("robots"))
    verdicts(models)
    supervisor.generate(models, Configuration())


@pytest.mark.parametrize("robot", ROBOTS)
def test_without_a_fault_all_is_proved(robot: str, tmp_path: Path) -> None:
    found = verdicts(models_of(ROBOTS[robot], tmp_path))
    assert [verdict for verdict in found if verdict.outcome is not Outcome.PROVED] == []


@pytest.mark.build
@pytest.mark.parametrize("robot", ROBOTS)
def test_without_a_fault_the_c_is_proved(robot: str, tmp_path: Path) -> None:
    (found,) = c_verdict(models_of(ROBOTS[robot], tmp_path))
    assert found.outcome is Outcome.PROVED, found.explanation


def refuted(fault: Fault, rows: Callable[[Models], Sequence[Verdict]], folder: Path) -> None:
    """Assert that a row refutes a robot with its fault, which is seeded already."""
    found = rows(models_of(ROBOTS[fault.robot], folder))
    explanations = {verdict.property: verdict.explanation for verdict in found if verdict.outcome is Outcome.REFUTED}
    row = next((name for name in explanations if name.startswith(fault.row)), None)
    assert row is not None, explanations
    assert fault.said in explanations[row]


@pytest.mark.parametrize("name", [name for name, fault in FAULTS.items() if fault.row != _TO_C])
def test_a_row_refutes_the_fault(name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, *FAULTS[name][:3])
    refuted(FAULTS[name], verdicts, tmp_path)


@pytest.mark.build
@pytest.mark.parametrize("name", [name for name, fault in FAULTS.items() if fault.row == _TO_C])
def test_the_compiled_c_refutes_the_fault(name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, *FAULTS[name][:3])
    refuted(FAULTS[name], c_verdict, tmp_path)


@pytest.mark.build
def test_the_c_reads_the_condition_of_an_assumption_before_the_event(tmp_path: Path) -> None:
    models = models_of(ROBOTS["Assumed"], tmp_path)
    files = dict(supervisor.generate(models, Configuration()))
    before = """ && guard(&self->state, event);
    if (ran) {
        ran = run(self, event);
    }
"""
    after = """;
    const assumed_state state = self->state;
    ran = ran && run(self, event);
    if (ran && !guard(&self->state, event)) {
        self->state = state;
        ran = false;
    }
"""
    assert files["assumed_supervisor.c"].count(before) == 1
    files["assumed_supervisor.c"] = files["assumed_supervisor.c"].replace(before, after)
    found = validate_c(models.sct, files)
    assert found.outcome is Outcome.REFUTED
    assert "is enabled but does not happen in the generated C" in found.explanation


@pytest.mark.slow
@pytest.mark.parametrize("name", OUTSIDE)
def test_another_test_finds_the_fault(name: str) -> None:
    *fault, test = OUTSIDE[name]
    plugin = ["-p", "tests.analysis.verify.seeded_run", "-p", "no:cacheprovider", "-n0"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-x", *plugin, test],
        cwd=ROOT,
        env={**os.environ, "SEED": json.dumps(fault)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, f"FAILED {test}" in done.stdout) == (1, True), done.stdout + done.stderr
