"""Observations over decision diagrams against the definitions, state by state, on random models."""

from collections.abc import Iterable
from itertools import combinations
from unittest.mock import patch

import pytest
from hypothesis import assume, event, given
from hypothesis import strategies as st

from robosc.analysis import observations
from robosc.analysis.blocking import BlockingCounterexample
from robosc.analysis.observations import (
    Example,
    Forbidden,
    NeverEnabled,
    Observations,
    SharedTopicConflict,
    UnreachableState,
)
from robosc.analysis.supervise import diagnose
from robosc.model import sct
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.roles import event_name, plant_of
from tests.analysis.test_blocking import Replay, distance, is_blocked, is_never_marked
from tests.random_sct import sct_models
from tests.sct_models import edge, model, needs, plant
from tests.synthesis.classics import philosophers
from tests.synthesis.oracle import Oracle, State
from tests.synthesis.test_against_oracle import RANDOM_MODELS

SILENT = (sct.EventKind.tau, sct.EventKind.reset)


@st.composite
def communicating_models(draw: st.DrawFn) -> sct.SupervisoryControlModel:
    """Draw models in which observations are frequent.

    Plants with a trigger communicate on one topic, and data plants belong to one of them. Some actions have the
    requirement that they are not running.
    """
    made = draw(sct_models())
    triggers = [event for plant in made.plants for event in plant.events if event.kind == sct.EventKind.trigger]
    for trigger in triggers:
        plant_of(trigger).kind = getattr(sct.PlantKind, draw(st.sampled_from(("message", "service", "action"))))
        plant_of(trigger).topic = draw(st.sampled_from(("shared", "/shared")))
        if plant_of(trigger).kind == sct.PlantKind.action and draw(st.booleans()):
            initial = next(location for location in plant_of(trigger).locations if location.initial)
            made.requirements.append(
                sct.Requirement(
                    event=trigger, kind=sct.RequirementKind.needs, condition=sct.LocationReference(location=initial)
                )
            )
    for member in made.plants:
        if member.kind == sct.PlantKind.data and triggers:
            member.origin = "C.c"
            plant_of(draw(st.sampled_from(triggers))).origin = "C.c"
    return made


class Definitions:
    """The definitions of all observations, over the states of the oracle."""

    def __init__(self, oracle: Oracle) -> None:
        self.oracle = oracle
        self.controllable = [event for event in oracle.events if event.controllable]
        self.triggers = [event for event in self.controllable if event.kind == sct.EventKind.trigger]

    def unreachable_states(self) -> list[sct.Location]:
        return [
            location
            for plant in self.oracle.model.plants
            if plant.kind == sct.PlantKind.behaviour
            for location in plant.locations
            if not any(state[self.oracle.places[plant]] is location for state in self.oracle.controlled)
        ]

    def allowed(self, event: sct.Event) -> set[State]:
        return {state for state in self.oracle.controlled if self.oracle.allows(event, state)}

    def never_enabled(self) -> list[sct.Event]:
        kinds = (sct.EventKind.trigger, sct.EventKind.tau)
        return [event for event in self.controllable if event.kind in kinds and not self.allowed(event)]

    def held_back(self, event: sct.Event) -> set[State]:
        """Return the controlled states in which only synthesis forbids the event."""
        return {
            state
            for state in self.oracle.controlled
            if self.oracle.enabled(event, state) and self.oracle.required(event, state)
        } - self.allowed(event)

    def silent_restricted(self) -> list[sct.Event]:
        kinds = (*SILENT, sct.EventKind.cancel)
        return [event for event in self.controllable if event.kind in kinds and self.held_back(event)]

    def after(self, event: sct.Event) -> set[State]:
        return {after for state in self.allowed(event) for after in self.oracle.successors(event, state)}

    def self_cancelling(self) -> list[sct.Event]:
        return [
            trigger
            for trigger in self.triggers
            if plant_of(trigger).kind == sct.PlantKind.action
            and self.allowed(trigger)
            and not any(self.oracle.required(trigger, state) for state in self.after(trigger))
        ]

    def gap(self, event: sct.Event, data: sct.Plant) -> set[State]:
        return {
            state
            for state in self.allowed(event)
            if not any(
                self.oracle.value(edge.guard, state, {})
                for edge in edges_from(state[self.oracle.places[data]])
                if not edge.target.initial
            )
        }

    def provide_gaps(self) -> list[tuple[sct.Event, sct.Plant]]:
        return [
            (trigger, data)
            for trigger in self.triggers
            for data in self.oracle.model.plants
            if data.kind == sct.PlantKind.data and data.origin and data.origin == plant_of(trigger).origin
            if self.gap(trigger, data)
        ]

    def shared_topic_conflicts(self) -> list[tuple[sct.Event, sct.Event]]:
        messages = [trigger for trigger in self.triggers if plant_of(trigger).kind == sct.PlantKind.message]
        return [
            (message, other)
            for message, other in combinations(messages, 2)
            if plant_of(message).topic.strip("/") == plant_of(other).topic.strip("/")
            and self.allowed(message) & self.allowed(other)
        ]

    def unrestricted_calls(self) -> list[sct.Event]:
        return [
            trigger
            for trigger in self.triggers
            if plant_of(trigger).kind in (sct.PlantKind.service, sct.PlantKind.action)
            and self.allowed(trigger)
            and not any(requirement.event is trigger for requirement in self.oracle.model.requirements)
            and not any(
                edge.event is trigger
                for plant in self.oracle.model.plants
                if plant is not plant_of(trigger)
                for location in plant.locations
                for edge in edges_from(location)
            )
        ]


