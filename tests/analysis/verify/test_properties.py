"""Each property refuted, on minimal models, with its trace and message."""

from typing import Any
from unittest.mock import patch

import pytest

from robosc.analysis.verify import Outcome, Verdict, verify_system
from robosc.analysis.verify.loop import LoopModel
from robosc.model import sct
from robosc.synthesis import acceleration, synthesize
from robosc.synthesis.relation import SymbolicStep
from tests.sct_models import disables, edge, model, needs, plant


def verdict(made: sct.SupervisoryControlModel, name: str) -> Verdict:
    return next(verdict for verdict in verify_system(made) if verdict.property == name)


def refuted(made: sct.SupervisoryControlModel, name: str) -> tuple[str, list[str], list[str], list[str]]:
    """Return the explanation, and the events of the three traces."""
    found = verdict(made, name)
    assert found.outcome is Outcome.REFUTED
    traces = (found.trace, found.onwards, found.other)
    return found.explanation, *([str(step) for step in steps] for steps in traces)


def door() -> Any:
    """Return a door that opens and closes, and may jam while it is open."""
    return plant(
        "door",
        {
            "closed": [edge("c_trigger", to="open")],
            "open": [edge("c_cancel", to="closed"), edge("u_error", to="jammed")],
            "jammed": [edge("u_error")],
        },
        controllable=["c_trigger", "c_cancel"],
        uncontrollable=["u_error"],
    )


def test_blocking() -> None:
    made = model([door()], guards={})
    assert refuted(made, "non-blocking") == (
        "`door` in `jammed` cannot get back to a marked state",
        ["door.c_trigger", "door.u_error"],
        [],
        [],
    )
    made = model([door()], guards={"c_trigger": (None, "false")})
    assert verdict(made, "non-blocking").evidence == "1 state, 1 of them marked"


def test_blocking_together() -> None:
    """Each of the two can be marked again, but not both at once."""
    turn = {"on": [edge("turn.c_trigger", to="off")], "off": [edge("turn.c_trigger", to="on")]}
    made = model(
        [
            plant("turn", turn | {"off": [*turn["off"]]}, controllable=["c_trigger"], marked=["off"]),
            plant("other", turn, marked=["on"]),
        ],
        guards={},
    )
    explanation, *_ = refuted(made, "non-blocking")
    assert explanation == "the marked states of all components cannot be reached together any more"


def test_a_requirement_on_what_can_not_be_prevented() -> None:
    made = model([door()], [disables("u_error", "door.open")], guards={})
    assert refuted(made, "controllability") == (
        "error from `door` cannot be prevented, but a requirement forbids it here",
        ["door.c_trigger"],
        [],
        [],
    )


def test_a_guard_on_what_can_not_be_prevented() -> None:
    made = model([door()], guards={"c_trigger": "true"})
    event = made.plants[0].events[2]
    reference = sct.LocationReference(location=made.plants[0].locations[0])
    made.supervisor.guards.append(sct.EventGuard(event=event, requirement=reference, everEnabled=True))
    assert refuted(made, "controllability") == (
        "error from `door` cannot be prevented, but its guard forbids it here",
        ["door.c_trigger"],
        [],
        [],
    )


def test_a_component_that_does_not_listen() -> None:
    sensor = plant(
        "sensor", {"on": [edge("u_response")]}, uncontrollable=["u_response"], kind="message", origin="A.scan"
    )
    lidar = {
        "free": [edge("sensor.u_response", to="blocked")],
        "blocked": [edge("c_tau1", to="deaf"), edge("sensor.u_response")],
        "deaf": [edge("c_tau1", to="free")],
    }
    made = model([sensor, plant("lidar", lidar, controllable=["c_tau1"], origin="Lidar")], guards={})
    assert refuted(made, "input-enabledness") == (
        "response from `A.scan` can come, but `Lidar` has no transition for it in `deaf`",
        ["sensor.u_response", "lidar.c_tau1"],
        [],
        [],
    )


