"""Measure how synthesis and the whole tool scale with their models; write `docs/benchmarks.md` and its plots.

    pip install -e '.[benchmarks]'
    python benchmarks/scaling.py [--quick] [--families cells line] [--tools robosc faudes] [--limit 60]
                                 [--output FOLDER]

Robots of any size (`benchmarks/families.py`) go through all of robosc, each in its own process, until one exceeds the
limit of processor time. For comparison, synthesis by the definition (`tests/synthesis/oracle.py`) and by libFAUDES runs
on the same automata, with a third of the limit. All must find as many states as the family's formula: if one differs,
this ends with 1. `robosc transform` is measured as a command.

The measurements are stored in `benchmarks/scaling.json`: parts that are left out this time stay on the page. `--quick`
tries the smallest robots of each family; `--output` leaves the page and the stored measurements unchanged. The whole
run takes a quarter of an hour.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.families import FAMILIES, Family, cells  # noqa: E402
from benchmarks.scaling_page import page, plots  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

RUN = ROOT / "benchmarks" / "scaling_run.py"
INTERFACES = ROOT / "benchmarks" / "interfaces"
TOOLS = ("robosc", "definition", "faudes", "transform")
#: Numbers of components that go through `robosc transform`, two in each cell.
COMPONENTS = (30, 62, 100, 300, 1000, 3000)
COMMAND = ("transform", "--to", "cif,supervisor,ros1,ros2", "--interface-path", str(INTERFACES))


def main() -> int:
    options = _options()
    kept = (options.output or ROOT / "benchmarks") / "scaling.json"
    results: dict[str, Any] = json.loads(kept.read_text()) if kept.exists() else {"families": {}, "transform": []}
    results |= {"machine": options.machine, "limit": options.limit}
    with ThreadPoolExecutor(options.jobs) as pool:
        tools = _installed(options.tools)
        # The slowest job goes first.
        running = {pool.submit(_transforms, options): ("", "transform")} if "transform" in tools else {}
        running |= {
            pool.submit(_series, FAMILIES[name], tool, options): (name, tool)
            for tool in tools
            if tool != "transform"
            for name in options.families
        }
        for done in as_completed(running):
            name, tool = running[done]
            if name:
                results["families"].setdefault(name, {})[tool] = done.result()
            else:
                results["transform"] = done.result()
            kept.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n")
    results = json.loads(kept.read_text())
    docs = options.output or ROOT / "docs"
    (docs / "benchmarks.md").write_text(page(results))
    for name, text in plots(results).items() if find_spec("matplotlib") else ():
        (docs / name).write_text(text)
    wrong = list(disagreements(results))
    print(*wrong, sep="\n", file=sys.stderr)
    return int(bool(wrong))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two robots of each family, and a small command")
    parser.add_argument("--families", nargs="+", choices=list(FAMILIES), default=list(FAMILIES))
    parser.add_argument("--tools", nargs="+", choices=TOOLS, default=TOOLS)
    parser.add_argument("--limit", type=int, default=60, help="the seconds of the processor that a robot may take")
    parser.add_argument("--jobs", type=int, default=2, help="how many are measured at a time")
    parser.add_argument("--output", type=Path, help="a folder for the page, the plots and what is kept")
    parser.add_argument("--machine", default="two shared cores", help="description of the machine for the page")
    return parser.parse_args()


def _installed(tools: Sequence[str]) -> list[str]:
    missing = [tool for tool in tools if tool == "faudes" and not find_spec("faudes")]
    for package in missing:
        _say(f"{package} is left out: `pip install -e '.[benchmarks]'` installs it")
    return [tool for tool in tools if tool not in missing]


def _series(family: Family, tool: str, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Measure one robot after the other, up to the first that does not finish."""
    measured = []
    limit = options.limit if tool == "robosc" else options.limit // 3
    sizes = family.sizes[: 1 if tool == "definition" else 2] if options.quick else family.sizes
    for number in sizes:
        text = family.text(number)
        point = {"n": number, "lines": text.count("\n"), **_measured([str(RUN), tool], text, limit)}
        measured.append(point)
        _say(f"{family.name} {number}, {tool}: {point['cpu']:.1f} s{'' if point['finished'] else ', and not finished'}")
        if not point["finished"]:
            break
    return measured


def _transforms(options: argparse.Namespace) -> list[dict[str, Any]]:
    """Measure the command from a cold start, and the phases of each model."""
    measured = []
    for components in COMPONENTS[: 1 if options.quick else None]:
        text = cells(components // 2)
        with tempfile.TemporaryDirectory() as folder:
            command = _measured(["-m", "robosc", *COMMAND, "-o", folder], text, 3 * options.limit)
            files = [path for path in Path(folder).rglob("*") if path.is_file()]
            written = sum(file.stat().st_size for file in files)
        phases = _measured([str(RUN), "robosc"], text, 3 * options.limit).get("phases", {})
        point = {"components": components, "lines": text.count("\n"), **command, "bytes": written, "phases": phases}
        measured.append(point)
        _say(f"transform of {components} components: {command['cpu']:.1f} s")
    return measured


def _measured(program: Sequence[str], text: str, limit: int) -> dict[str, Any]:
    """Return the results and costs of a Python program for a model: wall and processor seconds, peak megabytes."""
    with tempfile.TemporaryDirectory() as folder:
        model, output = Path(folder) / "model.rscd", Path(folder) / "output"
        model.write_text(text)
        began = perf_counter()
        with output.open("w") as out:
            process = subprocess.Popen(
                [sys.executable, *program, str(model)],
                stdout=out,
                stderr=subprocess.PIPE,
                text=True,
                preexec_fn=partial(resource.setrlimit, resource.RLIMIT_CPU, (limit, limit + 5)),  # noqa: PLW1509  # it forks on one thread
            )
            assert process.stderr is not None
            said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = perf_counter() - began
        if process.returncode > 0:
            raise RuntimeError(said)
        lines = output.read_text().splitlines()
        # A library may print before; a command without numbers may print warnings.
        found = json.loads(lines[-1]) if lines and lines[-1].startswith("{") else {}
    return (
        {"finished": process.returncode == 0}
        | found
        | {
            "wall": wall,
            "cpu": usage.ru_utime + usage.ru_stime,
            "memory": usage.ru_maxrss / 1024,
        }
    )


def disagreements(results: dict[str, Any]) -> Iterator[str]:
    """Yield the robots for which a count differs from the formula, or from another tool without requirements."""
    for name, tools in results["families"].items():
        uncontrolled: dict[int, tuple[str, int]] = {}
        for tool, measured in tools.items():
            for point in measured:
                number = point["n"]
                if "states" not in point:
                    continue
                states = FAMILIES[name].states(number)
                if point["states"] != states:
                    yield f"{name} {number}: {tool} finds {point['states']} states, the formula says {states}"
                other, count = uncontrolled.setdefault(number, (tool, point["uncontrolled"]))
                if count != point["uncontrolled"]:
                    yield f"{name} {number}: {tool} reaches {point['uncontrolled']} states, {other} {count}"


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
