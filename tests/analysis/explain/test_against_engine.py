"""Explanations of random models, against the engine that runs the supervisor and against the definitions."""

import json
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import islice, product

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from robosc.analysis.explain.answers import Explanation, Possibility, Reach
from robosc.analysis.explain.explanations import emptiness, explain, explore, possibility
from robosc.analysis.explain.names import parse_state
from robosc.analysis.paths import TraceStep
from robosc.analysis.supervise import diagnose
from robosc.analysis.system import SynthesizedSystem, whole_state
from robosc.engine import Blocked, Engine
from robosc.engine.state import State
from robosc.model import sct
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.roles import event_name
from robosc.synthesis import synthesize
from robosc.synthesis.decoding import Value, text
from tests.analysis.test_blocking import Replay, is_blocked, is_never_marked
from tests.analysis.test_observations import Definitions
from tests.random_sct import sct_models
from tests.searching import examples
from tests.synthesis.oracle import Oracle, values_of
from tests.synthesis.test_against_oracle import RANDOM_MODELS

pytestmark = pytest.mark.slow

SOME_MODELS = settings(RANDOM_MODELS, max_examples=examples(4))


def supervised(model: sct.SupervisoryControlModel) -> Engine:
    """Return the engine of a model; if its supervisor is empty, mark all locations first."""
    model.supervisor = synthesize(model).supervisor
    if model.supervisor is None:
        for plant in model.plants:
            for location in plant.locations:
                location.marked = True
        model.supervisor = synthesize(model).supervisor
    return Engine(model)


def add_gate(model: sct.SupervisoryControlModel, kind: str | None) -> None:
    """Add a gate that opens only in states of the plants that the supervisor excludes.

    A requirement of this kind keeps it shut. Without a kind synthesis does, since the open gate never reaches a marked
    state.
    """
    opening = sct.Event(name="c_trigger", controllable=True, kind=sct.EventKind.trigger)
    shut, opened = sct.Location(name="shut", initial=True, marked=True), sct.Location(name="open")
    shut.edges.append(sct.Edge(event=opening, target=opened))
    gate = sct.Plant(name="gate", kind=sct.PlantKind.behaviour, events=[opening], locations=[shut, opened])
    model.plants.append(gate)
    if kind is not None:
        # A state that a requirement excludes need not be a trap.
        opened.marked = True
        condition = sct.LocationReference(location=opened if kind == "needs" else shut)
        requirement = sct.Requirement(event=opening, kind=getattr(sct.RequirementKind, kind), condition=condition)
        model.requirements.append(requirement)


def add_pit(model: sct.SupervisoryControlModel) -> None:
    """Add a pit: the robot may fall into it from its first state and never leaves it."""
    fall = sct.Event(name="u_response", controllable=False, kind=sct.EventKind.response)
    edge, bottom = sct.Location(name="edge", initial=True, marked=True), sct.Location(name="bottom")
    edge.edges.append(sct.Edge(event=fall, target=bottom))
    model.plants.append(sct.Plant(name="pit", kind=sct.PlantKind.behaviour, events=[fall], locations=[edge, bottom]))


def input_values(asked: sct.Event) -> Iterator[dict[str, Value]]:
    """Yield all data that an event may carry."""
    for values in product(*(values_of(own.type) for own in asked.inputs)):
        yield {own.name: getattr(value, "name", value) for own, value in zip(asked.inputs, values, strict=True)}


def making_it_possible(engine: Engine, state: State, name: str) -> set[str]:
    """Return the events after which, with some data, a currently impossible event is possible."""
    found = set()
    for asked in engine.roles.events:
        for data in input_values(asked):
            engine.state = state
            if engine.perform(event_name(asked), data) and engine.enabled(name):
                found.add(event_name(asked))
    engine.state = state
    return found


def run(engine: Engine, steps: Sequence[TraceStep]) -> None:
    for step in steps:
        assert engine.perform(step.event, step.inputs), step


def some_states(engine: Engine, number: int = 12):
    """Yield states that the engine reaches, breadth first."""
    inputs = {event_name(event): bool(event.inputs) for event in engine.roles.events}
    seen = {engine.state: None}
    pending = [engine.state]
    for state in pending:
        for name in engine.events:
            engine.state = state
            if not inputs[name] and engine.perform(name) and engine.state not in seen:
                seen[engine.state] = None
                pending.append(engine.state)
        if len(pending) >= number:
            break
    return list(islice(seen, number))


def told_state(engine: Engine) -> str:
    return ",".join(f"{name}={text(value)}" for name, value in engine.state.items())


