"""The causes of the cost of a synthesis."""

import pytest

from benchmarks.dcs_families import cluster_tools, dining_philosophers
from robosc.analysis.cost import explain_cost
from robosc.language.cif import read
from robosc.synthesis import Tuning, race
from robosc.synthesis.encoding import element_name, element_names


def cost_of(instance, tmp_path):
    path = tmp_path / "instance.cif"
    path.write_text(instance.text + "requirement take_0_0 needs Fork_1.Free;\n" * ("Fork_1" in instance.text))
    model = read(path).model
    return model, explain_cost(model, Tuning())


def test_an_observer_of_all_events_is_a_hub(tmp_path):
    _, cost = cost_of(dining_philosophers(4, 2), tmp_path)
    [(hub, number)] = cost.hubs
    assert element_name(hub) == "Goal"
    assert number == cost.couplings
    assert cost.order[-1] is hub


def test_the_order_has_all_elements(tmp_path):
    model, cost = cost_of(dining_philosophers(4, 2), tmp_path)
    # The plant of events outside of all automata has one state.
    assert sorted([*map(element_name, cost.order), "specification"]) == sorted(element_names(model))


@pytest.mark.parametrize("head_start", [1, race._HEAD_START])
def test_the_costs_of_the_events_are_those_of_the_winner(tmp_path, monkeypatch, head_start):
    monkeypatch.setattr(race, "_HEAD_START", head_start)
    _, cost = cost_of(cluster_tools(4), tmp_path)
    assert sum(row.operations for row in cost.events) == cost.statistics.operations
    nodes = [row.nodes for row in cost.events]
    assert nodes == sorted(nodes, reverse=True)
    _, again = cost_of(cluster_tools(4), tmp_path)
    assert [(row.operations, row.nodes) for row in again.events] == [(row.operations, row.nodes) for row in cost.events]


def test_requirements_come_with_the_size_of_their_condition(tmp_path):
    _, cost = cost_of(dining_philosophers(4, 2), tmp_path)
    [(requirement, nodes)] = cost.requirements
    assert requirement.text == "requirement take_0_0 needs Fork_1.Free"
    assert nodes > 1
