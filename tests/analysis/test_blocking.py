"""Explanations of empty supervisors: the sentence, and a trace that the definition confirms."""

from collections.abc import Container, Sequence
from itertools import product

import pytest
from hypothesis import assume, given

from robosc.analysis.blocking import BlockReason
from robosc.analysis.blocking_in_words import describe_blocking
from robosc.analysis.paths import Layers, TraceStep
from robosc.analysis.supervise import diagnose
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.roles import event_name
from tests.random_sct import sct_models
from tests.sct_models import disables, edge, model, needs, plant
from tests.synthesis.oracle import Oracle, State, values_of
from tests.synthesis.test_against_oracle import RANDOM_MODELS


class Replay:
    """A trace that runs through the oracle."""

    def __init__(self, given_model: sct.SupervisoryControlModel, trace: Sequence[TraceStep]) -> None:
        self.oracle = Oracle(given_model)
        self.trace = trace
        self.events = {event_name(event): event for event in self.oracle.events}

    def after(self, steps: int, *, requirements: bool) -> State:
        """Return the state after the first steps of the trace.

        Each step is possible with all values of unnamed inputs.
        """
        state = self.oracle.initial
        for step in self.trace[:steps]:
            event = self.events[step.event]
            assert not requirements or self.oracle.required(event, state)
            reached = {
                after for values in self.completions(event, step.inputs) for after in self.step(event, state, values)
            }
            assert len(reached) == 1
            [state] = reached
        return state

    def completions(self, event, named):
        choices = [
            [
                value
                for value in values_of(parameter.type)
                if parameter.name not in named or python(value) == named[parameter.name]
            ]
            for parameter in event.inputs
        ]
        assert all(choices)
        return [dict(zip(event.inputs, values, strict=True)) for values in product(*choices)]

    def step(self, event, state, inputs):
        return [self.oracle.successor(event, state, inputs)] if self.oracle.enabled(event, state) else []

    def names(self, state: State):
        named = {}
        for element, index in self.oracle.places.items():
            if isinstance(element, sct.DiscreteVariable):
                named[f"{element.eContainer().name}.{element.name}"] = python(state[index])
            elif len(element.locations) > 1:
                named[element.name] = state[index].name
        return named


def python(value):
    return value.name if isinstance(value, ex.EnumerationLiteral) else value


def distance(oracle: Oracle, goal: State, within: Container[State] | None = None) -> int:
    """Return the minimum number of events to a state, under the requirements and within a set of states."""
    layer, seen, steps = {oracle.initial}, {oracle.initial}, 0
    while goal not in layer:
        layer = {
            after
            for state in layer
            for event in oracle.events
            if oracle.required(event, state)
            for after in oracle.successors(event, state)
            if within is None or after in within
        } - seen
        seen |= layer
        steps += 1
    return steps


def is_blocked(oracle: Oracle, state: State) -> bool:
    return not any(map(oracle.is_marked, oracle.reach(state, requirements=True)))


@pytest.mark.slow
@given(sct_models(data=False))
@RANDOM_MODELS
def test_the_trace_leads_to_the_fault(random_model):
    synthesis = diagnose(random_model)
    assume(synthesis.supervisor is None)
    reason = synthesis.reason
    assert reason is not None
    replay = Replay(random_model, reason.trace)
    if reason.event is None:
        assert reason.trace == ()
        assert not any(map(replay.oracle.is_marked, replay.oracle.uncontrolled))
        assert reason.state == replay.names(replay.oracle.initial)
    elif reason.event.controllable:
        check_requirement_at_fault(replay, reason)
    else:
        check_uncontrollable_at_fault(replay, reason)


def check_requirement_at_fault(replay: Replay, reason: BlockReason) -> None:
    """Check that all is blocked from the start.

    The trace ends with an event that a requirement forbids on the way to a marked state.
    """
    oracle = replay.oracle
    assert is_blocked(oracle, oracle.initial)
    before = replay.after(len(reason.trace) - 1, requirements=True)
    assert reason.trace[-1].event == event_name(reason.event)
    assert oracle.enabled(reason.event, before)
    assert not oracle.required(reason.event, before)
    after = replay.after(len(reason.trace), requirements=False)
    assert any(map(oracle.is_marked, oracle.reach(after, requirements=False)))
    assert reason.state == replay.names(before)