@pytest.mark.slow
@given(communicating_models())
@RANDOM_MODELS
def test_random_models(random_model):
    observed = diagnose(random_model).observations
    oracle = Oracle(random_model)
    assert (observed is None) == (not oracle.controlled)
    assume(observed is not None)
    definitions = Definitions(oracle)
    assert [observation.event for observation in observed.never_enabled] == definitions.never_enabled()
    assert [observation.event for observation in observed.silent_restricted] == definitions.silent_restricted()
    assert [observation.event for observation in observed.self_cancelling] == definitions.self_cancelling()
    assert [(gap.event, gap.data) for gap in observed.provide_gaps] == definitions.provide_gaps()
    conflicts = definitions.shared_topic_conflicts()
    told = [(first, shared.second) for shared in observed.shared_topic_conflicts for first in met(shared)]
    assert (set(told), len(told)) == (set(conflicts), len(conflicts))
    assert list(observed.unrestricted_calls) == definitions.unrestricted_calls()
    assert [state.location for state in observed.unreachable_states] == definitions.unreachable_states()
    for name in vars(observed):
        event(name if getattr(observed, name) else f"no {name}")
    check_details(definitions, observed)


def met(conflict: SharedTopicConflict) -> list[sct.Event]:
    return [conflict.first, *conflict.others]


def check_details(definitions: Definitions, observed: Observations) -> None:
    """Check the details of each observation."""
    oracle = definitions.oracle
    check_never_enabled(definitions, observed.never_enabled)
    for restricted in observed.silent_restricted:
        check_counterexample(definitions, restricted.event, restricted.counterexample)
    assert list(observed.counterexamples) == [
        event for event in definitions.controllable if definitions.held_back(event)
    ]
    for held_event, counterexample in observed.counterexamples.items():
        check_counterexample(definitions, held_event, counterexample)
    for cancelling in observed.self_cancelling:
        check_forbidding(oracle, cancelling.event, cancelling.requirements, definitions.after(cancelling.event))
    for unreachable in observed.unreachable_states:
        check_hindrances(definitions, unreachable)
    for gap in observed.provide_gaps:
        check_example(definitions, gap.example, definitions.gap(gap.event, gap.data))
    for conflict in observed.shared_topic_conflicts:
        both = definitions.allowed(conflict.first) & definitions.allowed(conflict.second)
        check_example(definitions, conflict.example, both)


def holds(oracle, requirement, state):
    return oracle.value(requirement.condition, state, {}) == (requirement.kind == sct.RequirementKind.needs)


def check_forbidding(oracle, event, told, states):
    """Check the reported requirements.

    They are those that each hold in none of the states. If there are none, they are a minimal set that never holds
    together.
    """
    own = [requirement for requirement in oracle.model.requirements if requirement.event is event]
    alone = [requirement for requirement in own if not any(holds(oracle, requirement, state) for state in states)]
    if alone:
        assert list(told) == alone
        return
    assert len(told) > 1
    assert not any(all(holds(oracle, requirement, state) for requirement in told) for state in states)
    for left_out in told:
        assert any(
            all(holds(oracle, requirement, state) for requirement in told if requirement is not left_out)
            for state in states
        )


