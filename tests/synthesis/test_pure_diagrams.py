"""Decision diagrams in pure Python give the results of `oxidd`, and synthesis the same texts with them."""

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oxidd.bcdd import BCDDManager
from oxidd.util import BooleanOperator

from robosc.synthesis import pure_diagrams as pure
from tests.searching import examples

ROOT = Path(__file__).parents[2]
LEVELS = 6
ROBOTS = [f"examples/{name}/{name}.rscd" for name in ("object_finder", "sprayer", "obstacle_navigation")]
SYSTEMS = [f"docs/supervisory-control/{name}.cif" for name in ("agv", "cat_and_mouse", "transfer_line")]
NOTE = "decision diagrams in pure Python: install `oxidd` for speed\n"
#: A Python without the library.
BLOCK = "import sys; sys.modules['oxidd'] = None\n"
#: Synthesis with too little room at first, then the texts of the command line.
SYNTHESIZE = """
import sys
from robosc.synthesis import bdd, synthesize
from robosc.tools.cli import main
from tests.synthesis.classics import philosophers
bdd._SMALL_CAPACITY, usual = 64, bdd._SMALL_CAPACITY
synthesis = synthesize(philosophers(5))
print(synthesis.controlled_states, synthesis.bdd_nodes, synthesis.statistics.attempts > 1)
try:
    synthesize(philosophers(5), memory=20_000)
except MemoryError as error:
    print(error)
bdd._SMALL_CAPACITY = usual
for model in sys.argv[1:]:
    try:
        main(["synthesize", model])
    except SystemExit as end:
        print(model, end.code, flush=True)
"""

OPERATIONS = {
    "invert": lambda a, *_: ~a,
    "and": lambda a, b, *_: a & b,
    "or": lambda a, b, *_: a | b,
    "xor": lambda a, b, *_: a ^ b,
    "equiv": lambda a, b, *_: a.equiv(b),
    "imp": lambda a, b, *_: a.imp(b),
    "ite": lambda a, b, c, _: a.ite(b, c),
    "exists": lambda a, _b, _c, cube: a.exists(cube),
}
#: One of the last 16 functions, or its complement.
OPERANDS = st.integers(0, 31)
STEPS = st.lists(
    st.tuples(
        st.sampled_from([*OPERATIONS, "and_exists", "collect"]), OPERANDS, OPERANDS, OPERANDS, st.integers(0, 63)
    ),
    min_size=10,
    max_size=40,
)


def diagrams(manager_type, operator, steps):
    """Return the functions that the steps compute one after another."""
    manager = manager_type(1 << 12, 1 << 12, 1)
    manager.add_vars(LEVELS)
    functions = [manager.true(), manager.false(), *map(manager.var, range(LEVELS))]
    for name, *operands, variables in steps:
        if name == "collect":
            manager.gc()
            continue
        cube = manager.true()
        for level in range(LEVELS):
            if variables >> level & 1:
                cube &= manager.var(level)
        chosen = [(functions[-1 - (number >> 1) % len(functions)], number & 1) for number in operands]
        a, b, c = (~function if complement else function for function, complement in chosen)
        if name == "and_exists":
            functions.append(a.apply_exists(operator, b, cube))
        else:
            functions.append(OPERATIONS[name](a, b, c, cube))
    return functions


def table(function, level=0):
    """The values for all values of the variables from a level on."""
    if level == LEVELS:
        return [function.valid()]
    high, low = function.cofactors() if function.node_level() == level else (function, function)
    return table(high, level + 1) + table(low, level + 1)


@settings(max_examples=examples(300))
@given(STEPS)
def test_results_are_those_of_the_library(steps):
    theirs = diagrams(BCDDManager, BooleanOperator.AND, steps)
    ours = diagrams(pure.BCDDManager, pure.BooleanOperator.AND, steps)
    for one, other in zip(theirs, ours, strict=True):
        assert table(one) == table(other)
        assert (one.satisfiable(), one.valid()) == (other.satisfiable(), other.valid())
        assert (one.node_count(), one.node_level()) == (other.node_count(), other.node_level())
        for variables in (LEVELS, LEVELS + 70):
            assert one.sat_count(variables) == other.sat_count(variables)
        assert [one == each for each in theirs] == [other == each for each in ours]
        assert [hash(other) == hash(each) for each in ours] == [other == each for each in ours]


def test_fewer_variables_are_counted():
    function = diagrams(pure.BCDDManager, None, [("or", 8, 10, 0, 0)])[-1]
    assert (function.sat_count(2), function.sat_count(4)) == (3, 12)


def test_garbage_makes_room():
    manager = pure.BCDDManager(8, 1 << 10)
    manager.add_vars(4)
    kept = manager.var(0) ^ manager.var(1)
    with pytest.raises(pure.DDMemoryError):
        [kept ^ manager.var(2) & manager.var(3), kept & manager.var(2), kept & manager.var(3)]
    full = manager.approx_num_inner_nodes()
    manager.gc()
    assert manager.approx_num_inner_nodes() == kept.node_count() - 1 < full == 8
    assert manager.gc_count() == 1
    assert manager.var(0) ^ kept == manager.var(1)


def test_many_levels():
    """Each level takes a frame of Python, whose default limit is 1000."""
    manager = pure.BCDDManager(1 << 16, 1 << 16)
    manager.add_vars(3000)
    odd = all_true = manager.true()
    for level in reversed(range(3000)):
        odd, all_true = manager.var(level) ^ odd, manager.var(level) & all_true
    assert odd.node_count() == 3001
    assert odd.sat_count(3000) == 1 << 2999
    assert (odd & all_true, odd.equiv(all_true).imp(odd).ite(odd, all_true)) == (all_true, odd)
    assert odd.apply_exists(pure.BooleanOperator.AND, odd, all_true).valid()


def synthesize(start):
    command = [sys.executable, "-c", start + SYNTHESIZE, *ROBOTS, *SYSTEMS]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout, done.stderr


def test_synthesis_gives_the_same_texts():
    """Only the command line prints the line about the speed: once, before all findings of synthesis."""
    text, findings = synthesize("")
    restarted, refused = text.splitlines()[:2]
    assert restarted.endswith(" True")
    assert refused == "synthesis needs more than 0 MiB for its decision diagrams"
    assert all(f"{model} 0\n" in text for model in [*ROBOTS, *SYSTEMS])
    assert synthesize(BLOCK) == (text, NOTE + findings)
