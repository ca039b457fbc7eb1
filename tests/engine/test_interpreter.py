import pytest

from robosc.engine import Blocked, Engine
from tests.sct_models import edge, model, needs, plant


def machine(guards=None, **changes):
    """Return a counter that a button drives and a lamp that follows it."""
    arguments = {
        "plants": [
            plant(
                "button",
                {"up": [edge("u_response")]},
                uncontrollable={"u_response": ["i_by", "i_mood"]},
                inputs={"i_by": "-3..3", "i_mood": "Mood"},
                kind="message",
                origin="Button.pressed",
            ),
            plant(
                "component_Counter",
                {
                    "low": [
                        edge("button.u_response", do={"n": "n + button.i_by", "mood": "button.i_mood"}),
                        edge("c_tau1", to="high", when="n >= 4", do={"n": "m", "m": "n"}),
                    ],
                    "high": [edge("button.u_response", do={"n": "n - 1"}), edge("c_tau1", to="low")],
                },
                controllable=["c_tau1"],
                variables={"n": "0..5", "m": "0..3 = 2", "mood": "Mood", "armed": "bool = true"},
                origin="Counter",
            ),
            plant("message_lamp", {"ready": [edge("c_trigger")]}, controllable=["c_trigger"], kind="message"),
        ],
        "requirements": [needs("message_lamp.c_trigger", "component_Counter.high")],
        "enumerations": {"Mood": ["calm", "angry"]},
        "guards": {"message_lamp.c_trigger": "component_Counter.high", "c_tau1": (None, "armed")}
        if guards is None
        else guards,
    }
    return model(**arguments | changes)


def test_the_state_is_a_mapping_with_the_names_of_reports() -> None:
    state = Engine(machine()).state
    assert dict(state) == {
        "component_Counter": "low",
        "Counter.n": 0,
        "Counter.m": 2,
        "Counter.mood": "calm",
        "Counter.armed": True,
    }


def test_events_are_named_with_their_plant_in_the_order_of_the_model() -> None:
    assert Engine(machine()).events == ("button.u_response", "component_Counter.c_tau1", "message_lamp.c_trigger")


def test_updates_read_the_values_before_and_saturate() -> None:
    engine = Engine(machine())
    for expected in (3, 5, 5):
        assert engine.perform("button.u_response", {"i_by": 3, "i_mood": "angry"})
        assert engine.state["Counter.n"] == expected
    assert engine.perform("component_Counter.c_tau1")
    assert (engine.state["Counter.n"], engine.state["Counter.m"]) == (2, 3)


def test_inputs_saturate_and_stay_until_they_are_set_again() -> None:
    engine = Engine(machine())
    engine.perform("button.u_response", {"i_by": 1000})
    assert engine.state["Counter.n"] == 3
    engine.perform("button.u_response")
    assert engine.state["Counter.n"] == 5


def test_what_blocks_an_event_comes_in_order() -> None:
    engine = Engine(machine())
    assert engine.blocked_by("component_Counter.c_tau1") is Blocked.PLANT
    assert engine.blocked_by("message_lamp.c_trigger") is Blocked.REQUIREMENT
    assert engine.blocked_by("button.u_response") is None
    engine = Engine(machine(guards={"c_trigger": ("component_Counter.high", "false"), "c_tau1": "n < 5"}))
    before = engine.state
    assert not engine.perform("message_lamp.c_trigger")
    assert engine.state == before
    engine.perform("button.u_response", {"i_by": 3})
    engine.perform("button.u_response", {"i_by": 1})
    engine.perform("component_Counter.c_tau1")
    assert engine.blocked_by("message_lamp.c_trigger") is Blocked.SYNTHESIS
    assert not engine.enabled("message_lamp.c_trigger")


def test_all_plants_of_an_event_take_part() -> None:
    made = model(
        [
            plant(
                "a", {"x": [edge("go", to="y", do={"v": "b.w"})], "y": []}, controllable=["go"], variables={"v": "0..9"}
            ),
            plant(
                "b",
                {"x": [edge("a.go", to="y", when="w > 0", do={"w": "a.v"})], "y": [edge("set", to="x", do={"w": "7"})]},
                controllable=["set"],
                variables={"w": "0..9"},
                initial="y",
            ),
        ],
        guards={},
    )
    engine = Engine(made)
    assert not engine.enabled("a.go")
    assert engine.perform("b.set")
    assert engine.perform("a.go")
    assert dict(engine.state) == {"a": "y", "a.v": 7, "b": "y", "b.w": 0}


def test_a_state_is_a_value() -> None:
    engine, other = Engine(machine()), Engine(machine())
    before = engine.state
    engine.perform("button.u_response", {"i_by": 2})
    after = engine.state
    assert before["Counter.n"] == 0
    assert before != after
    assert len({before, after, engine.state}) == 2
    engine.state = before
    assert engine.state == before == other.state
    with pytest.raises(ValueError, match="another engine"):
        engine.state = other.state


def test_data_of_another_type_is_refused() -> None:
    engine = Engine(machine())
    for value in (True, "calm", None):
        with pytest.raises(ValueError, match="none of the values: an integer"):
            engine.perform("button.u_response", {"i_by": value})
    with pytest.raises(ValueError, match="calm, angry"):
        engine.perform("button.u_response", {"i_mood": "furious"})
    with pytest.raises(KeyError):
        engine.perform("button.u_response", {"unheard_of": 1})


def test_a_model_without_supervisor_does_not_run() -> None:
    made = machine()
    made.supervisor = None
    with pytest.raises(ValueError, match="no supervisor"):
        Engine(made)
    incomplete = machine()
    del incomplete.supervisor.guards[0]
    with pytest.raises(ValueError, match=r"no guard for component_Counter\.c_tau1"):
        Engine(incomplete)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("implies(true, false)", False),
        ("implies(false, false)", True),
        ("n - 2 * m < -3", True),
        ("-n == 0 and m != 3", True),
        ("(1 if armed else 2) == 1", True),
        ("not (mood == angry) or low", True),
        ("m <= 1 or m > 2 or m >= 4", False),
        ("message_lamp.ready", True),
        ("(n < m) == high", False),
    ],
)
def test_expressions(text: str, expected: bool) -> None:
    text = text.replace("low", "component_Counter.low").replace("high", "component_Counter.high")
    engine = Engine(machine(guards={"message_lamp.c_trigger": text, "c_tau1": "true"}))
    assert engine.enabled("message_lamp.c_trigger") is expected


@pytest.mark.parametrize("text", ["1 / 2 > 0", "double(n) > 0", "0.5 > 0"])
def test_no_sct_model_holds_doubles(text: str) -> None:
    with pytest.raises(ValueError, match="an sct model holds no"):
        Engine(machine(guards={"message_lamp.c_trigger": text}))