def tank() -> Any:
    """Return a tank that is filled as its sensor reports."""
    return plant(
        "tank",
        {"any": [edge("c_trigger"), edge("u_response", do={"level": "i_response"})]},
        controllable=["c_trigger"],
        uncontrollable={"u_response": ["i_response"]},
        variables={"level": "0..9"},
        inputs={"i_response": "0..9"},
        origin="Tank",
    )


def test_a_requirement_that_the_supervisor_forgot() -> None:
    requirement = needs("c_trigger", "level < 7", text="requirement drain needs Tank.level < 7")
    made = model([tank()], [requirement], guards={"c_trigger": "tank.level <= 7"})
    name = "requirement drain needs Tank.level < 7"
    assert verdict(made, name).evidence == "happens in 8 states, requires `Tank.level < 7`"
    assert refuted(made, name) == (
        "request to `Tank` can happen where `Tank.level = 7`",
        ["tank.u_response(i_response = 7)", "tank.c_trigger"],
        [],
        [],
    )


def test_what_a_requirement_became_is_told() -> None:
    """The verdict shows the author's text, even if it was transformed."""
    requirement = disables("c_trigger", "level < 7 or tank.any", text="requirement drain needs Tank.level < 7")
    made = model([tank()], [requirement], guards={"c_trigger": "false"})
    assert verdict(made, "requirement drain needs Tank.level < 7").evidence == (
        "happens in 0 states, requires `!(Tank.level < 7 or Tank.any)`"
    )


def test_a_guard_that_forbids_too_much() -> None:
    made = model([tank()], [needs("c_trigger", "level < 7")], guards={"c_trigger": "tank.level < 6"})
    assert verdict(made, "requirement on tank.c_trigger").outcome is Outcome.PROVED
    assert refuted(made, "maximal permissiveness") == (
        "request to `Tank` is forbidden here without a reason",
        ["tank.u_response(i_response = 6)", "tank.c_trigger"],
        [],
        [],
    )


def test_dead_events() -> None:
    made = model([tank()], guards={"c_trigger": "false"})
    assert refuted(made, "no dead events") == ("request to `Tank` can never happen", [], [], [])


def test_cancels_and_data_may_be_dead() -> None:
    drive = plant(
        "drive",
        {"idle": [edge("c_trigger", to="busy")], "busy": [edge("c_cancel", to="idle"), edge("u_response", to="idle")]},
        controllable=["c_trigger", "c_cancel"],
        uncontrollable=["u_response"],
        kind="action",
    )
    assert verdict(model([drive], guards={"c_cancel": "false"}), "no dead events").outcome is Outcome.PROVED


def driving(**cancel: str) -> sct.SupervisoryControlModel:
    """Return an action that needs a free path; `cancel` has the parts of its cancel's guard."""
    drive = plant(
        "drive",
        {"idle": [edge("c_trigger", to="busy")], "busy": [edge("c_cancel", to="idle"), edge("u_response", to="idle")]},
        controllable=["c_trigger", "c_cancel"],
        uncontrollable=["u_response"],
        kind="action",
    )
    way = plant(
        "way",
        {"free": [edge("u_error", to="taken")], "taken": [edge("u_error", to="free")]},
        uncontrollable=["u_error"],
        marked=["free", "taken"],
    )
    requirements = [needs("drive.c_trigger", "way.free"), disables("drive.c_cancel", "way.free")]
    guards = {"drive.c_trigger": ("way.free", None), "drive.c_cancel": tuple(cancel.values())}
    return model([drive, way], requirements, guards=guards)


def test_a_cancel_that_is_due_can_happen() -> None:
    due = driving(requirement="way.taken", synthesis="true")
    found = verdict(due, "cancel when due")
    assert (found.outcome, found.evidence) == (Outcome.PROVED, "4 states, 1 action that requirements cancel")
    assert refuted(driving(requirement="false", synthesis="true"), "cancel when due") == (
        "a requirement on the start of `drive` does not hold, and its cancel cannot happen",
        ["drive.c_trigger", "way.u_error"],
        [],
        [],
    )
    assert refuted(driving(requirement="way.taken", synthesis="false"), "cancel when due")[1] == [
        "drive.c_trigger",
        "way.u_error",
    ]
    assert verdict(due, "controllability").outcome is Outcome.PROVED


