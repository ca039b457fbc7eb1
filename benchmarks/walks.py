"""Measure how all of robosc scales with models that are long in one respect; write `docs/walks.md`.

    python benchmarks/walks.py [--families provides imports] [--sizes 100 400 1600 5000] [--limit 120] [--output FOLDER]

The models are those of `benchmarks/walk_families.py`. Each goes through all of robosc in its own process. Processor
seconds are counted after everything has been loaded and a small model has warmed it up. The measurements are stored in
`benchmarks/walks.json`: parts that are left out this time stay on the page. `tests/benchmarks` checks the same walks in
calls instead of seconds.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from functools import partial
from math import log
from pathlib import Path
from statistics import linear_regression
from time import process_time
from typing import Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

import robosc  # noqa: E402
from benchmarks.walk_families import FAMILIES, write  # noqa: E402
from robosc.base.diagnostics import has_errors  # noqa: E402
from robosc.language.checks import check  # noqa: E402
from robosc.language.reading import read  # noqa: E402
from robosc.m2t.targets import together  # noqa: E402

SIZES = (100, 400, 1600, 5000)
TARGETS = ("cif", "supervisor", "ros1", "ros2", "xmi")
MOST = 1.2

HEAD = """\
# Long models

This page shows how the time and memory of RoboSC grow with a model that is long in one respect. The numbers come from
{machine}. Measure your computer with

<!-- not run: it takes long, and writes this page -->
```sh
python benchmarks/walks.py
```

The time is processor time, from the text to the generated CIF, C, ROS 1, ROS 2 and XMI. For a model that is wrong on
purpose, it ends with the findings. *MB* is the peak memory of the process. *k* is the exponent of the growth *N^k*.
It is below {most} for every model in the table, and [tests](../tests/benchmarks/test_walks.py) check that it stays so.
"""

TAIL = """
Two other kinds of models grow with the square of N, because the model of plants and the CIF do:

- *Transitions of one state on one event, each with a condition of its own.* The first transition whose condition holds
  is taken, so each edge negates the conditions before it. N transitions have N²/2 conditions. The generated C tries
  them one after the other and contains each of them once.
- *Events that many states ignore.* A location has an edge for each event that its state ignores. A component of N
  states and N messages has N² edges. The generated C contains no code for them.
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--families", nargs="+", choices=list(FAMILIES), default=list(FAMILIES))
    parser.add_argument("--sizes", nargs="+", type=int, default=SIZES)
    parser.add_argument("--limit", type=int, default=600, help="the seconds of the processor that a model may take")
    parser.add_argument("--output", type=Path, help="a folder for the page and what is kept")
    parser.add_argument("--machine", default="two shared cores", help="description of the machine for the page")
    parser.add_argument("--one", nargs=3, metavar=("FAMILY", "N", "FOLDER"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        family, number, folder = options.one
        print(json.dumps(_one(family, int(number), Path(folder))))
        return 0
    kept = (options.output or ROOT / "benchmarks") / "walks.json"
    results: dict[str, Any] = json.loads(kept.read_text()) if kept.exists() else {"families": {}}
    results["machine"] = options.machine
    for family in options.families:
        results["families"][family] = [_measured(family, number, options.limit) for number in options.sizes]
        kept.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n")
        print(
            family, *(f"{point['seconds']:.1f}" for point in results["families"][family]), file=sys.stderr, flush=True
        )
    (options.output or ROOT / "docs").joinpath("walks.md").write_text(page(results))
    steep = [family for family, points in results["families"].items() if exponent(points) >= MOST]
    print(*(f"{family} grows faster than N^{MOST}" for family in steep), sep="\n", file=sys.stderr)
    return int(bool(steep))


def _measured(family: str, number: int, limit: int) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, __file__, "--one", family, str(number), folder],
            stdout=subprocess.PIPE,
            text=True,
            check=False,
            preexec_fn=partial(resource.setrlimit, resource.RLIMIT_CPU, (limit, limit)),  # it forks on one thread
        )
    found = json.loads(done.stdout) if done.returncode == 0 else {"seconds": float(limit), "memory": 0.0}
    return {"n": number, "finished": done.returncode == 0, **found}


def _one(family: str, number: int, folder: Path) -> dict[str, float]:
    _through(write(family, 10, folder))
    path = write(family, number, folder)
    began = process_time()
    _through(path)
    seconds = process_time() - began
    return {"seconds": seconds, "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}


def _through(path: Path) -> None:
    if path.suffix == ".xmi":
        check(robosc.load(path))
        return
    reading = read(path)
    if has_errors([*reading.findings, *check(reading.base, reading.findings)]):
        return
    robot = robosc.load(path)
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    with together():  # as `robosc transform` does
        for target in TARGETS:
            robosc.generate(target, models)


def exponent(points: list[dict[str, Any]]) -> float:
    """Return the exponent of the growth, over the finished sizes only."""
    finished = [point for point in points if point["finished"]]
    if len(finished) < 2:
        return float("inf")
    slope = linear_regression(
        [log(point["n"]) for point in finished], [log(max(point["seconds"], 0.01)) for point in finished]
    ).slope
    return float(slope)


def page(results: dict[str, Any]) -> str:
    """Return the page of the documentation."""
    sizes = sorted({point["n"] for points in results["families"].values() for point in points})
    lines = [HEAD.format(machine=results["machine"], most=MOST)]
    lines += [
        f"| | {' | '.join(f'N = {size:,}' for size in sizes)} | MB | k |",
        f"| --- |{' ---: |' * (len(sizes) + 2)}",
    ]
    for family in FAMILIES:
        points = {point["n"]: point for point in results["families"].get(family, ())}
        if not points:
            continue
        title = (FAMILIES[family].__doc__ or family).partition("\n")[0].rstrip(".")
        cells = [_seconds(points.get(size)) for size in sizes]
        memory = max(point["memory"] for point in points.values())
        measured = [points[size] for size in sizes if size in points]
        lines.append(f"| {title} | {' | '.join(cells)} | {memory:.0f} | {exponent(measured):.2f} |")
    return "\n".join([*lines, TAIL])


def _seconds(point: dict[str, Any] | None) -> str:
    if point is None:
        return "-"
    return f"{point['seconds']:.2f} s" if point["finished"] else f"over {point['seconds']:.0f} s"


if __name__ == "__main__":
    sys.exit(main())
