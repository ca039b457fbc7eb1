"""Symbolic synthesis against synthesis by the definition, on random models."""

from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, event, given, settings

from robosc.model import sct
from robosc.model.semantics.printing import SctPrinter
from robosc.model.semantics.roles import event_name
from robosc.synthesis import Synthesis, count, encoding, synthesize
from tests.random_sct import sct_models
from tests.searching import examples
from tests.synthesis.oracle import Oracle

pytestmark = pytest.mark.slow

RANDOM_MODELS = settings(
    max_examples=examples(18), deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


def check(model: sct.SupervisoryControlModel, synthesis: Synthesis) -> None:
    """Compare every result of synthesis with the definition."""
    oracle = Oracle(model)
    assert synthesis.uncontrolled_states == oracle.uncontrolled_states
    assert synthesis.controlled_states == count(model).controlled_states == len(oracle.controlled)
    assert (synthesis.supervisor is None) == (not oracle.controlled)
    if synthesis.supervisor is not None:
        check_guards(oracle, synthesis.supervisor)


def check_guards(oracle: Oracle, supervisor: sct.Supervisor) -> None:
    assert [guard.event for guard in supervisor.guards] == [event for event in oracle.events if event.controllable]
    for guard in supervisor.guards:
        ever = False
        for state in oracle.controlled:
            enabled = oracle.enabled(guard.event, state)
            requirement, synthesis = (oracle.value(part, state, {}) for part in (guard.requirement, guard.synthesis))
            allowed = oracle.allows(guard.event, state)
            assert (enabled and requirement and synthesis) == allowed, describe(guard)
            if enabled:
                assert requirement == oracle.required(guard.event, state), describe(guard)
            ever = ever or allowed
        assert guard.everEnabled == ever
        check_parts_say_something(oracle, guard)


def check_parts_say_something(oracle: Oracle, guard: sct.EventGuard) -> None:
    """Check that a part is absent if it is true in every state that the other parts permit."""
    states = [state for state in oracle.controlled if oracle.enabled(guard.event, state)]
    if guard.requirement is not None:
        assert not all(oracle.required(guard.event, state) for state in states), describe(guard)
    if guard.synthesis is not None:
        required = [state for state in states if oracle.required(guard.event, state)]
        assert not all(oracle.allows(guard.event, state) for state in required), describe(guard)


def describe(guard: sct.EventGuard) -> str:
    text = SctPrinter()
    parts = [part and text(part) for part in (guard.requirement, guard.synthesis)]
    return f"{event_name(guard.event)}: requirement {parts[0]}, synthesis {parts[1]}"


@given(sct_models(requirements=True))
@RANDOM_MODELS
def test_random_models(model):
    synthesis = synthesize(model)
    event("empty" if synthesis.supervisor is None else "supervised")
    check(model, synthesis)


@given(sct_models())
@RANDOM_MODELS
def test_bits_that_take_turns(model):
    with patch.object(encoding, "_WIDE", 2):
        check(model, synthesize(model))


@given(sct_models())
@RANDOM_MODELS
def test_synthesis_never_restricts_data_events(model):
    synthesis = synthesize(model)
    if synthesis.supervisor is not None:
        data = [guard for guard in synthesis.supervisor.guards if guard.event.kind == sct.EventKind.data]
        assert [guard.synthesis for guard in data] == [None] * len(data)
