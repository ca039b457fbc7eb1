"""The control loop, rule by rule (semantics: the running controller)."""

import pytest

from robosc.engine import ControlLoop, Hooks, Settings
from tests.sct_models import edge, model, plant


class Recorded(ControlLoop):
    """A loop that records events; `did` returns those since its last call. Events in `withheld` are withheld."""

    def __init__(self, made, **settings) -> None:
        self.happened: list[str] = []
        self.withheld: set[str] = set()
        hooks = Hooks(
            lambda event: event not in self.withheld, self.happened.append, lambda: self.happened.append("livelock")
        )
        super().__init__(made, Settings(**settings), hooks)

    def did(self) -> list[str]:
        happened, self.happened[:] = list(self.happened), []
        return happened

    def ticks(self, number: int = 1) -> list[list[str]]:
        def one() -> list[str]:
            self.tick()
            return self.did()

        return [one() for _ in range(number)]

    def batch(self, *events) -> list[str]:
        self.begin()
        for event in events:
            assert self.perform(event)
        self.did()
        self.end()
        return self.did()


def message(name, topic=None, **more):
    return plant(
        name,
        {"ready": [edge("c_trigger")]},
        controllable=["c_trigger"],
        kind="message",
        topic=topic or f"/{name}",
        **more,
    )


def switch(name="switch", states=("off", "on"), **more):
    """Return a plant that goes to a state when the `u_response…` event with the state's number happens."""
    events = [f"u_response{number}" for number, _ in enumerate(states)]
    return plant(
        name, {state: [edge(event, to=to) for event, to in zip(events, states, strict=True)] for state in states},
        uncontrollable=events, **more,
    )  # fmt: skip


def service(name="service"):
    return plant(
        name,
        {
            "idle": [edge("c_trigger", to="waiting")],
            "waiting": [edge("u_response", to="ready")],
            "ready": [edge("c_reset", to="idle")],
        },
        controllable=["c_trigger", "c_reset"],
        uncontrollable=["u_response"],
        kind="service",
        topic="/service",
    )


def data(origin, **conditions):
    steps = [edge(f"c_{name}", to=name, when=condition) for name, condition in conditions.items()]
    return plant(
        f"data_{origin}",
        {"none": steps, **dict.fromkeys([condition for condition in conditions if condition != "none"], steps)},
        controllable=[step.event for step in steps],
        kind="data",
        origin=origin,
    )


# Ticks


def test_a_tick_runs_every_enabled_trigger_once_in_the_order_of_the_model() -> None:
    made = model([message("b"), message("a"), switch(), message("c")], guards={"b.c_trigger": "switch.on"})
    loop = Recorded(made)
    assert loop.ticks(2) == [["a.c_trigger", "c.c_trigger"]] * 2
    loop.perform("switch.u_response1")
    loop.did()
    assert loop.ticks() == [["b.c_trigger", "a.c_trigger", "c.c_trigger"]]


def test_with_a_limit_the_least_recently_run_comes_first() -> None:
    made = model([message("a"), message("b"), message("c")], guards={})
    ticks = Recorded(made, events_per_tick=2).ticks(4)
    assert [event[0] for tick in ticks for event in tick] == list("abcabcab")


def test_cancels_come_first() -> None:
    action = plant(
        "action",
        {"idle": [edge("c_trigger", to="busy")], "busy": [edge("c_cancel", to="idle")]},
        controllable=["c_trigger", "c_cancel"],
        kind="action",
    )
    loop = Recorded(model([message("a"), action], guards={}), events_per_tick=1)
    expected = ["a.c_trigger", "action.c_trigger", "action.c_cancel", "a.c_trigger", "action.c_trigger"]
    assert loop.ticks(5) == [[event] for event in expected]


def test_a_guard_is_asked_when_its_turn_comes() -> None:
    made = model(
        [
            plant("first", {"fresh": [edge("c_trigger", to="used")], "used": []}, controllable=["c_trigger"]),
            plant(
                "follower",
                {"calm": [edge("c_tau1", to="excited", when="first.used")], "excited": []},
                controllable=["c_tau1"],
            ),
            message("second"),
            message("third"),
        ],
        guards={"second.c_trigger": "follower.calm", "third.c_trigger": "follower.excited"},
    )
    assert Recorded(made).ticks(2) == [["first.c_trigger", "follower.c_tau1", "third.c_trigger"], ["third.c_trigger"]]


