"""Each strategy of the fixpoint, and the race between them, gives the supervisor of the definition."""

from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.dcs_families import air_traffic, cluster_tools, dining_philosophers
from robosc.language.cif import read
from robosc.synthesis import Statistics, Strategy, Tuning, bdd, count, cover, race, synthesize
from tests.random_sct import sct_models
from tests.synthesis.test_against_oracle import RANDOM_MODELS, check


@pytest.mark.slow
@pytest.mark.parametrize("strategy", Strategy)
@given(model=sct_models(requirements=True))
@RANDOM_MODELS
def test_each_strategy_gives_the_supervisor_of_the_definition(strategy, model):
    check(model, synthesize(model, tuning=Tuning("text", strategy)))


@pytest.mark.slow
@given(sct_models(requirements=True), st.integers(1, 20), st.integers(0, 3))
@RANDOM_MODELS
def test_the_race_gives_the_supervisor_of_the_definition(model, head_start, patience):
    with patch.object(race, "_HEAD_START", head_start), patch.object(race, "_PATIENCE", patience):
        check(model, synthesize(model))


@pytest.mark.slow
@given(sct_models(requirements=True))
@RANDOM_MODELS
def test_nested_guards_are_those_of_the_definition(model):
    with patch.object(cover, "_READABLE", 0):
        check(model, synthesize(model))


def counted(instance, tmp_path, **tuning):
    path = tmp_path / "instance.cif"
    path.write_text(instance.text)
    statistics = Statistics()
    states = count(read(path).model, statistics=statistics, tuning=Tuning(**tuning)).controlled_states
    return states, statistics.strategy, statistics.operations, statistics.peak_nodes


def test_a_model_that_is_done_soon_runs_forwards(tmp_path):
    states, strategy, operations, _ = counted(dining_philosophers(3, 3), tmp_path)
    assert strategy == "forward"
    assert counted(dining_philosophers(3, 3), tmp_path, strategy=Strategy.FORWARD)[0] == states
    assert operations < race._HEAD_START


def test_a_chain_runs_backwards_with_the_costs_of_the_winner(tmp_path, monkeypatch):
    monkeypatch.setattr(race, "_HEAD_START", 1 << 10)
    chosen = counted(cluster_tools(8), tmp_path)
    assert chosen[1] == "backward"
    assert chosen == counted(cluster_tools(8), tmp_path)
    alone = counted(cluster_tools(8), tmp_path, strategy=Strategy.BACKWARD)
    assert chosen == alone
    assert chosen[2] < counted(cluster_tools(8), tmp_path, strategy=Strategy.FORWARD)[2]


def test_a_model_with_many_violations_runs_within_the_safe_states(tmp_path, monkeypatch):
    monkeypatch.setattr(race, "_HEAD_START", 1 << 6)
    monkeypatch.setattr(race, "_PATIENCE", 0)
    chosen = counted(air_traffic(3, 3), tmp_path)
    assert chosen[1] == "safe"
    assert chosen == counted(air_traffic(3, 3), tmp_path, strategy=Strategy.SAFE)
    assert chosen[0] == counted(air_traffic(3, 3), tmp_path, strategy=Strategy.FORWARD)[0] == 219


def test_a_rival_without_room_leaves_the_race(tmp_path, monkeypatch):
    states, *_ = counted(air_traffic(3, 3), tmp_path)
    monkeypatch.setattr(race, "_HEAD_START", 1)
    monkeypatch.setattr(bdd, "_SMALL_CAPACITY", 1 << 10)
    monkeypatch.setattr(bdd, "_FIRST_CAPACITY", 1 << 10)
    first, second = (counted(air_traffic(3, 3), tmp_path) for _ in range(2))
    assert first == second
    assert first[0] == states


def test_an_order_of_names_precedes_the_automatic_one(tmp_path):
    states, *_ = counted(dining_philosophers(3, 1), tmp_path)
    costs = {counted(dining_philosophers(3, 1), tmp_path, order=order)[2:] for order in ("automatic", "text", ["Goal"])}
    assert len(costs) == 3
    assert counted(dining_philosophers(3, 1), tmp_path, order=["Goal"])[0] == states
    with pytest.raises(ValueError, match="no element `Table`"):
        counted(dining_philosophers(3, 1), tmp_path, order=["Table"])


def test_a_winner_without_room_begins_again_with_all_room(tmp_path, monkeypatch):
    states, *_ = counted(cluster_tools(8), tmp_path)
    monkeypatch.setattr(race, "_HEAD_START", 1 << 10)
    good = race.good_states
    rooms = []

    def good_states(search, safe):
        result = yield from good(search, safe)
        rooms.append(search.diagrams._capacity)
        if rooms == [1 << 16]:
            search.diagrams._full = 0
        return result

    monkeypatch.setattr(race, "good_states", good_states)
    # The memory has room for 2^18 nodes, which is also the first capacity: there is no larger one.
    model = read(tmp_path / "instance.cif").model
    assert count(model, memory=bdd._BYTES_PER_NODE << 18).controlled_states == states
    assert rooms == [1 << 16, 1 << 18]