def test_only_actions_that_requirements_cancel_have_a_row() -> None:
    assert "cancel when due" not in {found.property for found in verify_system(model([door()], guards={}))}


def test_a_livelock() -> None:
    lamp = {
        "off": [edge("c_trigger", to="on")],
        "on": [edge("c_tau1", to="dim")],
        "dim": [edge("c_tau2", to="bright")],
        "bright": [edge("c_tau3", to="dim"), edge("c_cancel", to="off")],
    }
    taus = ["c_tau1", "c_tau2", "c_tau3"]
    made = model([plant("lamp", lamp, controllable=["c_trigger", "c_cancel", *taus])], guards={})
    assert refuted(made, "finite response") == (
        "2 silent events can happen again and again, and no other event happens then",
        ["lamp.c_trigger", "lamp.c_tau1"],
        ["lamp.c_tau2", "lamp.c_tau3"],
        [],
    )
    assert refuted(made, "bounded response")[0] == "silent events need not come to rest: see finite response"
    assert refuted(made, "non-blocking in the control loop") == (
        "`lamp` in `on` cannot get back to a marked state",
        ["lamp.c_trigger"],
        [],
        [],
    )
    assert verdict(made, "non-blocking").outcome is Outcome.PROVED
    assert synthesize(made).supervisor.settlingBound is None


def test_a_silent_event_that_changes_nothing_never_rests() -> None:
    made = model([plant("lamp", {"on": [edge("c_tau1")]}, controllable=["c_tau1"])], guards={})
    assert refuted(made, "finite response") == (
        "1 silent event can happen again and again, and no other event happens then",
        [],
        ["lamp.c_tau1"],
        [],
    )
    assert verdict(made, "confluence").outcome is Outcome.PROVED
    assert synthesize(made).supervisor.settlingBound is None


def timer() -> Any:
    """Return a timer that counts down by itself."""
    return plant(
        "timer",
        {
            "on": [
                edge("u_response", do={"left": "i_response"}),
                edge("c_tau1", when="left > 0", do={"left": "left - 1"}),
            ]
        },
        controllable=["c_tau1"],
        uncontrollable={"u_response": ["i_response"]},
        variables={"left": "0..40"},
        inputs={"i_response": "0..40"},
    )


def test_the_bound_is_proved_and_kept() -> None:
    made = model([timer()], guards={})
    assert verdict(made, "bounded response").evidence == "41 states, at most 40 silent events in a row"
    assert synthesize(made).supervisor.settlingBound == 40


def test_bounds_of_what_has_nothing_to_do_with_each_other_add_up() -> None:
    def other() -> Any:
        edges = {"a": [edge("u_error", to="b")], "b": [edge("c_reset", to="a")]}
        return plant("other", edges, controllable=["c_reset"], uncontrollable=["u_error"])

    made = model([timer(), other()], guards={})
    assert synthesize(made).supervisor.settlingBound == 41
    # This guard makes one wait for the other.
    made = model([timer(), other()], guards={"c_reset": (None, "timer.left == 0")})
    assert verdict(made, "bounded response").evidence == "82 states, at most 41 silent events in a row"


def test_a_bound_that_is_too_low() -> None:
    made = model([timer()], guards={})
    made.supervisor.settlingBound = 2
    assert refuted(made, "bounded response") == (
        "according to the supervisor, at most 2 silent events happen in a row",
        ["timer.u_response(i_response = 3)"],
        ["timer.c_tau1"] * 3,
        [],
    )
    made.supervisor.settlingBound = 50
    assert verdict(made, "bounded response").outcome is Outcome.PROVED


def test_two_orders_that_end_differently() -> None:
    gate = {"shut": [edge("c_tau1", to="open", when="light.red")], "open": []}
    light = {"red": [edge("c_tau1", to="green", when="gate.shut")], "green": []}
    everywhere = ["shut", "open", "red", "green"]
    made = model(
        [
            plant("gate", gate, controllable=["c_tau1"], marked=everywhere, origin="Gate"),
            plant("light", light, controllable=["c_tau1"], marked=everywhere, origin="Light"),
        ],
        guards={},
    )
    ends = "`Gate.shut and Light.green` or where `Gate.open and Light.red`"
    assert refuted(made, "confluence") == (
        f"depending on their order, silent events end where {ends}",
        [],
        ["light.c_tau1"],
        ["gate.c_tau1"],
    )