@pytest.mark.parametrize("topic", ["/cmd", "cmd"])
def test_one_message_on_a_topic_is_sent_in_a_round_and_all_get_their_turn(topic: str) -> None:
    made = model([message("a", "/cmd"), message("b", topic), message("c", "/cmd"), message("d", "/other")], guards={})
    ticks = Recorded(made).ticks(4)
    assert [sorted(tick) for tick in ticks] == [
        ["a.c_trigger", "d.c_trigger"],
        ["b.c_trigger", "d.c_trigger"],
        ["c.c_trigger", "d.c_trigger"],
        ["a.c_trigger", "d.c_trigger"],
    ]


def test_what_is_withheld_does_not_happen_and_does_not_lose_its_turn() -> None:
    loop = Recorded(model([message("a"), message("b")], guards={}), events_per_tick=1)
    loop.withheld = {"a.c_trigger"}
    assert loop.ticks(2) == [["b.c_trigger"]] * 2
    assert not loop.perform("a.c_trigger")
    loop.withheld = set()
    assert loop.ticks() == [["a.c_trigger"]]


def test_what_comes_in_can_not_be_withheld() -> None:
    loop = Recorded(model([switch()], guards={}))
    loop.withheld = {"switch.u_response1"}
    assert loop.perform("switch.u_response1")


def test_a_withheld_silent_event_is_asked_again_and_keeps_no_other_from_happening() -> None:
    steppers = [
        plant(name, {"x": [edge("c_tau1", to="y")], "y": []}, controllable=["c_tau1"]) for name in ("first", "second")
    ]
    loop = Recorded(model(steppers, guards={}))
    loop.withheld = {"first.c_tau1"}
    assert loop.ticks(2) == [["second.c_tau1"], []]
    loop.withheld = set()
    loop.begin()
    loop.end()
    assert loop.did() == ["first.c_tau1"]


def test_settling_alone_runs_cancels_and_no_triggers() -> None:
    """A supervisory layer needs this: the controller starts goals, the layer cancels them."""
    ride = plant(
        "ride",
        {"idle": [edge("c_trigger", to="running")], "running": [edge("c_cancel", to="idle")]},
        controllable=["c_trigger", "c_cancel"],
        kind="action",
    )
    loop = Recorded(model([switch(), ride, message("a")], guards={"ride.c_cancel": "switch.on"}))
    loop.settle()
    assert loop.perform("ride.c_trigger")
    loop.settle()
    assert loop.did() == ["ride.c_trigger"]
    assert loop.perform("switch.u_response1")
    loop.settle()
    assert loop.did() == ["switch.u_response1", "ride.c_cancel"]


# Settling


def test_silent_events_take_turns() -> None:
    ring = [
        plant(
            name,
            {"x": [edge("c_tau1", when="switch.on and turns.n < 5", do={"k": "k + 1"}), edge("turns.count")]},
            controllable=["c_tau1"],
            variables={"k": "0..9"},
        )
        for name in "abc"
    ]
    turns = plant(
        "turns",
        {"x": [*(edge(f"{name}.c_tau1", do={"n": "n + 1"}) for name in "abc"), edge("count", do={"n": "0"})]},
        uncontrollable=["count"],
        variables={"n": "0..5"},
    )
    loop = Recorded(model([*ring, turns, switch()], guards={}))
    assert loop.batch("switch.u_response1") == [f"{name}.c_tau1" for name in "abcab"]
    assert loop.batch("turns.count") == [f"{name}.c_tau1" for name in "cabca"]


def test_a_livelock_is_reported_once_until_the_robot_has_rested() -> None:
    spinner = plant("spinner", {"x": [edge("c_tau1", when="switch.on")]}, controllable=["c_tau1"])
    loop = Recorded(model([spinner, message("a"), switch()], guards={}))
    spins = ["spinner.c_tau1"] * 18
    assert loop.batch("switch.u_response1") == [*spins, "livelock"]
    assert loop.ticks(2) == [[*spins, "a.c_trigger", *spins]] * 2
    assert loop.batch("switch.u_response0") == []
    assert loop.batch("switch.u_response1") == [*spins, "livelock"]


