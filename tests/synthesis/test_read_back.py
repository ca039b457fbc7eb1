"""Synthesis, explicit exploration and the generated CIF, read back, agree on the number of states."""

import pytest
from hypothesis import event, given

from robosc.language.configuration import Configuration
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.model.semantics.edges import edges_from
from robosc.synthesis import synthesize
from tests.m2t.cif.rebuilding import rebuild
from tests.random_sct import sct_models
from tests.synthesis.oracle import Oracle
from tests.synthesis.test_against_oracle import RANDOM_MODELS

pytestmark = pytest.mark.slow


@given(sct_models())
@RANDOM_MODELS
def test_state_counts_agree(model):
    synthesis = synthesize(model)
    event("empty" if synthesis.supervisor is None else "supervised")
    model.supervisor = synthesis.supervisor
    files = cif.generate(Models(model), Configuration())
    counts = synthesis.uncontrolled_states, synthesis.controlled_states
    again = read(files["robot.cif"])
    read_back = synthesize(again)
    assert (read_back.uncontrolled_states, read_back.controlled_states) == counts
    for oracle in (Oracle(model), Oracle(again)):
        assert (len(oracle.uncontrolled), len(oracle.controlled)) == counts
    if synthesis.supervisor is not None:
        assert supervised_states(read(files["robot.supervised.cif"])) == synthesis.controlled_states


def read(text: str) -> sct.SupervisoryControlModel:
    """Return the model of a CIF text.

    CIF does not name the event of an input: events whose guards or updates read the input get it.
    """
    model = rebuild(text)
    for plant in model.plants:
        for location in plant.locations:
            for edge in edges_from(location):
                reads = [edge.guard] if edge.guard is not None else []
                for _, part in (found for read in [*reads, *edge.updates] for found in tree(read)):
                    if isinstance(part, sct.InputReference) and part.input not in edge.event.inputs:
                        edge.event.inputs.append(part.input)
    return model


def supervised_states(supervised: sct.SupervisoryControlModel) -> int:
    """Return the states that the plants reach under the supervisor's guards, which replace the requirements."""
    for guard in supervised.supervisor.guards:
        for part in (guard.requirement, guard.synthesis):
            if part is not None:
                supervised.requirements.append(
                    sct.Requirement(event=guard.event, kind=sct.RequirementKind.needs, condition=part)
                )
    oracle = Oracle(supervised)
    return len(oracle.reach(oracle.initial, requirements=True))
