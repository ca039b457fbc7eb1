"""Random robots whose supervisors decide with data, against an explicit search: per state and per data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest

import robosc
from robosc.analysis.supervise import supervise
from robosc.analysis.verify import Outcome, validate_cif, validate_controller, validate_model, verify_system
from robosc.base.diagnostics import ModelError
from robosc.engine import Engine
from robosc.engine.state import Domain
from robosc.language.configuration import Configuration
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.semantics.roles import event_name
from robosc.synthesis import synthesize
from tests.analysis.verify.commands import models_of, random_mixture, random_robot
from tests.searching import examples
from tests.synthesis.oracle import Oracle, State

if TYPE_CHECKING:
    from pathlib import Path

    Data = dict[sct.Input, Any]

pytestmark = pytest.mark.slow
#: Number of robots in a part of the search.
_PART = 10
#: Largest number of states of a robot that the explicit search takes.
_FEW = 40


@dataclass(frozen=True)
class DataOracle(Oracle):
    """Synthesis by the definition, where each combination of a command's data is an event of its own."""

    def permitted(self, event: sct.Event, state: State, data: Data) -> bool:
        """Return whether plants and requirements permit the event with some data."""
        requirements = (own for own in self.model.requirements if own.event is event)
        return self.edges(event, state, data) is not None and all(
            self.value(own.condition, state, data) == (own.kind == sct.RequirementKind.needs) for own in requirements
        )

    def required(self, event: sct.Event, state: State) -> bool:
        if event.controllable and event.inputs:
            return any(self.permitted(event, state, data) for data in self.inputs(event))
        return super().required(event, state)

    def successors(self, event: sct.Event, state: State) -> dict[State, Data]:
        if not (event.controllable and event.inputs):
            return super().successors(event, state)
        return {
            self.successor(event, state, data): data
            for data in self.inputs(event)
            if self.permitted(event, state, data)
        }

    def supervised(self, event: sct.Event, state: State, data: Data) -> bool:
        """Return whether the supervisor permits the event with some data in a controlled state."""
        return self.permitted(event, state, data) and self.successor(event, state, data) in self.controlled


def check_permissions(models: Models, oracle: DataOracle) -> int:
    """Compare guards, engine and oracle in each controlled state; return the number of withheld combinations."""
    supervisor = models.sct.supervisor
    assert supervisor is not None
    guards = {guard.event: guard for guard in supervisor.guards}
    engine, withheld = Engine(models.sct), 0
    commands = [event for event in oracle.events if event.controllable and event.inputs]
    for state in oracle.controlled:
        cells = tuple(_code(oracle, state, cell) for cell in models.engine.variables)
        for event in commands:
            guard, allowed = guards[event], []
            for data in oracle.inputs(event):
                expected = oracle.supervised(event, state, data)
                parts = (guard.requirement, guard.synthesis)
                actual = oracle.edges(event, state, data) is not None and all(
                    oracle.value(part, state, data) for part in parts
                )
                assert actual == expected, (event_name(event), state, data)
                engine.restore((cells, engine.saved[1]))
                engine.set_inputs(event_name(event), {carried.name: data[carried] for carried in event.inputs})
                possible = engine.enabled(event_name(event)) and engine.permits_inputs(event_name(event))
                assert possible == expected, (event_name(event), state, data)
                allowed.append(expected)
            assert engine.enabled(event_name(event)) == any(allowed), (event_name(event), state)
            withheld += 0 < sum(allowed) < len(allowed)
    return withheld


def _code(oracle: DataOracle, state: State, cell: Any) -> int:
    held = state[oracle.places[cell.variable or cell.plant]]
    return Domain(cell.type).internal(held.name if isinstance(held, sct.Location) else held)


@pytest.mark.parametrize("part", range(examples(50) // _PART))
def test_random_commands(part: int, tmp_path: Path) -> None:
    compared = withheld = 0
    for seed in range(part * _PART, (part + 1) * _PART):
        text = random_robot(seed)
        try:
            models = models_of(text, tmp_path)
        except ModelError as error:
            rules = {finding.rule for finding in error.diagnostics}
            assert rules & {"empty-supervisor", "cancel-held-back", "self-cancelling"}, text
            continue
        oracle = DataOracle(models.sct)
        assert synthesize(models.sct).controlled_states == len(oracle.controlled), text
        compared += 1
        withheld += check_permissions(models, oracle)
        verdicts = [
            *verify_system(models.sct),
            validate_model(models.robosc, models.sct),
            validate_controller(models),
            validate_cif(models.sct, dict(cif.generate(models, Configuration()))),
        ]
        promises = [verdict for verdict in verdicts if verdict.property not in ("no dead events", "confluence")]
        assert [verdict for verdict in promises if verdict.outcome is Outcome.REFUTED] == [], text
    assert compared
    assert withheld


@pytest.mark.parametrize("part", range(examples(20) // _PART))
def test_random_mixtures(part: int) -> None:
    """Conditions on data beside fleets, services, assumptions, orders and reachable states, also in CIF."""
    compared = 0
    for seed in range(part * _PART, (part + 1) * _PART):
        text = random_mixture(seed)
        robot = robosc.load(text=text)
        model = robosc.to_sct(robot)
        result = synthesize(model)
        if result.uncontrolled_states > _FEW:
            continue
        oracle = DataOracle(model)
        assert result.controlled_states == len(oracle.controlled), text
        compared += 1
        if result.supervisor is not None:
            model.supervisor = result.supervisor
            models = Models(model, robosc.to_rosgraph(robot), robot)
            check_permissions(models, oracle)
            verdict = validate_cif(model, dict(cif.generate(models, Configuration())))
            assert verdict.outcome is not Outcome.REFUTED, text
    assert compared


def test_a_robot_that_synthesis_restricts_is_drawn(tmp_path: Path) -> None:
    """Some of the robots lose states, so that synthesis adds conditions on data."""
    added = 0
    for seed in range(50):
        path = tmp_path / "robot.rscd"
        path.write_text(random_robot(seed))
        plants = robosc.to_sct(robosc.load(path))
        try:
            supervised = supervise(plants).synthesis.supervisor
        except ModelError:
            continue
        added += supervised is not None and any(
            guard.synthesis is not None and guard.event.inputs for guard in supervised.guards
        )
    assert added > 5