@given(sct_models())
@SOME_MODELS
def test_an_event_in_a_state_is_what_the_engine_says(model):
    engine = supervised(model)

    def look(system: SynthesizedSystem) -> None:
        for state in some_states(engine):
            engine.state = state
            told = told_state(engine)
            codes = parse_state(model, told) if told else {}
            for asked in engine.roles.events:
                engine.state = state
                told = explain(system, asked, codes)
                assert told.situation.reach is Reach.SUPERVISED
                assert {name: told.situation.state[name] for name in state} == dict(state)
                assert told.by == engine.blocked_by(event_name(asked))
                assert told.allowed == engine.enabled(event_name(asked))
                event(f"by {told.by}")
                check(engine, state, told)

    explore(model, look)


def check(engine: Engine, state, told: Explanation) -> None:
    """Check that its traces run and end in the claimed states, and that its reasons are complete."""
    name = event_name(told.event)
    fresh = Engine(engine.model)
    run(fresh, told.situation.trace)
    assert dict(fresh.state) == dict(state)
    if told.way is not None:
        run(fresh, told.way)
        assert fresh.enabled(name)
    assert (told.way == ()) == told.allowed
    assert bool(told.plants) == (told.by is Blocked.PLANT)
    assert bool(told.requirements) >= (told.by is Blocked.REQUIREMENT)
    assert all(note.details for note in told.requirements)
    engine.state = state
    assert [note.element for note in told.requirements] == engine.failing_requirements(name)
    helpful = set() if told.allowed else making_it_possible(engine, state, name)
    assert {event_name(note.element.event) for note in told.changes} == helpful
    for note in told.changes:
        here = note.element.eContainer()
        assert here is here.eContainer().locations[engine.location(here.eContainer())]
    assert (told.counterexample is not None) == (told.by is Blocked.SYNTHESIS)
    if told.counterexample is not None:
        steps = [*told.situation.trace, *told.counterexample.trace, *told.counterexample.onwards]
        replay = Replay(engine.model, steps)
        end = replay.after(len(steps), requirements=True)
        assert [step.event for step in told.counterexample.trace] == [name]
        assert is_blocked(replay.oracle, end)
        assert {plant.name for plant in told.counterexample.unmarked} == {
            plant.name for plant in engine.model.plants if is_never_marked(replay.oracle, plant, end)
        }


@given(sct_models(), st.sampled_from((None, "needs", "disables")), st.data())
@SOME_MODELS
def test_states_out_of_the_supervisors_reach_are_told_apart(model, requirement, data):
    supervised(model)
    add_gate(model, requirement)
    engine = supervised(model)
    oracle = Oracle(model)
    outside = sorted(
        (oracle.uncontrolled - oracle.controlled),
        key=lambda state: str([getattr(part, "name", part) for part in state]),
    )
    state = data.draw(st.sampled_from(outside))
    chosen = data.draw(st.sampled_from(engine.roles.events))
    codes = parse_state(model, json.dumps({"state": Replay(model, []).names(state)}))

    def look(system: SynthesizedSystem) -> Explanation:
        return explain(system, chosen, codes)

    told = explore(model, look)
    assert told.situation.reach is Reach.UNSUPERVISED
    assert not told.allowed
    assert told.way is None
    # The supervisor stops a robot on this path at this event, and at none before it.
    refusal = told.refusal
    assert refusal is not None
    run(engine, refusal.situation.trace)
    assert refusal.situation.trace == told.situation.trace[: len(refusal.situation.trace)]
    stopped = told.situation.trace[len(refusal.situation.trace)]
    assert stopped.event == event_name(refusal.event)
    assert engine.blocked_by(stopped.event) == refusal.by
    assert refusal.by in {Blocked.REQUIREMENT, Blocked.SYNTHESIS}
    assert Replay(model, told.situation.trace).after(len(told.situation.trace), requirements=False) == state
    # The facts on plants and requirements are also true in this state.
    assert bool(told.plants) == (not oracle.enabled(chosen, state))
    assert bool(told.requirements) == (not oracle.required(chosen, state))


@given(sct_models())
@SOME_MODELS
def test_what_never_happens(model):
    engine = supervised(model)
    oracle = Oracle(model)
    definitions = Definitions(oracle)

    def look(system: SynthesizedSystem) -> None:
        for asked in engine.roles.events:
            told = possibility(system, asked)
            ever = any(
                oracle.allows(asked, state) if asked.controllable else oracle.enabled(asked, state)
                for state in oracle.controlled
            )
            assert told.possible == ever
            if told.nearest is None:
                assert not any(oracle.enabled(asked, state) for state in oracle.uncontrolled)
                assert told.plants
                continue
            event(f"nearest {told.nearest.situation.reach} {told.nearest.by}")
            fresh = Engine(model)
            if told.nearest.situation.reach is Reach.SUPERVISED:
                run(fresh, told.nearest.situation.trace)
                assert fresh.blocked_by(event_name(asked)) == told.nearest.by
            if not ever:
                assert (told.nearest.by is Blocked.SYNTHESIS) == bool(definitions.held_back(asked))
                check_beyond(oracle, asked, told.beyond)
                check_conflict(oracle, asked, told)
                check_loosenings(model, told.loosenings, partial(possible, event_name(asked)))

    explore(model, look)


