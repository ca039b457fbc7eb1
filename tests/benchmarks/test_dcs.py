"""Instances of the benchmark have as many controlled states as an explicit search, CIF's tool and publications find."""

import json
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

import pytest

from benchmarks import dcs
from benchmarks.dcs_families import DCS, ERROR, FAMILIES, Automaton, Instance, machine_line
from benchmarks.dcs_page import page, summary
from robosc.language.cif import read
from robosc.synthesis import count
from tests.language.cif.escet import Tools, home

#: Small instances of each family, with and without a supervisor.
SMALL = [
    *[("AT", 1, 1), ("AT", 2, 1), ("AT", 2, 2), ("AT", 2, 3)],
    *[("BW", 1, 1), ("BW", 1, 3), ("BW", 2, 2), ("BW", 3, 1)],
    *[("CM", 1, 1), ("CM", 1, 2), ("CM", 2, 1)],
    *[("DP", 1, 1), ("DP", 2, 1), ("DP", 2, 3)],
    *[("TA", 1, 1), ("TA", 1, 3), ("TA", 2, 1), ("TA", 2, 2)],
    *[("TL", 1, 1), ("TL", 1, 3), ("TL", 2, 1), ("TL", 2, 2)],
    *[("CLUSTER", 1, 1), ("CLUSTER", 2, 1)],
    *[("LINE", 1, 1), ("LINE", 2, 2), ("LINE", 3, 1)],
]

#: States under the supervisor that an explicit search finds in the published files of MTSA, a tool of its authors.
PUBLISHED = [
    *[("AT", 2, 2, 31), ("AT", 3, 3, 219), ("AT", 3, 2, 0)],
    *[("BW", 2, 3, 65), ("BW", 3, 3, 513)],
    *[("CM", 1, 3, 107), ("CM", 2, 3, 1625)],
    *[("DP", 1, 1, 0), ("DP", 3, 3, 2259)],
    *[("TA", 2, 3, 126), ("TA", 3, 2, 696), ("TA", 3, 3, 804)],
    *[("TL", 2, 3, 295), ("TL", 3, 3, 3355)],
]

State = tuple[str, ...]


def supervised(instance: Instance) -> dict[State, dict[str, State]]:
    """Return the states under the supervisor with their transitions, by explicit search.

    A state is bad if an automaton is in its error, if a requirement disables an uncontrollable event of the plants, if
    an uncontrollable event leads to a bad state, or if no marked state is reachable through states that are not bad.
    """
    initial = tuple(automaton.initial for automaton in instance.automata)
    reached, bad = reachable(instance, initial)
    before = -1
    while before != len(bad):
        before = len(bad)
        live = {state for state in reached.keys() - bad if all(map(Automaton.is_marked, instance.automata, state))}
        while more := {state for state in reached.keys() - bad - live if live & set(reached[state].values())}:
            live |= more
        bad |= reached.keys() - live
        bad |= {
            state
            for state in live
            if any(after in bad for event, after in reached[state].items() if event not in instance.controllable)
        }
    kept: dict[State, dict[str, State]] = {}
    pending = [initial]
    while pending:
        state = pending.pop()
        if state not in kept and state not in bad:
            kept[state] = {event: after for event, after in reached[state].items() if after not in bad}
            pending += kept[state].values()
    return kept


def reachable(instance: Instance, initial: State) -> tuple[dict[State, dict[str, State]], set[State]]:
    """Return the reachable states with their transitions, and those that are an error or disable what they must not."""
    parts = [(automaton, automaton.alphabet) for automaton in instance.automata]
    reached: dict[State, dict[str, State]] = {}
    bad: set[State] = set()
    pending = [initial]
    while pending:
        state = pending.pop()
        if state in reached:
            continue
        reached[state] = {}
        if ERROR in state:
            bad.add(state)
            continue
        for event in instance.events:
            targets = [
                part.edges[at].get(event) if event in letters else at
                for (part, letters), at in zip(parts, state, strict=True)
            ]
            disabling = [part for (part, _), target in zip(parts, targets, strict=True) if target is None]
            if not disabling:
                reached[state][event] = after = tuple(filter(None, targets))
                pending.append(after)
            elif event not in instance.controllable and all(part.requirement for part in disabling):
                bad.add(state)
    return reached, bad


@pytest.fixture
def counted(tmp_path: Path) -> Callable[[Instance], int]:
    def controlled(instance: Instance) -> int:
        path = tmp_path / "instance.cif"
        path.write_text(instance.text)
        model = read(path).model
        assert model is not None
        return count(model).controlled_states

    return controlled


@pytest.mark.parametrize(("family", "n", "k"), SMALL)
def test_states_are_those_of_an_explicit_search(counted, family, n, k):
    instance = FAMILIES[family].instance(n, k)
    assert counted(instance) == len(supervised(instance))


@pytest.mark.parametrize(("family", "n", "k", "states"), PUBLISHED)
def test_states_are_those_of_the_published_files(counted, family, n, k, states):
    assert counted(DCS[family].instance(n, k)) == states


