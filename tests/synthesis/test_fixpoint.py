"""Grouping of events into one step."""

import pytest

from robosc.synthesis import fixpoint, order, synthesize, use_encoding
from robosc.synthesis.relation import event_relations, required_moves, steps
from tests.sct_models import edge, model, plant
from tests.synthesis.test_against_oracle import check

ROBOTS = range(4)


@pytest.fixture(autouse=True)
def _no_hubs(monkeypatch):
    """Order the aisle of the warehouses as any other element, not as a hub."""
    monkeypatch.setattr(order, "_HUBS", 0)


def warehouse(after_entering):
    """Return robots that enter and leave by an aisle, which the variable order places between them."""
    enter, leave = ([f"{action}{i}" for i in ROBOTS] for action in ("enter", "leave"))
    aisle = {
        "free": [*(edge(event, to=after_entering) for event in enter), edge("close", to="taken")],
        "taken": [*(edge(event, to="free") for event in leave), edge("open", to="free")],
    }
    robots = [
        plant(f"R{i}", {"out": [edge(into, to="in")], "in": [edge(out, to="out")]}, controllable=[into, out])
        for i, (into, out) in enumerate(zip(enter, leave, strict=True))
    ]
    return model([plant("Aisle", aisle, controllable=["open", "close"]), *robots])


def changed(given):
    """Return the elements that each step changes."""

    def look(encoding):
        merged = fixpoint._merged(steps(required_moves(event_relations(given, encoding))))
        return sorted(sorted(element.name for element in step.changed) for step in merged)

    return use_encoding(given, look)


def test_events_that_change_the_same_first_element_are_one_step():
    assert changed(warehouse("taken")) == [["Aisle", "R0"], ["Aisle", "R1"], ["Aisle", "R2", "R3"]]


def test_events_that_need_no_next_values_stay_apart():
    aisle = {"free": [edge(f"enter{i}", to="taken") for i in ROBOTS], "taken": []}
    robots = [
        plant(f"R{i}", {"out": [edge(f"enter{i}", to="in")], "in": []}, controllable=[f"enter{i}"]) for i in ROBOTS
    ]
    single = changed(model([plant("Aisle", aisle), *robots]))
    assert single == [["Aisle", f"R{i}"] for i in ROBOTS]


def test_events_with_a_large_relation_stay_apart(monkeypatch):
    monkeypatch.setattr(fixpoint, "_LARGE", 1)
    assert ["Aisle", "R2", "R3"] not in changed(warehouse("taken"))


def test_events_that_only_read_it_stay_apart():
    assert changed(warehouse("free"))[-2:] == [["R2"], ["R3"]]


@pytest.mark.parametrize("larger", [0, fixpoint._LARGER])
def test_a_step_that_would_be_large_is_none_and_the_states_are_the_same(monkeypatch, larger):
    monkeypatch.setattr(fixpoint, "_LARGER", larger)
    given = warehouse("taken")
    assert (["Aisle", "R2", "R3"] in changed(given)) == bool(larger)
    check(given, synthesize(given))
