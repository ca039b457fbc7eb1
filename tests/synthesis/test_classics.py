"""Known supervisors, compared down to the text of their guards."""

import pytest

from robosc.model.semantics.printing import SctPrinter
from robosc.model.semantics.roles import event_name
from robosc.synthesis import synthesize
from tests.sct_models import disables, edge, model, needs, plant
from tests.searching import slow_but
from tests.synthesis.classics import counting_buffer, machine_buffer_machine, philosophers
from tests.synthesis.test_against_oracle import check

TEXT = SctPrinter()


def guards(synthesis):
    """Return the requirement and synthesis parts of each nontrivial guard as text."""
    assert synthesis.supervisor is not None
    return {
        event_name(guard.event): tuple(part and TEXT(part) for part in (guard.requirement, guard.synthesis))
        for guard in synthesis.supervisor.guards
        if guard.requirement is not None or guard.synthesis is not None
    }


def test_the_first_machine_waits_for_the_buffer():
    synthesis = synthesize(machine_buffer_machine())
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (12, 6)
    assert guards(synthesis) == {"M1.start1": (None, "B.empty")}


def test_a_requirement_stays_as_it_was_written():
    synthesis = synthesize(counting_buffer())
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (16, 16)
    assert guards(synthesis) == {"M2.start2": ("B.n > 0", None)}


@pytest.mark.parametrize("number", slow_but(["3"], [3, 4, 5]))
def test_philosophers_may_do_anything_but_all_take_the_same_fork(number):
    philosophers_ = philosophers(number)
    synthesis = synthesize(philosophers_)
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (3**number, 3**number - 2)
    check(philosophers_, synthesis)


def test_the_guard_of_a_philosopher_is_one_forbidden_situation():
    synthesis = synthesize(philosophers(4))
    assert guards(synthesis)["P0.left0"] == (None, "!(P1.has_left and P2.has_left and F3.taken)")


@pytest.mark.slow
def test_many_philosophers():
    synthesis = synthesize(philosophers(40))
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (3**40, 3**40 - 2)


def switch(*, marked=("off", "on")):
    return plant(
        "S",
        {"off": [edge("on", to="on")], "on": [edge("off", to="off")]},
        controllable=["on"],
        uncontrollable=["off"],
        marked=marked,
    )


def lamp(**arguments):
    return plant("L", {"only": [edge("light")]}, controllable=["light"], **arguments)


def test_what_the_plants_forbid_anyway_is_not_repeated():
    synthesis = synthesize(model([switch()], [needs("on", "S.off")]))
    assert guards(synthesis) == {}


def test_what_never_holds_is_left_out_of_a_disjunction():
    stuck = plant("T", {"up": [edge("on")], "down": []})
    synthesis = synthesize(model([switch(), lamp(), stuck], [needs("light", "T.down or S.on")]))
    assert guards(synthesis) == {"L.light": ("S.on", None)}


def test_several_requirements_are_a_conjunction_without_repetition():
    requirements = [needs("light", "S.on"), disables("light", "S.off or level == 0")]
    levels = {"level": "0..2"}
    set_level = plant(
        "V",
        {"only": [edge("u", do={"level": "x"})]},
        uncontrollable={"u": ["x"]},
        variables=levels,
        inputs={"x": "0..2"},
    )
    synthesis = synthesize(model([switch(), lamp(), set_level], requirements))
    assert guards(synthesis) == {"L.light": ("S.on and !(V.level = 0)", None)}


def test_an_event_that_no_state_allows_is_never_enabled():
    synthesis = synthesize(model([switch(), lamp()], [needs("light", "S.on and S.off")]))
    light = synthesis.supervisor.guards[1]
    assert (TEXT(light.requirement), light.synthesis, light.everEnabled) == ("false", None, False)


def test_requirements_keep_their_conditions():
    requirement = needs("light", "S.on and not S.off")
    made = model([switch(), lamp()], [requirement])
    synthesis = synthesize(made)
    made.supervisor = synthesis.supervisor
    assert TEXT(made.requirements[0].condition) == "S.on and !S.off"
    assert made.requirements[0].condition.eContainer() is made.requirements[0]
    assert made.plants[0].locations[1] is made.requirements[0].condition.left.location


def filling(*, minimum=0):
    """Return a tank that fills and spills by itself after a command; a measurement can give any level."""
    return model(
        [
            plant(
                "T",
                {
                    "closed": [edge("measured", do={"level": "x"}), edge("open", to="open")],
                    "open": [
                        edge("close", to="closed"),
                        edge("rises", do={"level": "level + 1"}, when=f"level < {minimum + 5}"),
                        edge("spills", to="spilled", when=f"level == {minimum + 5} or level == {minimum + 7}"),
                    ],
                    "spilled": [],
                },
                controllable=["open", "close"],
                uncontrollable={"measured": ["x"], "rises": [], "spills": []},
                variables={"level": f"{minimum}..{minimum + 7}"},
                inputs={"x": f"{minimum}..{minimum + 7}"},
            )
        ]
    )


@pytest.mark.parametrize(("minimum", "text"), [(0, "T.level = 6"), (-6, "T.level = 0"), (-9, "T.level = -3")])
def test_integers_are_compared_with_what_they_may_be(minimum, text):
    tank = filling(minimum=minimum)
    synthesis = synthesize(tank)
    assert guards(synthesis) == {"T.open": (None, text)}
    check(tank, synthesis)


def test_large_ranges_are_no_trouble():
    wide = model(
        [
            plant(
                "R",
                {
                    "calm": [edge("u", do={"n": "x - 3 * y"}), edge("go", to="fast")],
                    "fast": [edge("stop", to="calm"), edge("crash", to="wreck", when="n < -9000 or n >= 29999")],
                    "wreck": [],
                },
                controllable=["go", "stop"],
                uncontrollable={"u": ["x", "y"], "crash": []},
                variables={"n": "-32768..32767"},
                inputs={"x": "-10000..30000", "y": "0..15"},
            )
        ]
    )
    synthesis = synthesize(wide)
    values, wrecks = 10045 + 1 + 30000, (10045 - 9000) + 2
    assert (synthesis.uncontrolled_states, synthesis.controlled_states) == (2 * values + wrecks, 2 * values - wrecks)
    assert guards(synthesis) == {"R.go": (None, "R.n >= -9000 and R.n <= 29998")}


@pytest.mark.parametrize(
    ("value", "reached"),
    [
        ("n + 1", [0, 1, 2, 3]),
        ("n - 1", [0, -1, -2]),
        ("n * 4 - 3", [0, -2]),
        ("-n + 3", [0, 3]),
        ("5 - 2 * n", [0, 3, -1]),
    ],
)
def test_integers_saturate_at_both_bounds(value, reached):
    counter = plant("C", {"only": [edge("u", do={"n": value})]}, uncontrollable=["u"], variables={"n": "-2..3 = 0"})
    counted = model([counter, lamp()], [needs("light", " or ".join(f"C.n == {number}" for number in reached))])
    synthesis = synthesize(counted)
    assert synthesis.uncontrolled_states == len(set(reached))
    assert guards(synthesis) == {}
    check(counted, synthesis)
