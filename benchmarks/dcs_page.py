"""Page of the documentation with the measurements of `dcs.py`."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from benchmarks.dcs_families import CHAINS, DCS, FAMILIES
from benchmarks.scaling_page import short_number

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

#: Family, N and K of an instance.
Task = tuple[str, int, int]
Result = dict[str, Any]
Results = dict[Task, Result]

#: Named instances, with the seconds of synthesis that each should take at most; None: it should be done.
AIMS: dict[Task, float | None] = {
    ("DP", 15, 15): 2,
    ("BW", 15, 15): 1,
    ("TA", 10, 10): 1,
    ("TL", 10, 10): 5,
    ("AT", 7, 7): None,
    ("CLUSTER", 20, 1): 3,
    ("CLUSTER", 40, 1): None,
    ("LINE", 20, 10): 5,
}
ENDED = {"time": "out of time", "memory": "out of memory"}

HEAD = """\
# Families of directed controller synthesis

This page shows how many instances of a published benchmark RoboSC completes within a limit.

<!-- not run: it takes hours, and writes this page -->
```sh
python benchmarks/dcs.py --jobs 2 --output dcs.jsonl --page
```

`python benchmarks/dcs.py DP TL --n 5 --k 5` measures the small instances of two families.
`python benchmarks/dcs_families.py DP 3 2` prints one instance as CIF.

## The families

The benchmark of directed controller synthesis has six families with two parameters N and K from 1 to 15. Ciolek and
others describe it in [On-the-fly informed search of non-blocking directed
controllers](https://doi.org/10.1016/j.automatica.2022.110731). A program of our own,
[dcs_families.py](../benchmarks/dcs_families.py), generates the instances and describes each family.

{families}
The supervisor of each family keeps a marked event possible again and again, for example a meal of all philosophers. An
observer automaton remembers whether the last event was marked. The observer takes part in every event. This makes it
hard to choose the variable order of the decision diagrams.

The explicit search in [test_dcs.py](../tests/benchmarks/test_dcs.py) and CIF's tool find the same numbers of states in
small instances. An explicit search through the published files of the authors' tool MTSA does, too.

There are two chains beside the families. The cluster tools follow an example of
[UltraDES](https://github.com/lacsed/UltraDES). Each tool has a robot and a chamber, with one place between neighbors.
The line of machines is Wonham's transfer line with any number of machines.

## Results

An instance has {seconds} s of processor time and {memory:,} MB of memory. Its process reads CIF, synthesizes, and
counts the controlled states. An empty supervisor is a result: for example, no controller exists for more planes than
heights.

The command assumes that larger instances are not easier. After an instance that is not done, it does not try instances
with at least the same N and K, and counts them as not done. The numbers of done instances are lower bounds.
`--no-monotone` tries all.

{total}

{table}
*Largest* is the largest done instance with N = K. The columns behind it belong to this instance. *Synthesis* is
processor time in seconds, from the variable order to the number of states. *Operations* and *most nodes* are the same
on every run.

The next table shows the largest K that is done for each N.

{frontier}
## Named instances

{aims}"""


def line(task: Task, result: Result) -> str:
    """Return a measured instance as a line of text."""
    name = f"{_name(task)}:"
    if result["ended"] != "done":
        return f"{name} {ENDED[result['ended']]} after {result['seconds']:.1f} s"
    return (
        f"{name} {result['states']:,} states, {result['operations']:,} operations, {result['nodes']:,} nodes, "
        f"{result['synthesis']:.2f} s ({result['seconds']:.2f} s in all), {result['memory']} MB"
    )


def summary(todo: Sequence[Task], results: Results) -> str:
    """Return the table of families, the total and the named instances as text."""
    return "\n".join([_totals(todo, results), *_total(todo, results), "", _aims(todo, results)])


def page(todo: Sequence[Task], results: Results, seconds: int, memory: int) -> str:
    """Return the page of all measurements, in Markdown."""
    return HEAD.format(
        families=_table(
            ["", "family", "N", "K"], [[name, family.title, family.n, family.k] for name, family in DCS.items()]
        ),
        seconds=seconds,
        memory=memory,
        total="\n".join(_total(todo, results)),
        table=_totals(todo, results),
        frontier=_frontier(todo, results),
        aims=_aims(todo, results),
    )


def _total(todo: Sequence[Task], results: Results) -> list[str]:
    """Return the number of done instances of the benchmark as a sentence, if all sizes up to a largest are measured."""
    ours = [task for task in todo if task[0] in DCS]
    n, k = (max((task[index] for task in ours), default=0) for index in (1, 2))
    if not ours or len(ours) != n * k * len({task[0] for task in ours}):
        return []
    done = sum(_done(task, results) for task in ours)
    return [f"RoboSC completes {done:,} of {len(ours):,} instances with N up to {n} and K up to {k}."]


def _totals(todo: Sequence[Task], results: Results) -> str:
    """Return a table of the families."""
    head = [
        "family",
        "done",
        "of",
        "not tried",
        "largest",
        "controlled states",
        "synthesis",
        "operations",
        "most nodes",
    ]
    rows = []
    for name, number in Counter(task[0] for task in todo).items():
        own = [task for task in todo if task[0] == name]
        done = [task for task in own if _done(task, results)]
        missing = sum(task not in results for task in own)
        row = [FAMILIES[name].title, f"{len(done)}", f"{number}", f"{missing}"]
        largest = max((task for task in done if name in CHAINS or task[1] == task[2]), default=None)
        rows.append(row + (["-"] * 5 if largest is None else [_size(largest), *_costs(results[largest])]))
    return _table(head, rows)


def _frontier(todo: Sequence[Task], results: Results) -> str:
    """Return a table of the largest K that is done for each N."""
    numbers = sorted({n for family, n, _ in todo if family in DCS})
    rows = []
    for name in dict.fromkeys(family for family, _, _ in todo if family in DCS):
        done = {n: [k for family, i, k in todo if (family, i) == (name, n)] for n in numbers}
        largest = [max((k for k in ks if _done((name, n, k), results)), default=0) for n, ks in done.items()]
        rows.append([name, *(f"{k or '-'}" for k in largest)])
    return _table(["N", *map(str, numbers)], rows)


def _aims(todo: Iterable[Task], results: Results) -> str:
    """Return a table of the named instances and their aims."""
    rows = []
    for task, aim in AIMS.items():
        if task in todo:
            result = results.get(task, {"ended": "not tried"})
            ended = result["ended"]
            costs = _costs(result) if ended == "done" else [ENDED.get(ended, ended), *["-"] * 3]
            reached = ended == "done" and (aim is None or result["synthesis"] < aim)
            rows.append([_name(task), "done" if aim is None else f"< {aim} s", "yes" if reached else "no", *costs])
    return _table(["instance", "aim", "reached", "controlled states", "synthesis", "operations", "most nodes"], rows)


def _done(task: Task, results: Results) -> bool:
    return task in results and results[task]["ended"] == "done"


def _name(task: Task) -> str:
    return f"{task[0]} {_size(task)}"


def _size(task: Task) -> str:
    """Return the parameters of an instance."""
    return f"{task[1]}" if FAMILIES[task[0]].k == "-" else f"{task[1]}, {task[2]}"


def _costs(result: Result) -> list[str]:
    """Return the states, seconds, operations and nodes of a done instance."""
    return [
        short_number(result["states"]),
        f"{result['synthesis']:.2f}",
        f"{result['operations']:,}",
        f"{result['nodes']:,}",
    ]


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