def scan(name: str, origin: str) -> Any:
    return plant(
        name,
        {"ready": [edge("u_response")]},
        uncontrollable=["u_response"],
        kind="message",
        topic="/scan",
        origin=origin,
    )


def bolt(*leaving: Any, **others: Any) -> Any:
    """Return a bolt that leaves its halfway position by itself, unless another event comes first."""
    locations = {
        "in": [edge("far.u_response", to="halfway"), edge("near.u_response")],
        "halfway": [edge("c_tau1", to="out"), edge("far.u_response"), *leaving],
        "out": [edge("far.u_response"), edge("near.u_response")],
        **others,
    }
    taus = sorted({edge.event for edges in locations.values() for edge in edges if edge.event.startswith("c_tau")})
    return plant("bolt", locations, controllable=taus, marked=list(locations), origin="Bolt")


def test_a_message_comes_when_silent_events_have_happened() -> None:
    """Another order needs a second message while a silent event is pending, which never happens."""
    torn = [edge("c_tau2", to="out"), edge("c_tau3", to="in")]
    messages = [scan("far", "A.far"), plant("near", {"r": [edge("u_response")]}, uncontrollable=["u_response"])]
    made = model(
        [
            *messages,
            bolt(edge("near.u_response", to="torn"), torn=[*torn, edge("far.u_response"), edge("near.u_response")]),
        ]
    )
    made.supervisor = synthesize(made).supervisor
    assert verdict(made, "confluence").outcome is Outcome.PROVED
    assert verdict(made, "confluence").evidence == "3 states, 2 of them at rest"


def test_the_events_of_one_message_come_together() -> None:
    """The events of one message happen without interruption, also from the initial state."""
    torn = [edge("c_tau2", to="out"), edge("c_tau3", to="in"), edge("far.u_response"), edge("near.u_response")]
    made = model([scan("far", "A.far"), scan("near", "A.near"), bolt(edge("near.u_response", to="torn"), torn=torn)])
    made.supervisor = synthesize(made).supervisor
    assert refuted(made, "confluence") == (
        "depending on their order, silent events end where `Bolt.in` or where `Bolt.out`",
        ["far.u_response", "near.u_response"],
        ["bolt.c_tau3"],
        ["bolt.c_tau2"],
    )
    # In text order: otherwise the bolt is not yet halfway.
    made = model([scan("near", "A.near"), scan("far", "A.far"), bolt(edge("near.u_response", to="torn"), torn=torn)])
    made.supervisor = synthesize(made).supervisor
    assert verdict(made, "confluence").outcome is Outcome.PROVED


def test_what_has_failed_is_reset_later() -> None:
    """Messages may come while the reset after an error is held back, but not while the reset after a success is."""

    def machine(failing: str) -> sct.SupervisoryControlModel:
        call = {
            "idle": [edge("c_trigger", to="waiting")],
            "waiting": [edge(failing, to="over")],
            "over": [edge("c_reset", to="idle")],
        }
        own = ["u_error", "u_response"]
        call["waiting"] += [edge(event) for event in own if event != failing]
        watch = {
            "off": [edge("far.u_response", to="torn", when="call.over")],
            "torn": [edge("c_tau1", to="one"), edge("c_tau2", to="other"), edge("far.u_response")],
            "one": [edge("far.u_response")],
            "other": [edge("far.u_response")],
        }
        made = model(
            [
                scan("far", "A.far"),
                plant("call", call, controllable=["c_trigger", "c_reset"], uncontrollable=own, kind="service"),
                plant("watch", watch, controllable=["c_tau1", "c_tau2"], marked=list(watch)),
            ]
        )
        made.supervisor = synthesize(made).supervisor
        return made

    assert refuted(machine("u_error"), "confluence")[1] == ["call.c_trigger", "call.u_error", "far.u_response"]
    assert verdict(machine("u_response"), "confluence").outcome is Outcome.PROVED


