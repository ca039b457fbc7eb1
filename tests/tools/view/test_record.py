"""The data sent to a page agree with the engine, whatever is done to a run."""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.engine import Blocked
from robosc.run.simulation import DataError, Simulation, read_script
from robosc.run.simulation.script import ScriptStep
from robosc.run.simulation.simulation import whole_state
from robosc.tools.view.moments import ActionError
from tests.searching import examples

from .robots import Viewer, record, wholes

if TYPE_CHECKING:
    from robosc.tools.view.record import Record

_, SHARED, _ = record()
EVENTS = ["message_open.c_trigger", "message_close.c_trigger", "message_car.u_response", "component_Barrier.u_after1"]
ACTIONS = st.one_of(
    st.builds(lambda event: {"action": "perform", "event": event, "inputs": {}}, st.sampled_from(EVENTS[:2])),
    st.builds(lambda value: {"action": "perform", "event": EVENTS[2], "inputs": {"i_response": value}}, st.booleans()),
    st.builds(lambda seconds: {"action": "wait", "seconds": seconds}, st.sampled_from([0, 0.5, 1.9, 2.0, 7])),
    st.builds(lambda number: {"action": "random", "number": number}, st.integers(1, 5)),
    st.builds(lambda moment: {"action": "continue", "moment": moment}, st.integers(0, 12)),
    st.sampled_from([{"action": "undo"}, {"action": "redo"}, {"action": "restart"}]),
)


def assert_true(shown: Record, simulation: Simulation) -> None:
    """Check each moment against an engine that performs the same events."""
    engine = simulation.engine
    for moment, whole in zip(shown.moments, wholes(shown.moments), strict=True):
        if "event" in moment and moment["event"] != "wait" and "by" not in moment:
            assert simulation.perform(moment["event"], moment["data"]).accepted
        assert whole["state"] == whole_state(engine)
        assert set(whole["enabled"]) == set(simulation.enabled)
        assert whole["commands"] == {
            command: None
            if (by := engine.blocked_by(command)) is None
            else {"by": str(by), "reason": simulation.reason(command, by)}
            for command in ("message_open.c_trigger", "message_close.c_trigger")
        }


@pytest.mark.slow
@settings(max_examples=examples(30))
@given(st.lists(ACTIONS, max_size=25))
def test_moments_say_what_the_engine_says(actions: list[dict[str, Any]]) -> None:
    SHARED.do({"action": "restart"})
    for action in actions:
        try:
            SHARED.do(json.loads(json.dumps(action)))
        except ActionError:
            continue
    assert_true(SHARED, record()[2])


def test_an_action_that_is_none_changes_nothing() -> None:
    _, shown, _ = record()
    before = list(shown.moments)
    for action in [
        *([], None, "undo", {}, {"action": "fly"}, {"action": "wait"}, {"action": "wait", "seconds": -1}),
        *(
            {"action": "wait", "seconds": 1e9},
            {"action": "random", "number": 10**9},
            {"action": "random", "number": "a"},
        ),
        *({"action": "continue", "moment": 1}, {"action": "continue", "moment": -1}, {"action": "perform"}),
        {"action": "perform", "event": "message_move.c_trigger"},
        {"action": "perform", "event": EVENTS[2], "inputs": {}},
        {"action": "perform", "event": EVENTS[2], "inputs": {"i_response": [3]}},
        {"action": "perform", "event": EVENTS[2], "data": [3]},
        {"action": "perform", "event": EVENTS[2], "data": {"value": "no boolean"}},
        {"action": "perform", "event": EVENTS[1], "inputs": {}},
        *({"action": "perform", "event": EVENTS[0], "inputs": {}, "kept": kept} for kept in (1, [1], [[["x"], 1]])),
    ]:
        with pytest.raises((ActionError, DataError)):
            shown.do(action)
        assert shown.moments == before


def test_a_refusal_says_why() -> None:
    _, shown, _ = record()
    for _ in range(3):
        for event, inputs in ((EVENTS[0], {}), (EVENTS[2], {"i_response": True}), (EVENTS[1], {})):
            shown.do({"action": "perform", "event": event, "inputs": inputs})
    with pytest.raises(ActionError, match="no more than three"):
        shown.do({"action": "perform", "event": EVENTS[0], "inputs": {}})


def test_a_script_is_played_with_what_it_asks_in_vain() -> None:
    steps = [ScriptStep(1, EVENTS[1], {}), ScriptStep(2, EVENTS[0], {}), ScriptStep(3, "wait", {"seconds": 3})]
    _, shown, simulation = record(steps=steps)
    assert [moment.get("event") for moment in shown.moments] == [None, EVENTS[1], EVENTS[0], EVENTS[3], "wait"]
    assert [moment.get("by") for moment in shown.moments] == [None, Blocked.PLANT, None, None, None]
    assert [moment["time"] for moment in shown.moments] == [0, 0, 0, 2, 3]
    assert shown.moments[2]["timers"] == {EVENTS[3]: 2000}
    assert shown.moments[3]["timers"] == {EVENTS[3]: False}
    assert_true(shown, simulation)
    # The user can continue by hand from any moment.
    shown.do({"action": "continue", "moment": 2})
    shown.do({"action": "perform", "event": EVENTS[1], "inputs": {}})
    assert [moment.get("event") for moment in shown.moments] == [None, EVENTS[1], EVENTS[0], EVENTS[1]]
    assert_true(shown, record()[2])


