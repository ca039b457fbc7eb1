"""The properties over decision diagrams against their definition, on random supervised models."""

from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from robosc.analysis.verify import Outcome, Verdict, verify_system
from robosc.analysis.verify.properties import requirement_name
from robosc.model import sct
from robosc.synthesis import acceleration, encoding, synthesize
from tests.analysis.verify.explicit import Explicit
from tests.random_sct import sct_models
from tests.sct_models import edge, model, plant
from tests.searching import examples
from tests.synthesis.oracle import State

pytestmark = pytest.mark.slow


@st.composite
def supervised_models(draw: st.DrawFn) -> sct.SupervisoryControlModel:
    """Draw models with a correct supervisor, or with one whose guards lack parts or are swapped."""
    model = draw(sct_models())
    supervisor = synthesize(model).supervisor
    if supervisor is None:
        events = [event for plant in model.plants for event in plant.events if event.controllable]
        supervisor = sct.Supervisor(guards=[sct.EventGuard(event=event, everEnabled=True) for event in events])
    model.supervisor = supervisor
    for guard in supervisor.guards if draw(st.booleans()) else ():
        if draw(st.booleans()):
            guard.requirement = None
        if draw(st.booleans()):
            guard.synthesis = None
    if draw(st.integers(0, 3)) == 0 and len(supervisor.guards) > 1:
        first, second = supervisor.guards[:2]
        first.requirement, second.requirement = second.requirement, first.requirement
    return model