def test_a_marked_state_that_is_left_at_once() -> None:
    """The loop never rests in this state, so no plant can be left there."""
    made = model(
        [
            plant(
                "lamp",
                {"on": [edge("c_tau1", to="off")], "off": [edge("u_response", to="on")]},
                controllable=["c_tau1"],
                uncontrollable=["u_response"],
            )
        ]
    )
    made.supervisor = synthesize(made).supervisor
    assert verdict(made, "non-blocking").outcome is Outcome.PROVED
    assert refuted(made, "non-blocking in the control loop")[0] == (
        "the control loop never again rests in a state in which all components are marked"
    )


def test_what_waits_for_silent_events_may_wait_for_ever() -> None:
    """The path back exists only in a state in which the loop does not use it: the silent event goes first."""
    arm = {
        "home": [edge("c_trigger", to="out")],
        "out": [edge("c_tau1", to="far"), edge("u_response", to="home")],
        "far": [edge("u_response")],
    }
    made = model([plant("arm", arm, controllable=["c_trigger", "c_tau1"], uncontrollable=["u_response"])], guards={})
    assert refuted(made, "non-blocking in the control loop")[1] == ["arm.c_trigger"]
    arm["far"] = [edge("u_response", to="out")]
    made = model([plant("arm", arm, controllable=["c_trigger", "c_tau1"], uncontrollable=["u_response"])], guards={})
    assert verdict(made, "non-blocking").outcome is Outcome.PROVED
    assert refuted(made, "non-blocking in the control loop") == (
        "`arm` in `out` cannot get back to a marked state",
        ["arm.c_trigger"],
        [],
        [],
    )


def counter() -> Any:
    """Return a tank that counts messages while it is open, and restarts by itself after each 65,535th."""
    return plant(
        "tank",
        {
            "closed": [edge("c_trigger", to="open"), edge("u_error", do={"level": "0"})],
            "open": [
                edge("u_response", do={"level": "level + 1"}),
                edge("c_cancel", to="closed"),
                edge("c_tau1", when="level == 65534", do={"level": "0"}, to="closed"),
            ],
        },
        controllable=["c_trigger", "c_cancel", "c_tau1"],
        uncontrollable=["u_response", "u_error"],
        variables={"level": "0..65535 = 0"},
    )


@pytest.mark.parametrize("name", ["confluence", "non-blocking in the control loop"])
def test_a_wide_integer_that_the_control_loop_counts(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    images = []
    image = SymbolicStep.image
    monkeypatch.setattr(SymbolicStep, "image", lambda step, states: images.append(step) or image(step, states))
    found = verdict(model([counter()], guards={}), name)
    assert found.outcome is Outcome.PROVED
    assert found.evidence.startswith("131,069 states")
    assert len(images) < 2000


@pytest.mark.parametrize("name", ["confluence", "non-blocking in the control loop"])
def test_a_wide_integer_that_takes_too_many_turns(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LoopModel, "states", property(endless))
    found = verdict(model([counter()], guards={}), name)
    assert (found.outcome, found.evidence) == (Outcome.SKIPPED, "")
    assert found.explanation.startswith("the range of level, 65536 values, is too wide")


def endless(loop: LoopModel) -> None:
    """Emulate acceleration that gives up, as when its steps get large."""
    with (
        patch.object(acceleration, "_HOPELESS", 64),
        patch.object(acceleration.Acceleration, "_closed", lambda *_: None),
    ):
        loop._after(loop.system.encoding.initial, loop._waits)


def test_counting_is_given_up_at_some_point() -> None:
    made = model([timer()], guards={})
    with patch("robosc.analysis.system._EFFORT", 100):
        for name in ("finite response", "bounded response"):
            found = verdict(made, name)
            assert (found.outcome, found.trace) == (Outcome.SKIPPED, ())
            assert "too many steps" in found.explanation
    with patch("robosc.synthesis.COMPLETION_EFFORT", 100):
        assert synthesize(made).supervisor.settlingBound is None