def check_hindrances(definitions: Definitions, observed: UnreachableState) -> None:
    """Check that the hindrances are all transitions to the state, and that each reason excludes its transition."""
    oracle, location = definitions.oracle, observed.location
    component = location.eContainer()
    assert {hindrance.edge for hindrance in observed.hindrances} == {
        edge
        for other in component.locations
        if other is not location
        for edge in other.edges
        if edge.target is location
    }
    for hindrance in observed.hindrances:
        happens = hindrance.edge.event
        here = [s for s in oracle.controlled if s[oracle.places[component]] is hindrance.edge.eContainer()]
        enabled = [
            state
            for state in here
            if any(hindrance.edge in (oracle.edges(happens, state, inputs) or ()) for inputs in oracle.inputs(happens))
        ]
        required = [state for state in enabled if oracle.required(happens, state)]
        assert hindrance.forbidden is (
            Forbidden.BY_SYNTHESIS
            if required
            else Forbidden.BY_REQUIREMENTS
            if enabled
            else Forbidden.BY_PLANTS
            if here
            else None
        )
        event(f"unreachable {hindrance.forbidden}")
        if hindrance.forbidden is Forbidden.BY_REQUIREMENTS:
            check_forbidding(oracle, happens, hindrance.requirements, enabled)
        assert (hindrance.counterexample is not None) == bool(required)
        if hindrance.counterexample is not None:
            replay = Replay(oracle.model, hindrance.counterexample.trace)
            assert replay.after(len(replay.trace) - 1, requirements=True) in required


def check_example(definitions: Definitions, example: Example, states: set[State]) -> None:
    """Check that the example is one of the states, and settled if one of them is."""
    oracle = definitions.oracle
    silent = [event for event in definitions.controllable if event.kind in SILENT]
    unsettled = {state for silent in silent for state in definitions.allowed(silent)}
    [state] = [state for state in states if shown(oracle, state) == example.state]
    assert list(example.state) == list(oracle.places)
    assert example.quiescent == (state not in unsettled) == bool(states - unsettled)


def shown(oracle: Oracle, state: State):
    values = dict(zip(oracle.places, state, strict=True))
    return {key: value if isinstance(value, (bool, int)) else value.name for key, value in values.items()}


def check_never_enabled(definitions: Definitions, found: Iterable[NeverEnabled]) -> None:
    """Check who forbids each of the events, and the reported path."""
    oracle = definitions.oracle
    for never in found:
        enabled = [state for state in oracle.controlled if oracle.enabled(never.event, state)]
        required = [state for state in enabled if oracle.required(never.event, state)]
        beyond = [state for state in oracle.uncontrolled if oracle.enabled(never.event, state)]
        states = enabled or beyond
        asked = any(oracle.required(never.event, state) for state in states)
        by_requirements = states and not asked
        assert never.forbidden is (
            Forbidden.BY_SYNTHESIS
            if required
            else Forbidden.BY_REQUIREMENTS
            if by_requirements
            else Forbidden.BY_PLANTS
        )
        assert never.kept_away == (not enabled and asked)
        if never.forbidden is Forbidden.BY_REQUIREMENTS:
            check_forbidding(oracle, never.event, never.requirements, states)
        assert (never.counterexample is not None) >= bool(required)
        if required:
            check_counterexample(definitions, never.event, never.counterexample)
        elif never.kept_away:
            check_barrier(definitions, never)
        else:
            assert never.counterexample is None


def check_barrier(definitions: Definitions, never: NeverEnabled) -> None:
    """Check the obstacle on the path to states in which only the plants permit the event."""
    oracle = definitions.oracle
    steps = never.counterexample.trace if never.counterexample is not None else never.trace
    replay = Replay(oracle.model, steps)
    held_back, before = replay.events[steps[-1].event], replay.after(len(steps) - 1, requirements=True)
    assert before in oracle.controlled
    assert held_back.controllable
    if never.counterexample is not None:
        assert before in definitions.held_back(held_back)
    else:
        assert never.needed is held_back
        assert oracle.enabled(held_back, before)
        check_forbidding(oracle, held_back, never.requirements, [before])


def check_counterexample(
    definitions: Definitions, held_back: sct.Event, counterexample: BlockingCounterexample
) -> None:
    """Check that the trace is a shortest one to a held-back event, and continues until a plant is lost.

    After its end, some plants can never be marked again.
    """
    oracle = definitions.oracle
    assert counterexample.trace[-1].event == event_name(held_back)
    steps = [*counterexample.trace, *counterexample.onwards]
    replay = Replay(oracle.model, steps)
    before, after, end = (
        replay.after(count, requirements=True)
        for count in (len(counterexample.trace) - 1, len(counterexample.trace), len(steps))
    )
    states = definitions.held_back(held_back)
    assert before in states
    assert after not in oracle.controlled
    assert len(counterexample.trace) - 1 == min(distance(oracle, state, within=oracle.controlled) for state in states)
    assert is_blocked(oracle, end)
    if counterexample.onwards:
        assert not replay.events[steps[-1].event].controllable
        assert not is_blocked(oracle, replay.after(len(steps) - 1, requirements=True))
    assert set(counterexample.unmarked) == {
        plant for plant in oracle.model.plants if is_never_marked(oracle, plant, end)
    }


