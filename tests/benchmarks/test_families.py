"""The robots of the benchmarks are valid and have the documented numbers of states."""

import pytest
from robosc_faudes.automata import faudes_states, plants, requirements

import robosc
from benchmarks.families import FAMILIES
from benchmarks.scaling import INTERFACES
from benchmarks.scaling_run import Costs
from robosc.synthesis import synthesize
from tests.sct_models import edge, model, needs, plant
from tests.synthesis.oracle import Oracle

SMALL = [(name, number) for name in FAMILIES for number in (2, 3, 4)]
#: Largest sizes whose states the oracle enumerates quickly.
SMALLEST = [("cells", 1), ("sensors", 2), ("line", 2), ("philosophers", 2), ("warehouse", 3), ("services", 3)]


@pytest.fixture
def sct(tmp_path):
    def transformed(name, number):
        path = tmp_path / "robot.rscd"
        path.write_text(FAMILIES[name].text(number))
        robot = robosc.load(path, (), [INTERFACES])
        # The families measure state counts: their models treat each error as the end of a call.
        assert {finding.rule for finding in robosc.check(robot, [INTERFACES])} <= {"unknown-end"}
        return robosc.to_sct(robot)

    return transformed


@pytest.mark.parametrize(("name", "number"), SMALL)
def test_states_are_what_the_formula_says(sct, name, number):
    assert synthesize(sct(name, number)).controlled_states == FAMILIES[name].states(number)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "number"), SMALLEST)
def test_states_are_what_the_definition_says(sct, name, number):
    made = sct(name, number)
    oracle, synthesis = Oracle(made), synthesize(made)
    assert len(oracle.controlled) == FAMILIES[name].states(number)
    assert len(oracle.uncontrolled) == synthesis.uncontrolled_states


@pytest.mark.parametrize(
    ("name", "number"), [(name, number - (name == "cells")) for name in FAMILIES for number in (2, 3)]
)
def test_states_are_what_another_tool_says(sct, name, number):
    pytest.importorskip("faudes")
    made = sct(name, number)
    expected = synthesize(made).uncontrolled_states, FAMILIES[name].states(number)
    assert faudes_states(made, Costs().during) == expected


def test_automata_of_plants_have_their_variables_in_their_states():
    counter = plant(
        "C",
        {"only": [edge("u", do={"n": "n + x"})]},
        uncontrollable={"u": ["x"]},
        variables={"n": "0..2"},
        inputs={"x": "1..2"},
    )
    lamp = plant("L", {"off": [edge("on", to="lit")], "lit": []}, controllable=["on"])
    made = model([counter, lamp], [needs("on", "n == 2")])
    flat = plants(made)
    counting, lighting = flat.values()
    assert counting.alphabet == {"C.u(1)", "C.u(2)"}
    assert counting.transitions == {
        (0, "C.u(1)"): 1,
        (0, "C.u(2)"): 2,
        (1, "C.u(1)"): 2,
        (1, "C.u(2)"): 2,
        (2, "C.u(1)"): 2,
        (2, "C.u(2)"): 2,
    }
    assert lighting.marked == [True, False]
    (required,) = requirements(made, flat)
    assert {state for state, label in required.transitions if label == "L.on"} == {2}


def test_guards_that_look_into_another_plant_have_no_automata():
    counter = plant("C", {"only": []}, variables={"n": "0..2"})
    lamp = plant("L", {"off": [edge("on", when="C.n == 2")]}, controllable=["on"])
    with pytest.raises(ValueError, match="n belongs to another plant"):
        plants(model([counter, lamp]))