@pytest.mark.parametrize(("teams", "evaluations"), [(1, 1), (2, 3), (3, 3), (5, 4)])
def test_bidding_has_as_many_states_as_its_formula(counted, teams, evaluations):
    # A team waits, has accepted, or reads or has rejected one of its evaluations. They determine the document. Only
    # when all wait, the last event may or may not be a decision.
    assert counted(DCS["BW"].instance(teams, evaluations)) == (2 * evaluations + 2) ** teams + 1


def test_line_has_as_many_states_and_transitions_as_wonham_publishes(counted):
    line = machine_line(2, (3, 1))
    transitions = supervised(line)
    assert (len(transitions), sum(map(len, transitions.values()))) == (28, 65)
    assert counted(line) == 28


@pytest.mark.slow
@pytest.mark.skipif(home() is None, reason="ESCET_HOME names no folder with CIF's tools: benchmarks/escet.md")
def test_states_are_those_of_the_tools_of_cif(counted, tmp_path):
    folder = home()
    assert folder is not None
    with Tools(folder, tmp_path) as tools:
        for family, n, k in [*SMALL, *[(name, 3, 3) for name in ("AT", "BW", "DP", "TL", "CLUSTER")]]:
            instance = FAMILIES[family].instance(n, k)
            path = tmp_path / f"{family}_{n}_{k}.cif"
            path.write_text(instance.text)
            assert tools.synthesize(path).states == counted(instance), path.name


@pytest.mark.parametrize("family", FAMILIES)
def test_observers_hear_every_event(family):
    instance = FAMILIES[family].instance(3, 2)
    goals = [automaton for automaton in instance.automata if automaton.name == "Goal"]
    assert [goal.alphabet for goal in goals] == ([frozenset(instance.events)] if family in DCS else [])


def test_two_targets_of_an_event_are_an_error():
    automaton = Automaton("A", "x")
    automaton.edge("x", "e", "y")
    with pytest.raises(ValueError, match="A: two targets of e from x"):
        automaton.edge("x", "e", "x")


def test_instances_are_measured_in_their_own_processes():
    result = dcs.run_instance(("BW", 2, 1), 60, 4096)
    assert (result["ended"], result["states"], result["limits"]) == ("done", 17, [60, 4096])
    assert dcs.run_instance(("BW", 2, 1), 60, 1)["ended"] == "memory"
    assert dcs.run_instance(("CM", 15, 15), 1, 4096)["ended"] == "time"


@pytest.fixture
def options(tmp_path):
    return Namespace(jobs=2, monotone=True, output=tmp_path / "results.jsonl", seconds=60, memory=4096)


@pytest.fixture
def attempts(monkeypatch):
    """Return the instances that are measured. Only those with N + K < 5 are done."""
    instances = []

    def run(task, seconds, megabytes):
        instances.append(task)
        result = {"ended": "done", "states": 7, "operations": 8, "nodes": 9, "synthesis": 1.5}
        return (result if sum(task[1:]) < 5 else {"ended": "time"}) | {
            "seconds": 2.0,
            "memory": 50,
            "limits": [seconds, megabytes],
        }

    monkeypatch.setattr(dcs, "run_instance", run)
    return instances


def test_instances_above_one_that_is_not_done_are_not_tried(options, attempts):
    todo = dcs.tasks(["AT", "TL"], 4, 4)
    results = {}
    dcs.measure(todo, results, options)
    done = {task for task in todo if sum(task[1:]) < 5}
    assert {task for task in attempts if task in done} == done
    assert {task for task in todo if sum(task[1:]) == 5} <= set(attempts)
    assert ("AT", 4, 4) not in attempts
    assert len(attempts) == len(set(attempts)) == len(results)
    assert "RoboSC completes 12 of 32 instances with N up to 4 and K up to 4." in summary(todo, results)
    options.monotone = False
    dcs.measure(todo, results, options)
    assert sorted(attempts) == sorted(todo)


def test_stored_results_are_not_measured_again(options, attempts):
    todo = dcs.tasks(["DP"], 3, 3)
    results = {}
    dcs.measure(todo, results, options)
    with options.output.open("a") as file:
        file.write('{"family": "DP", "n": 3, "k"')
    stored = dcs.read_results(options.output)
    assert stored == results
    assert [json.loads(line)["family"] for line in options.output.read_text().splitlines()] == ["DP"] * len(results)
    before = len(attempts)
    dcs.measure(todo, stored, options)
    assert len(attempts) == before
    done, undone = stored["DP", 1, 1], stored["DP", 3, 2]
    assert dcs.is_valid(done, 10, 4096)
    assert not dcs.is_valid(done, 1, 4096)
    assert dcs.is_valid(undone, 10, 4096)
    assert not dcs.is_valid(undone, 61, 4096)


@pytest.mark.usefixtures("attempts")
def test_the_page_has_each_family_and_each_named_instance(options):
    todo = dcs.tasks(FAMILIES, 15, 15, aims=True) + dcs.tasks(["AT"], 3, 3)
    results = {}
    dcs.measure(todo, results, options)
    text = page(todo, results, 60, 4096)
    assert all(f"| {name} | {family.title} |" in text for name, family in DCS.items())
    assert "| air traffic | 6 | 10 | 1 | 2, 2 | 7 | 1.50 | 8 | 9 |" in text
    assert "| DP 15, 15 | < 2 s | no | out of time | - | - | - |" in text
    assert " instances with N up to " not in text
    assert "| AT | 3 | 2 | 1 |" in text