def check_uncontrollable_at_fault(replay: Replay, reason: BlockReason) -> None:
    """Check that the trace is a shortest one to its last event, after which no marked state is reachable."""
    oracle = replay.oracle
    before, after = (replay.after(len(reason.trace) - last, requirements=True) for last in (1, 0))
    assert reason.trace[-1].event == event_name(reason.event)
    assert len(reason.trace) == distance(oracle, before) + 1
    assert not is_blocked(oracle, before)
    assert is_blocked(oracle, after)
    assert reason.state == replay.names(after)
    never = {plant for plant in oracle.model.plants if is_never_marked(oracle, plant, after)}
    assert set(reason.unmarked) == never


def is_never_marked(oracle: Oracle, automaton: sct.Plant, state: State) -> bool:
    return not any(after[oracle.places[automaton]].marked for after in oracle.reach(state, requirements=True))


def tank(**arguments):
    return plant(
        "Tank",
        {
            "calm": [edge("measured", to="tense", do={"level": "x"})],
            "tense": [edge("relax", to="calm"), edge("burst", to="burst", when="level > 2")],
            "burst": [],
        },
        controllable=["relax"],
        uncontrollable={"measured": ["x"], "burst": []},
        variables={"level": "0..7"},
        inputs={"x": "0..7"},
        **arguments,
    )


def test_an_uncontrollable_event_is_named_with_the_inputs_that_matter():
    reason = diagnose(model([tank()])).reason
    assert describe_blocking(reason) == (
        "response from `Tank` cannot be prevented, and after it no marked state can be reached;"
        " never in a marked state: `Tank` in `burst`"
    )
    assert [str(step) for step in reason.trace] == ["Tank.measured(x = 3)", "Tank.burst"]
    assert reason.state == {"Tank": "burst", "Tank.level": 3}


def test_inputs_that_do_not_matter_are_not_named():
    sensor = plant(
        "S",
        {"a": [edge("u", to="b", do={"v": "x and y"})], "b": [edge("back", to="a", when="v")]},
        uncontrollable={"u": ["x", "y", "z"], "back": []},
        variables={"v": "bool"},
        inputs={"x": "bool", "y": "bool", "z": "bool"},
    )
    reason = diagnose(model([sensor])).reason
    assert [str(step) for step in reason.trace] == ["S.u(x = false)"]


def test_a_requirement_that_keeps_everything_from_being_marked_is_named():
    action = plant(
        "A",
        {"idle": [edge("c_trigger", to="busy")], "busy": [edge("c_cancel", to="done")], "done": []},
        controllable=["c_trigger", "c_cancel"],
        marked=["done"],
    )
    reason = diagnose(model([action], [disables("c_cancel", "A.busy")])).reason
    assert describe_blocking(reason) == (
        "no marked state can be reached: the shortest way to one needs cancel of `A` where a requirement on the"
        " cancel of `A` forbids it; never in a marked state: `A` in `busy`"
    )
    assert [step.event for step in reason.trace] == ["A.c_trigger", "A.c_cancel"]


@pytest.mark.parametrize(
    ("marked", "who"),
    [([], "never in a marked state: `A` in `x`"), (["x"], "each component can be marked, but never all at once")],
)
def test_plants_that_reach_no_marked_state_are_named(marked, who, monkeypatch):
    """No path is searched if none exists: layer by layer, all states of a large robot would take minutes."""
    monkeypatch.setattr(Layers, "_grow", lambda *_: pytest.fail("it looks for a way"))
    a = plant("A", {"x": [edge("u", to="y")], "y": [edge("v", to="x")]}, uncontrollable=["u", "v"], marked=marked)
    b = plant("B", {"x": [edge("u", to="y")], "y": [edge("v", to="x")]}, marked=["y"])
    synthesis = diagnose(model([a, b]))
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (2, 0)
    assert describe_blocking(synthesis.reason) == f"no marked state can be reached at all; {who}"
    assert synthesis.reason.trace == ()


def test_a_fault_that_shows_only_after_a_round():
    """The only path to the marked state contains the faulty event: leaving it out blocks the states before it."""
    steps = plant(
        "P",
        {
            "start": [edge("slip", to="gate"), edge("other", to="pit")],
            "gate": [edge("enter", to="risky")],
            "risky": [edge("reach", to="goal"), edge("fall", to="pit")],
            "pit": [],
            "goal": [],
        },
        controllable=["enter", "reach", "other"],
        uncontrollable=["slip", "fall"],
        marked=["goal"],
    )
    reason = diagnose(model([steps], [needs("reach", "P.risky")])).reason
    assert [step.event for step in reason.trace] == ["P.slip", "P.enter", "P.fall"]
    assert reason.event.name == "fall"