def test_reasons_of_errors_and_refused_cancels() -> None:
    text = (Path(__file__).parents[2] / "run" / "simulation" / "crane.rscd").read_text()
    lines = ["request to go", "refuse cancel of go", 'error from go because aborted with {"path": [0.0, 0.25, 2.5]}']
    description, _, simulation = record(text)
    steps, findings = read_script("", "\n".join(lines), simulation.engine.events, model=simulation.engine.model)
    assert findings == []
    _, shown, _ = record(text, steps)
    assert [(moment.get("words"), moment.get("by")) for moment in shown.moments[1:]] == [
        ("request to Base.go", None),
        ("refusal to cancel Base.go", "plant"),
        ("error from Base.go", None),
    ]
    assert shown.moments[2]["reason"] == "its goal is not being canceled"
    assert shown.moments[3]["state"] == {
        "action_go": "error",
        "component_Base": "low",
        "Base.why": "aborted",
        "Base.rest": 2.5,
    }
    # By hand, the user can choose the service's reasons, and the page shows the reason of an error.
    inputs = {event: about["inputs"] for event, about in description["events"].items()}  # type: ignore[attr-defined]
    assert inputs["service_lift.u_error"] == [
        {"name": "i_error_reason", "label": "error", "values": ["unavailable", "timeout", "unreadable", "failed"]}
    ]
    shown.do({"action": "restart"})
    shown.do({"action": "perform", "event": "message_stop.u_response", "inputs": {"i_response": True}})
    shown.do({"action": "perform", "event": "service_lift.c_trigger", "inputs": {}})
    shown.do({"action": "perform", "event": "service_lift.u_error", "inputs": {"i_error_reason": "timeout"}})
    assert shown.moments[-1]["data"] == {"reason": "timeout"}
    assert shown.moments[-1]["state"]["component_Base"] == "unknown"


def test_transitions_that_are_taken_are_those_of_the_text() -> None:
    description, shown, _ = record()
    (barrier,) = description["automata"]  # type: ignore[misc]
    for event, inputs in ((EVENTS[0], {}), (EVENTS[2], {"i_response": True}), (EVENTS[2], {"i_response": False})):
        shown.do({"action": "perform", "event": event, "inputs": inputs})
    taken = [moment.get("transitions") for moment in shown.moments]
    # `false` for a car takes no transition and changes no state.
    assert [edges and barrier["transitions"][edges[0][1]]["label"] for edges in taken] == [
        None,
        "on request to open",
        "on response from car if value do cars := min(cars + 1, 3)",
        [],
    ]


def test_a_label_is_the_text_without_comments() -> None:
    """A string may contain text that looks like a comment or a target, and keeps its blanks."""
    text = """robot Urls {
  component Base {
    outgoing message moved with type: none
    behaviour {
      variable url: string
      initial marked state idle {
        on response /* here */ from moved // there
          do url := "http://host/a  goto b" goto driving
      }
      marked state driving { on response from moved do url := "goto x" }
    }
  }
}
"""
    description, _, _ = record(text)
    (base,) = description["automata"]  # type: ignore[misc]
    assert [(shown["label"], shown["whole"]) for shown in base["transitions"]] == [
        (
            'on response from moved do url := "http://host/a  goto b"',
            'on response from moved do url := "http://host/a  goto b" goto driving',
        ),
        ('on response from moved do url := "goto x"',) * 2,
    ]


def test_explained() -> None:
    _, shown, _ = record()
    told_of = shown.explain(0, EVENTS[1])
    assert not told_of["allowed"]
    assert told_of["way"] == "request to `Barrier.open`"
    for moment, event in ((1, EVENTS[1]), (-1, EVENTS[1]), (0, "nothing")):
        with pytest.raises(ActionError):
            shown.explain(moment, event)


@settings(max_examples=examples(15))
@given(st.lists(st.tuples(ACTIONS, st.booleans()), max_size=15))
def test_every_viewer_sees_the_same(actions: list[tuple[dict[str, Any], bool]]) -> None:
    """One viewer reads occasionally and one connects late: both know the same moments at the end."""

    async def view() -> None:
        _, shown, _ = record() if not actions else (None, SHARED, None)
        shown.do({"action": "restart"})
        early = Viewer(shown)
        await early.read()
        for action, reads in actions:
            before = (len(shown.cuts), len(shown.moments))
            with suppress(ActionError):
                shown.do(action)
            if reads and before != (len(shown.cuts), len(shown.moments)):
                await early.read()
        late = Viewer(shown)
        for viewer in (early, late):
            while viewer.moments != shown.moments:
                await viewer.read()

    asyncio.run(view())
