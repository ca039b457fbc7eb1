"""Properties of synthesis other than the correctness of the supervisor."""

import os
import subprocess
import sys
from pathlib import Path
from time import sleep

import pytest

from robosc.base.diagnostics import ModelError
from robosc.model.places import Place
from robosc.model.semantics.printing import SctPrinter
from robosc.synthesis import Phase, Statistics, Tuning, bdd, count, solve, synthesize
from tests.sct_models import edge, model, needs, plant
from tests.synthesis.classics import philosophers

ROOT = Path(__file__).parents[2]
SCRIPT = """
from robosc.model.semantics.printing import SctPrinter
from robosc.synthesis import synthesize
from robosc.synthesis import bdd
from tests.sct_models import model, needs
from tests.synthesis.classics import philosophers
from tests.synthesis.test_acceleration import turning
bdd._FIRST_CAPACITY = 1000
counters = model(turning(2), [needs("go0", "P0.n < P1.n + 3")])
for made in philosophers(6), counters:
    synthesis = synthesize(made)
    print(synthesis.bdd_nodes, synthesis.controlled_states)
    print([guard.synthesis and SctPrinter()(guard.synthesis) for guard in synthesis.supervisor.guards])
    print({**vars(synthesis.statistics), "seconds": None, "processor_seconds": None})
"""


def test_time_asleep_is_no_time_of_the_processor():
    statistics = Statistics()
    with statistics.during(Phase.ORDER):
        sleep(0.05)
    assert 0 <= statistics.processor_seconds[Phase.ORDER] < statistics.seconds[Phase.ORDER]


@pytest.mark.slow
def test_every_run_gives_the_same():
    outputs = {
        subprocess.run(
            [sys.executable, "-c", SCRIPT],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        for seed in ("0", "1", "2")
    }
    [output] = outputs
    assert "'attempts': 3" in output


def described(synthesis):
    text = SctPrinter()
    guards = [guard.synthesis and text(guard.synthesis) for guard in synthesis.supervisor.guards]
    return synthesis.uncontrolled_states, synthesis.controlled_states, synthesis.bdd_nodes, guards


def test_diagrams_grow_until_they_suffice(monkeypatch):
    expected = described(synthesize(philosophers(5)))
    runs = []
    monkeypatch.setattr(bdd, "_FIRST_CAPACITY", 64)
    monkeypatch.setattr(bdd, "Diagrams", bdd.Diagrams)
    original = bdd.Diagrams.__init__
    monkeypatch.setattr(
        bdd.Diagrams, "__init__", lambda self, *arguments: (runs.append(arguments), original(self, *arguments))[1]
    )
    assert described(synthesize(philosophers(5))) == expected
    assert len(runs) > 1


def test_guards_that_take_too_much_effort_are_left_out():
    def look(solution):
        return solution.synthesis, [permission.where.node_count() for permission in solution.permissions]

    (whole, nodes), (short, same) = solve(philosophers(5), look), solve(philosophers(5), look, tuning=Tuning(longest=0))
    assert whole.unwritten == {}
    added = [guard.synthesis is not None for guard in whole.supervisor.guards]
    assert True in added
    assert same == nodes
    assert list(short.unwritten.values()) == [size for size, has in zip(nodes, added, strict=True) if has]
    assert [guard.synthesis for guard in short.supervisor.guards] == [None] * len(added)
    assert [guard.everEnabled for guard in short.supervisor.guards] == [
        guard.everEnabled for guard in whole.supervisor.guards
    ]
    assert short.controlled_states == whole.controlled_states == count(philosophers(5)).controlled_states


def test_memory_is_bounded():
    with pytest.raises(MemoryError, match="more than 1 MiB"):
        synthesize(products(24), memory=1 << 20)


def products(number):
    """Return a variable that is the product of two others: every order needs very many nodes."""
    return model(
        [
            plant(
                "P",
                {"only": [edge("u", do={"z": "x * y", "v": "x", "w": "y"})]},
                uncontrollable={"u": ["x", "y"]},
                variables=dict.fromkeys("vwz", f"0..{2**number}"),
                inputs=dict.fromkeys("xy", f"0..{2 ** (number // 2)}"),
            )
        ]
    )


@pytest.mark.parametrize("condition", ["v / 2 > 1", "double(v) > 1", "1.5 > 1.0"])
def test_doubles_are_refused_where_they_stand(condition):
    made = model(
        [plant("P", {"only": [edge("c")]}, controllable=["c"], variables={"v": "0..3"})], [needs("c", condition)]
    )
    for part in (made.requirements[0].condition, made.requirements[0].condition.left):
        part.source = Place.parse("robot.rscd:3:7-3:16")
    with pytest.raises(ModelError, match="is not allowed in an sct model") as caught:
        synthesize(made)
    [finding] = caught.value.diagnostics
    assert (finding.file, finding.span.line, finding.span.column, finding.rule) == ("robot.rscd", 3, 7, "type")


def test_the_model_stays_as_it_is():
    made = philosophers(3)
    synthesize(made)
    assert made.supervisor is None


def test_wide_integers_are_copied_and_compared_at_once():
    wide = {"x": "-2000000000..2000000000", "y": "-2000000000..2000000000"}
    read = edge("read", do={"x": "i", "y": "x"})
    sensor = plant(
        "sensor",
        {"on": [read, edge("go")]},
        controllable=["go"],
        uncontrollable={"read": ["i"]},
        variables=wide,
        inputs={"i": wide["x"]},
    )
    synthesis = synthesize(model([sensor], [needs("go", "x > y + 3")]))
    assert synthesis.controlled_states == 4_000_000_001**2
    assert synthesis.bdd_nodes < 1000