def test_a_proved_bound_takes_the_place_of_the_usual_one() -> None:
    spinner = plant("spinner", {"x": [edge("c_tau1")]}, controllable=["c_tau1"])
    made = model([spinner], guards={})
    made.supervisor.settlingBound = 3
    assert Recorded(made).ticks() == [["spinner.c_tau1"] * 3 + ["livelock"]]


def test_the_bound_itself_is_no_livelock() -> None:
    counter = plant(
        "counter",
        {"x": [edge("c_tau1", when="n < 3", do={"n": "n + 1"})]},
        controllable=["c_tau1"],
        variables={"n": "0..3"},
    )
    made = model([counter], guards={})
    made.supervisor.settlingBound = 3
    assert Recorded(made).ticks(2) == [["counter.c_tau1"] * 3, []]


def test_data_is_the_first_statement_whose_condition_holds() -> None:
    plants = [
        switch(states=("off", "on", "both")),
        message("a", origin="a"),
        data("a", d1="switch.on or switch.both", d2="switch.both or switch.off", none="false"),
    ]
    loop = Recorded(model(plants, guards={}))
    assert loop.ticks(2) == [["data_a.c_d2", "a.c_trigger"], ["a.c_trigger"]]
    loop.batch("switch.u_response2")
    assert loop.state["data_a"] == "d1"


def test_data_settles_after_each_silent_event() -> None:
    stepper = plant(
        "stepper",
        {"x": [edge("c_tau1", to="y")], "y": [edge("c_tau2", to="z")], "z": []},
        controllable=["c_tau1", "c_tau2"],
    )
    loop = Recorded(model([stepper, data("a", d1="stepper.y", d2="stepper.z", none="stepper.x")], guards={}))
    assert loop.ticks() == [["stepper.c_tau1", "data_a.c_d1", "stepper.c_tau2", "data_a.c_d2"]]


# Batches and reactions


def reacting(**settings):
    made = model(
        [switch(), message("a"), message("b"), service()],
        guards={"a.c_trigger": "switch.on", "service.c_trigger": "switch.on"},
    )
    return Recorded(made, **settings)


def test_what_a_batch_makes_possible_runs_at_its_end() -> None:
    loop = reacting()
    loop.ticks()
    assert loop.batch("switch.u_response1") == ["a.c_trigger", "service.c_trigger"]
    assert loop.batch("switch.u_response1") == []


def test_the_limit_of_reactions_holds_between_ticks() -> None:
    loop = reacting(reactions_per_tick=3)
    loop.ticks()
    flicker = [loop.batch(f"switch.u_response{number}") for number in (1, 0, 1, 0, 1)]
    assert flicker == [["a.c_trigger", "service.c_trigger"], [], ["a.c_trigger"], [], []]
    assert loop.ticks() == [["b.c_trigger", "a.c_trigger"]]
    loop.batch("switch.u_response0")
    assert loop.batch("switch.u_response1") == ["a.c_trigger"]


def lidar_and_button(**settings):
    """Return a robot that drives while its lidar sees no obstacle and its button is released, and otherwise stops."""
    lidar, button = switch("lidar", ("free", "blocked")), switch("button", ("released", "pressed"))
    made = model(
        [lidar, button, message("move", "/cmd"), message("halt", "/cmd")],
        guards={
            "move.c_trigger": "lidar.free and button.released",
            "halt.c_trigger": "lidar.blocked or button.pressed",
        },
    )
    loop = Recorded(made, **settings)
    loop.ticks()
    return loop


FREE, BLOCKED, RELEASED, PRESSED = (f"{name}.u_response{number}" for name in ("lidar", "button") for number in range(2))


def test_a_stop_does_not_wait_behind_a_flicker() -> None:
    loop = lidar_and_button(reactions_per_tick=2)
    flicker = [loop.batch(event) for event in (BLOCKED, FREE, BLOCKED, FREE)]
    assert flicker == [["halt.c_trigger"], ["move.c_trigger"], [], []]
    assert loop.batch(PRESSED) == ["halt.c_trigger"]