def test_counterexample_that_comes_later_is_traced_to_its_end():
    """After the event, the robot may slip by itself to a state with forbidden exits only."""
    machine = plant(
        "M",
        {
            "rest": [edge("c_tau1", to="edge")],
            "edge": [edge("u_slip", to="slope"), edge("c_tau2", to="rest")],
            "slope": [edge("c_tau3", to="ravine")],
            "ravine": [edge("u_fall", to="ground"), edge("c_tau4", to="rest")],
            "ground": [],
        },
        controllable=["c_tau1", "c_tau2", "c_tau3", "c_tau4"],
        uncontrollable=["u_slip", "u_fall"],
    )
    observed = diagnose(model([machine])).observations
    [restricted] = observed.silent_restricted
    assert restricted.event.name == "c_tau1"
    assert [step.event for step in restricted.counterexample.trace] == ["M.c_tau1"]
    assert [onward.event for onward in restricted.counterexample.onwards] == ["M.u_slip", "M.c_tau3", "M.u_fall"]
    assert restricted.counterexample.unmarked == (machine.element,)
    never = {observation.event.name: observation for observation in observed.never_enabled}
    assert never["c_tau1"].counterexample == restricted.counterexample
    assert never["c_tau2"].forbidden is Forbidden.BY_PLANTS
    assert never["c_tau2"].plants == (machine.element,)


def test_counterexample_leads_through_what_nothing_prevents():
    """The shorter path to the ground has a controllable step, which the supervisor could prevent."""
    machine = plant(
        "M",
        {
            "rest": [edge("c_tau1", to="edge")],
            "edge": [edge("c_tau2", to="ground"), edge("u_slip", to="slope"), edge("c_tau3", to="rest")],
            "slope": [edge("u_fall", to="ground"), edge("c_tau3", to="rest")],
            "ground": [],
        },
        controllable=["c_tau1", "c_tau2", "c_tau3"],
        uncontrollable=["u_slip", "u_fall"],
    )
    [(held_back, counterexample)] = diagnose(model([machine])).observations.counterexamples.items()
    assert held_back.name == "c_tau1"
    assert [onward.event for onward in counterexample.onwards] == ["M.u_slip", "M.u_fall"]


def test_large_models_get_no_more_counterexamples_than_are_cheap():
    with patch.object(observations, "_STEPS", 10):
        assert 0 < len(diagnose(philosophers(4)).observations.counterexamples) < 8
    with patch.object(observations, "_EFFORT", 10):
        assert not diagnose(philosophers(4)).observations.counterexamples


@pytest.mark.parametrize(
    ("where", "example", "settled"),
    [("S.dusk", "dusk", False), ("S.dusk or S.light", "light", True), ("S.dark or S.dusk", "dark", True)],
)
def test_an_example_is_settled_where_that_is_possible(where, example, settled):
    sensor = plant(
        "S",
        {"dark": [edge("u_response", to="dusk")], "dusk": [edge("c_tau1", to="light")], "light": []},
        controllable=["c_tau1"],
        uncontrollable=["u_response"],
        marked=["dark", "dusk", "light"],
    )
    first, second = (
        plant(name, {"ready": [edge("c_trigger")]}, controllable=["c_trigger"], kind="message", topic=topic)
        for name, topic in (("a", "t"), ("b", "/t"))
    )
    [conflict] = diagnose(
        model([sensor, first, second], [needs("a.c_trigger", where)])
    ).observations.shared_topic_conflicts
    assert conflict.example.state == {sensor.element: example, first.element: "ready", second.element: "ready"}
    assert conflict.example.quiescent == settled


def test_what_can_still_be_marked_after_a_counterexample():
    """The lamp can be marked, once its bulb is in; the gate opens only at a machine at rest."""
    machine = plant(
        "M",
        {"rest": [edge("c_tau1", to="slope")], "slope": [edge("u_fall", to="ground")], "ground": []},
        controllable=["c_tau1"],
        uncontrollable=["u_fall"],
    )
    gate = plant("G", {"shut": [edge("c_tau2", to="open")], "open": []}, controllable=["c_tau2"], marked=["open"])
    lamp = plant("L", {"dark": [edge("c_tau3", to="lit")], "lit": []}, controllable=["c_tau3"], marked=["lit"])
    bulb = plant(
        "B", {"out": [edge("u_in", to="inserted")], "inserted": []}, uncontrollable=["u_in"], marked=["out", "inserted"]
    )
    made = model([machine, gate, lamp, bulb], [needs("c_tau2", "M.rest"), needs("c_tau3", "B.inserted")])
    [restricted] = diagnose(made).observations.silent_restricted
    assert [step.event for step in restricted.counterexample.trace] == ["M.c_tau1"]
    assert restricted.counterexample.unmarked == (machine.element, gate.element)
