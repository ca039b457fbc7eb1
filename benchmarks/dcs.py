"""Count how many instances of the families of directed controller synthesis are done within a limit.

    python benchmarks/dcs.py [FAMILY ...] [--n 15] [--k 15] [--seconds 60] [--memory 4096] [--jobs 1] [--aims]
                             [--no-monotone] [--output FILE] [--page [FILE]]

The families are in `benchmarks/dcs_families.py`. Each instance runs in its own process, limited to seconds of processor
time and megabytes of memory. The output is one line per instance, then a table of the families and the named instances.

`--monotone`, the default, does not try an instance if an instance of the same family with at most the same N and K is
not done. It counts as not done, so the number of done instances is a lower bound. `--no-monotone` tries all.

`--output FILE` adds each result to FILE as a line of JSON. Instances with a result in FILE that is valid for the limits
are not measured again. Use a new file for another version of the program. `--page` writes `docs/dcs.md`, or FILE.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import TYPE_CHECKING

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.dcs_families import FAMILIES  # noqa: E402
from benchmarks.dcs_page import AIMS, line, page, summary  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterable

    from benchmarks.dcs_page import Result, Results, Task

RUN = ROOT / "benchmarks" / "dcs_run.py"
#: Sizes of the chains.
CHAIN_SIZES = {
    "CLUSTER": [(n, 1) for n in (5, 10, 15, 20, 25, 30, 40)],
    "LINE": [(n, k) for n in (5, 10, 20) for k in (5, 10)],
}


def tasks(families: Iterable[str], n: int, k: int, *, aims: bool = False) -> list[Task]:
    """Return the instances to measure, in each family the smaller ones first."""
    instances: list[Task] = []
    for family in families:
        sizes = CHAIN_SIZES.get(family) or [(i, j) for i in range(1, n + 1) for j in range(1, k + 1)]
        instances += [(family, *size) for size in sorted(sizes, key=lambda size: (sum(size), size))]
    return [task for task in instances if not aims or task in AIMS]


def is_pruned(task: Task, results: Results) -> bool:
    """Return whether an instance that is smaller in both parameters is not done."""
    family, n, k = task
    return any(
        result["ended"] != "done" and other == family and i <= n and j <= k for (other, i, j), result in results.items()
    )


def run_instance(task: Task, seconds: int, megabytes: int) -> Result:
    """Return the result of an instance with its costs: all processor seconds of its process, and its most megabytes.

    `ended` is `done`, `time` or `memory`. Raises RuntimeError if the process fails for another reason.
    """
    command = [sys.executable, str(RUN), *map(str, task), str(seconds), str(megabytes)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stderr is not None
    output, errors = process.stdout.read(), process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    took = usage.ru_utime + usage.ru_stime
    if process.returncode > 0:
        raise RuntimeError(f"{task}: {errors}")
    result: Result = json.loads(output) if process.returncode == 0 else {"ended": "memory"}
    if process.returncode == -signal.SIGXCPU or took > seconds:
        result["ended"] = "time"
    elif usage.ru_maxrss > megabytes << 10:
        result["ended"] = "memory"
    costs = {"seconds": round(took, 2), "memory": round(usage.ru_maxrss / 1024)}
    return result | costs | {"limits": [seconds, megabytes]}


def is_valid(result: Result, seconds: int, megabytes: int) -> bool:
    """Return whether a result is valid for other limits than those of its measurement."""
    if result["ended"] == "done":
        return bool(result["seconds"] <= seconds and result["memory"] <= megabytes)
    return bool(result["limits"][0] >= seconds and result["limits"][1] >= megabytes)


def read_results(path: Path | None) -> Results:
    """Return the results in a file of JSON lines. An incomplete last line is removed from the file."""
    if path is None or not path.exists():
        return {}
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    if lines and not lines[-1].endswith("\n"):
        lines.pop()
        path.write_text("".join(lines), encoding="utf-8")
    results = [json.loads(text) for text in lines]
    return {(result.pop("family"), result.pop("n"), result.pop("k")): result for result in results}


def measure(todo: list[Task], results: Results, options: argparse.Namespace) -> None:
    """Measure the instances that have no result, `jobs` at a time, and add their results."""
    running: dict[Future[Result], Task] = {}

    def collect() -> None:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            task = running.pop(future)
            results[task] = future.result()
            print(line(task, results[task]), flush=True)
            if options.output is not None:
                family, n, k = task
                with options.output.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({"family": family, "n": n, "k": k, **results[task]}) + "\n")

    with ThreadPoolExecutor(options.jobs) as pool:
        for task in todo:
            while len(running) >= options.jobs:
                collect()
            if task not in results and not (options.monotone and is_pruned(task, results)):
                running[pool.submit(run_instance, task, options.seconds, options.memory)] = task
        while running:
            collect()


def main() -> int:
    options = _options()
    todo = tasks(options.families, options.n, options.k, aims=options.aims)
    results = {
        task: result
        for task, result in read_results(options.output).items()
        if task in todo and is_valid(result, options.seconds, options.memory)
    }
    measure(todo, results, options)
    print(summary(todo, results))
    if options.page is not None:
        options.page.write_text(page(todo, results, options.seconds, options.memory), encoding="utf-8")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("families", nargs="*", metavar="FAMILY", help=f"of {', '.join(FAMILIES)}; default: all")
    parser.add_argument("--n", type=int, default=15, help="largest N")
    parser.add_argument("--k", type=int, default=15, help="largest K")
    parser.add_argument("--seconds", type=int, default=60, help="of processor time, for each instance")
    parser.add_argument("--memory", type=int, default=4096, help="megabytes, for each instance")
    parser.add_argument("--jobs", type=int, default=1, help="instances at a time")
    parser.add_argument("--aims", action="store_true", help="only the named instances")
    parser.add_argument("--monotone", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--output", type=Path, help="file of JSON lines")
    parser.add_argument("--page", type=Path, nargs="?", const=ROOT / "docs" / "dcs.md")
    options = parser.parse_args()
    unknown = [name for name in options.families if name not in FAMILIES]
    if unknown:
        parser.error(f"unknown family {unknown[0]}: choose from {', '.join(FAMILIES)}")
    options.families = options.families or list(FAMILIES)
    return options


if __name__ == "__main__":
    sys.exit(main())