@given(supervised_models())
@settings(max_examples=examples(20), suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_random_models(model: sct.SupervisoryControlModel) -> None:
    explicit = Explicit(model)
    assume(len(explicit.states) < 100)
    verdicts = verify_system(model)
    by_name = {verdict.property: verdict for verdict in verdicts}
    faults = {
        "non-blocking": explicit.blocked(explicit.moves, explicit.states),
        "controllability": explicit.uncontrolled(),
        "input-enabledness": explicit.deaf(),
        "maximal permissiveness": explicit.needless(),
    }
    for name, states in faults.items():
        check(explicit, by_name[name], states, appended=name == "maximal permissiveness")
    of_requirements = verdicts[3 : 3 + len(model.requirements)]
    for requirement, verdict in zip(model.requirements, of_requirements, strict=True):
        assert verdict.property == requirement_name(requirement)
        check(explicit, verdict, explicit.broken(requirement), appended=True)
    assert (by_name["no dead events"].outcome is Outcome.REFUTED) == bool(explicit.dead())
    uncanceled = explicit.uncanceled()
    assert ("cancel when due" in by_name) == (uncanceled is not None)
    if uncanceled is not None:
        check(explicit, by_name["cancel when due"], uncanceled)
    check_silent_events(explicit, by_name)
    check_control_loop(explicit, by_name["non-blocking in the control loop"])
    for reached in verdicts:
        event(f"{reached.property.split(' on ')[0]} {reached.outcome}")


def test_random_models_accelerated() -> None:
    with patch.object(encoding, "_WIDE", 2), patch.object(acceleration, "_PATIENCE", 1):
        test_random_models()


def check(explicit: Explicit, verdict: Verdict, faults: set[State], *, appended: bool = False) -> None:
    """Check that faults are refuted by a shortest trace to one; with the event at fault if `appended`."""
    if not faults:
        assert verdict == Verdict(verdict.property, Outcome.PROVED, verdict.evidence, seconds=verdict.seconds)
        return
    assert verdict.outcome is Outcome.REFUTED
    assert verdict.explanation
    trace = verdict.trace[:-1] if appended else verdict.trace
    assert explicit.after(trace) in faults
    assert len(trace) == min(explicit.states[fault] for fault in faults)


def check_silent_events(explicit: Explicit, verdicts: dict[str, Verdict]) -> None:
    finite, bounded, confluent = (
        verdicts[question] for question in ("finite response", "bounded response", "confluence")
    )
    divergent = explicit.divergent()
    assert (finite.outcome is Outcome.REFUTED) == bool(divergent)
    if divergent:
        start = explicit.after(finite.trace)
        assert finite.onwards
        assert all(onward.event.rpartition(".")[2].startswith(("c_tau", "c_reset")) for onward in finite.onwards)
        assert explicit.after(finite.onwards, start) == start
        assert bounded.outcome is Outcome.REFUTED
        return
    check_bound(explicit, bounded)
    torn = explicit.torn()
    assert (confluent.outcome is Outcome.REFUTED) == bool(torn)
    if torn:
        assert explicit.is_run_of_the_loop(confluent.trace)
        state = explicit.after(confluent.trace)
        assert state in torn
        assert explicit.after(confluent.onwards, state) != explicit.after(confluent.other, state)


def check_bound(explicit: Explicit, bounded: Verdict) -> None:
    longest, said = explicit.longest_run(), explicit.model.supervisor.settlingBound
    if said is not None and said < longest:
        assert bounded.outcome is Outcome.REFUTED
        assert len(bounded.onwards) == said + 1
        explicit.after(bounded.onwards, explicit.after(bounded.trace))
        return
    assert bounded.outcome is Outcome.PROVED
    assert int(bounded.evidence.partition("at most ")[2].split()[0]) >= longest


def check_control_loop(explicit: Explicit, verdict: Verdict) -> None:
    states = explicit.loop_states
    assert verdict.evidence == f"{len(states)} state{'' if len(states) == 1 else 's'}"
    blocked = explicit.loop_blocked()
    assert (verdict.outcome is Outcome.REFUTED) == bool(blocked)
    if blocked:
        assert explicit.is_run_of_the_loop(verdict.trace)
        assert explicit.after(verdict.trace) in blocked


@st.composite
def internal_models(draw: st.DrawFn) -> sct.SupervisoryControlModel:
    """Draw models whose silent events mostly go to later locations and meet, under conditions on other plants."""
    names = [f"p{index}" for index in range(draw(st.integers(1, 3)))]
    locations = [f"l{index}" for index in range(4)]
    anywhere = [
        None,
        *(f"{prefix}{name}.{location}" for name in names for location in locations for prefix in ("", "not ")),
    ]
    plants = []
    for name in names:
        silent = [f"c_tau{index}" for index in range(1, draw(st.integers(1, 2)) + 1)] + ["c_reset"]
        edges = {
            location: [
                edge(silent, to=draw(st.sampled_from(locations[place + 1 :])), when=draw(st.sampled_from(anywhere)))
                for silent in silent
                if place < 3 and draw(st.booleans())
            ]
            for place, location in enumerate(locations)
        }
        used = {edge.event for location in locations for edge in edges[location]}
        edges["l0"] += [edge(silent, to="l1") for silent in silent if silent not in used]
        for location in locations:
            edges[location].append(edge("u_response", to=draw(st.sampled_from(locations))))
        if draw(st.integers(0, 5)) == 0:
            edges["l3"].append(edge("c_reset", to="l0"))
        plants.append(plant(name, edges, controllable=silent, uncontrollable=["u_response"], marked=locations))
    made = model(plants)
    made.supervisor = synthesize(made).supervisor
    assert made.supervisor is not None
    if draw(st.integers(0, 2)) == 0:
        made.supervisor.settlingBound = draw(st.integers(0, 3))
    return made


@given(internal_models())
@settings(max_examples=examples(20), suppress_health_check=[HealthCheck.too_slow])
def test_internal_events(made: sct.SupervisoryControlModel) -> None:
    by_name = {verdict.property: verdict for verdict in verify_system(made)}
    check_silent_events(Explicit(made), by_name)
    check_control_loop(Explicit(made), by_name["non-blocking in the control loop"])
    for question in ("finite response", "bounded response", "confluence"):
        event(f"{question} {by_name[question].outcome}")


@given(sct_models())
@settings(max_examples=examples(20), suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_what_synthesis_makes_keeps_its_promises(model: sct.SupervisoryControlModel) -> None:
    model.supervisor = synthesize(model).supervisor
    assume(model.supervisor is not None)
    by_name = {verdict.property: verdict for verdict in verify_system(model)}
    promised = ["non-blocking", "controllability", "maximal permissiveness", *map(requirement_name, model.requirements)]
    assert {by_name[question].outcome for question in promised} == {Outcome.PROVED}
    divergent = by_name["finite response"].outcome is Outcome.REFUTED
    assert (model.supervisor.settlingBound is None) == divergent