def check_beyond(oracle: Oracle, chosen: sct.Event, beyond: Explanation | None) -> None:
    """Check that `beyond` exists if plants and requirements permit the event only in uncontrolled states."""
    willing = [
        state for state in oracle.uncontrolled if oracle.enabled(chosen, state) and oracle.required(chosen, state)
    ]
    enabled = any(oracle.enabled(chosen, state) for state in oracle.controlled)
    assert (beyond is not None) == (bool(willing) and enabled and not any(s in oracle.controlled for s in willing))
    if beyond is not None:
        replay = Replay(oracle.model, beyond.situation.trace)
        assert replay.after(len(replay.trace), requirements=False) in willing
        assert beyond.refusal is not None


def check_conflict(oracle: Oracle, asked: sct.Event, told: Possibility) -> None:
    """Check that a conflict exists if the requirements permit the event nowhere, and that it is sufficient."""
    willing = [state for state in oracle.uncontrolled if oracle.enabled(asked, state)]
    assert bool(told.conflict) == (told.nearest.by is Blocked.REQUIREMENT and told.beyond is None)
    if told.conflict:
        assert not any(
            all(
                oracle.value(note.element.condition, state, {}) == (note.element.kind == sct.RequirementKind.needs)
                for note in told.conflict
            )
            for state in willing
        )


def possible(name: str, model: sct.SupervisoryControlModel) -> bool:
    return name in map(event_name, synthesize(model).possible)


def check_loosenings(model, loosenings, helps) -> None:
    """Check that exactly the reported requirements help if they are left out."""
    requirements = list(model.requirements)
    helpful = []
    for left_out in requirements:
        model.requirements.remove(left_out)
        if helps(model):
            helpful.append(left_out)
        model.requirements.clear()
        model.requirements.extend(requirements)
    if loosenings is None:
        model.requirements.clear()
        assert not helps(model)
        model.requirements.extend(requirements)
    else:
        assert {loosening.requirements for loosening in loosenings} == {(requirement,) for requirement in helpful}


def changes_something(model, event):
    return any(
        edge.target is not location or any(len(values_of(update.variable.type)) > 1 for update in edge.updates)
        for plant in model.plants
        for location in plant.locations
        for edge in edges_from(location)
        if edge.event is event
    )


@given(sct_models())
@SOME_MODELS
def test_why_there_is_no_supervisor(model):
    if synthesize(model).supervisor is not None:
        assert explore(model, emptiness) is None
        add_pit(model)
    synthesis = diagnose(model)
    told = explore(model, emptiness)
    assert told.reason == synthesis.reason
    assert [note.element for note in told.stuck] == [
        plant.locations[told.reason.codes[plant]] for plant in told.reason.unmarked
    ]
    oracle = Oracle(model)
    before = 1 if told.reason.event is not None and told.reason.event.controllable else 0
    end = Replay(model, told.reason.trace).after(len(told.reason.trace) - before, requirements=True)
    onwards = oracle.reach(end, requirements=True)
    assert {note.element for note in told.blamed} == {
        requirement
        for requirement in model.requirements
        if any(
            oracle.enabled(requirement.event, state)
            and oracle.value(requirement.condition, state, {}) != (requirement.kind == sct.RequirementKind.needs)
            for state in onwards
        )
    }
    # Forbidding an event without effect excludes no state.
    at_fault = {note.element for note in told.blamed if changes_something(model, note.element.event)}
    if before:
        at_fault = {
            requirement
            for requirement in model.requirements
            if requirement.event is told.reason.event
            and oracle.value(requirement.condition, end, {}) != (requirement.kind == sct.RequirementKind.needs)
        }
    assert set(told.reason.requirements) == (at_fault if told.reason.event is not None else set())
    event(f"loosenings {told.loosenings and len(told.loosenings)}")
    check_loosenings(model, told.loosenings, lambda other: synthesize(other).supervisor is not None)
    for loosening in told.loosenings or ():
        for own in loosening.requirements:
            model.requirements.remove(own)
        assert synthesize(model).controlled_states == loosening.states
        model.requirements.extend(loosening.requirements)


@given(sct_models())
@SOME_MODELS
def test_a_state_reads_as_it_is_written(model):
    engine = supervised(model)
    told = told_state(engine)
    codes = parse_state(model, told) if told else {}
    whole = {variable: codes.get(variable, 0) for plant in model.plants for variable in (plant, *plant.variables)}
    shown = whole_state(model, whole)
    assert {name: shown[name] for name in engine.state} == dict(engine.state)