def test_a_stop_that_the_flicker_has_made_possible_in_vain_does_not_wait_either() -> None:
    loop = lidar_and_button(reactions_per_tick=2)
    for event in (BLOCKED, FREE, BLOCKED):
        loop.batch(event)
    assert loop.enabled("halt.c_trigger")  # not sent: the lidar's count is used up
    assert loop.batch(RELEASED) == [], "a message that changes nothing uses up no count"
    assert loop.batch(PRESSED) == ["halt.c_trigger"]
    assert loop.batch(BLOCKED) == []
    assert loop.ticks() == [["halt.c_trigger"]]
    assert loop.batch(RELEASED) == [], "after a tick nothing is owed"


def test_messages_on_one_topic_have_one_count() -> None:
    lidar = switch("lidar", ("free", "blocked"), kind="message", topic="/scan")
    button = switch("button", ("released", "pressed"), kind="message", topic="scan")
    made = model(
        [lidar, button, message("move"), message("halt")],
        guards={"move.c_trigger": "lidar.free", "halt.c_trigger": "button.pressed"},
    )
    loop = Recorded(made, reactions_per_tick=1)
    loop.ticks()
    assert [loop.batch(event) for event in (BLOCKED, FREE, PRESSED)] == [[], ["move.c_trigger"], []]


def test_there_is_no_reaction_before_the_first_tick_or_where_they_are_off() -> None:
    assert reacting().batch("switch.u_response1") == []
    loop = reacting(react_immediately=False)
    loop.ticks()
    assert loop.batch("switch.u_response1") == []
    assert loop.ticks() == [["a.c_trigger", "service.c_trigger", "b.c_trigger"]]


def test_a_batch_is_seen_whole() -> None:
    loop = reacting()
    loop.ticks()
    assert loop.batch("switch.u_response1", "switch.u_response0") == []
    assert loop.batch("switch.u_response0", "switch.u_response1") == ["a.c_trigger", "service.c_trigger"]


def test_nothing_happens_inside_a_batch() -> None:
    follower = plant("follower", {"x": [edge("c_tau1", to="y", when="switch.on")], "y": []}, controllable=["c_tau1"])
    loop = Recorded(model([switch(), follower, message("a")], guards={"a.c_trigger": "follower.y"}))
    loop.ticks()
    loop.begin()
    loop.perform("switch.u_response1")
    loop.perform("switch.u_response1")
    assert loop.did() == ["switch.u_response1"] * 2
    loop.end()
    assert loop.did() == ["follower.c_tau1", "a.c_trigger"]


def test_new_data_is_sent_at_once() -> None:
    plants = [switch(), message("a", origin="a"), message("b"), data("a", d1="switch.on", none="switch.off")]
    loop = Recorded(model(plants, guards={}))
    loop.ticks()
    assert loop.batch("switch.u_response1") == ["data_a.c_d1", "a.c_trigger"]
    assert loop.batch("switch.u_response1") == []


def test_a_service_cannot_drive_itself_in_a_circle() -> None:
    loop = Recorded(model([service()], guards={}))
    loop.ticks()
    assert loop.batch("service.u_response") == ["service.c_reset"]
    assert loop.batch() == []
    assert loop.ticks(2) == [["service.c_trigger"], []]


def test_reactions_send_one_message_on_a_topic_and_the_rest_waits() -> None:
    made = model(
        [switch(), message("a", "/cmd"), message("b", "/cmd")],
        guards={"a.c_trigger": "switch.on", "b.c_trigger": "switch.on"},
    )
    loop = Recorded(made)
    loop.ticks()
    assert loop.batch("switch.u_response1") == ["a.c_trigger"]
    assert loop.ticks() == [["b.c_trigger"]]


def test_data_arrives_with_its_event() -> None:
    gauge = plant(
        "gauge",
        {"x": [edge("u_response", do={"n": "i"})]},
        uncontrollable={"u_response": ["i"]},
        inputs={"i": "0..9"},
        variables={"n": "0..9"},
    )
    loop = Recorded(model([gauge], guards={}))
    assert loop.enabled("gauge.u_response")
    assert loop.perform("gauge.u_response", {"i": 7})
    assert loop.state["gauge.n"] == 7
