"""Time the synthesis of CIF models, most from other projects, against CIF's own tool; write `docs/cif-models.md`.

    python benchmarks/cif_models.py FOLDER [--more FILE.cif ...] [--rounds 3] [--seconds 300] [--output FOLDER]

FOLDER holds the models that Eclipse ESCET times for synthesis (`cif/org.eclipse.escet.cif.examples/benchmarks` in its
repository), which are not part of this repository. Its scripts `benchmark_*.tooldef` list them. `--more` adds further
files. Robots of our own families are added as generated CIF.

If ESCET_HOME names a folder with CIF's tools (benchmarks/escet.md), they process each model in the same run, one tool
after the other. Ends with 1 if robosc does not finish in the given seconds, or if its result differs from CIF's tool.
The measurements are stored in `benchmarks/cif_models.json`; `--output` writes them and the page elsewhere.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.cif_models_page import agree, page  # noqa: E402
from benchmarks.dcs_families import cluster_tools  # noqa: E402
from benchmarks.families import FAMILIES  # noqa: E402
from tests.language.cif.escet import SYNTHESIS, Tools, class_path, home  # noqa: E402

#: Call in a script: the name of the benchmark, its folder, its file.
_SCRIPT = re.compile(r'^benchmark\("([^"]*)", "([^"]*)", "([^"]*)"\)', re.MULTILINE)
#: Robots of our families.
_ROBOTS = {
    "cells": (8, 32),
    "sensors": (16, 64),
    "line": (32,),
    "philosophers": (10, 20),
    "warehouse": (8, 10),
    "services": (32,),
}
_CLUSTER_TOOLS = (10, 15, 18, 20)
#: Options of CIF's tool: its fastest settings.
_OPTIONS = ("--bdd-output=nodes", "--forward-reach=yes", "--event-warn=no", "--stats=ctrl-sys-states,timing")
#: Phases of its synthesis, from the order of the variables on, by its own names.
_PHASES = ("Convert input model", "Pre synthesis", "Main synthesis loop", "Post synthesis")

Results = dict[str, Any]


def models(folder: Path) -> dict[str, Path]:
    """Return the files that the scripts in a folder name."""
    found = (
        _SCRIPT.search(script.read_text(encoding="utf-8")) for script in sorted(folder.glob("benchmark_*.tooldef"))
    )
    return {match[1]: folder / match[2] / match[3] for match in found if match is not None}


def robots(folder: Path) -> dict[str, Path]:
    """Write chains of cluster tools and robots of our families as CIF into a folder; return their files."""
    found = {}
    for number in _CLUSTER_TOOLS:
        found[f"cluster_tools_{number}"] = path = folder / f"cluster_tools_{number}.cif"
        path.write_text(cluster_tools(number).text, encoding="utf-8")
    for family, numbers in _ROBOTS.items():
        for number in numbers:
            name = f"{family}_{number}"
            path = folder / f"{name}.rscd"
            path.write_text(FAMILIES[family].text(number), encoding="utf-8")
            command = [sys.executable, "-m", "robosc", "transform", str(path), "--to", "cif", "-o", str(folder / name)]
            subprocess.run(
                [*command, "--interface-path", str(ROOT / "benchmarks" / "interfaces")], cwd=ROOT, check=True
            )
            [found[name]] = [file for file in (folder / name).glob("*.cif") if ".supervised." not in file.name]
    return found


def run(command: list[str], seconds: float, given: str = "") -> tuple[Results, str] | None:
    """Run a command; return its costs (processor seconds, megabytes) and its output, or None.

    `seconds` limits its processor time, `given` is its input. None: it took longer, or failed.
    """
    with tempfile.TemporaryFile("w+") as said, tempfile.TemporaryFile("w+") as asked:
        asked.write(given)
        asked.seek(0)
        process = subprocess.Popen(
            command,
            cwd=ROOT,
            stdin=asked,
            stdout=said,
            stderr=subprocess.STDOUT,
            text=True,
            preexec_fn=partial(resource.setrlimit, resource.RLIMIT_CPU, (ceil(seconds), ceil(seconds))),  # noqa: PLW1509  # it forks on one thread
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        took = {"cold": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss / 1000}
        said.seek(0)
        output = said.read()
    if process.returncode < 0:
        return None
    if process.returncode not in {0, 3}:
        print(" ".join(command), output, sep="\n", file=sys.stderr)
        return None
    return took, output


def robosc_measured(path: Path, rounds: int, seconds: float) -> Results | None:
    """Return the results and costs of robosc."""
    cold = run([sys.executable, "-m", "robosc", "synthesize", str(path), "--counts", "--json"], seconds)
    script = str(ROOT / "benchmarks" / "cif_models_run.py")
    warm = None if cold is None else run([sys.executable, script, str(path), str(rounds)], rounds * seconds)
    if cold is None or warm is None:
        return None
    said = json.loads(warm[1])
    return said | {"seconds": min(said["seconds"])} | cold[0] | _written(path, script, seconds)


def _written(path: Path, script: str, seconds: float) -> Results:
    """Return the costs of the whole job with guards, and the share of the guards in synthesis.

    The result is empty beyond the limit.
    """
    with tempfile.TemporaryDirectory() as scratch:
        whole = run([sys.executable, "-m", "robosc", "transform", str(path), "--to", "cif", "-o", scratch], seconds)
    guards = None if whole is None else run([sys.executable, script, str(path), "0"], seconds)
    if whole is None or guards is None:
        return {}
    return {"whole": whole[0]["cold"], **json.loads(guards[1])}


class Cif:
    """CIF's tool, cold in a new Java process each time, and warm in one process."""

    def __init__(self, folder: Path, seconds: float) -> None:
        self._folder = folder
        self._seconds = seconds
        self._scratch = tempfile.TemporaryDirectory()
        self._output = str(Path(self._scratch.name) / "out.cif")
        self._tools = Tools(folder)
        self._calls = Path(self._scratch.name)
        script = Path(sys.modules[Tools.__module__].__file__ or "").with_name("Calls.java")
        compiler = shutil.which("javac") or "javac"
        subprocess.run([compiler, "-cp", class_path(folder), "-d", str(self._calls), str(script)], check=True)

    def measured(self, path: Path, rounds: int) -> Results:
        """Return the results and costs, without `cold` or `seconds` if the cold or warm run is too slow."""
        found: Results = {}
        call = "\t".join([SYNTHESIS, str(path), *_OPTIONS, "-o", self._output, "--gui=off"])
        command = [
            shutil.which("java") or "java",
            "-Xmx3g",
            "-cp",
            f"{class_path(self._folder)}{os.pathsep}{self._calls}",
            "Calls",
        ]
        plain = "\t".join([SYNTHESIS, str(path), "-o", self._output, "--gui=off"])
        whole = run(command, self._seconds, f"{plain}\n")
        if whole is not None:
            found["whole"] = whole[0]["cold"]
        cold = run(command, self._seconds, f"{call}\n")
        if cold is not None:
            found |= cold[0]
            calls = [self._tools.call(SYNTHESIS, str(path), *_OPTIONS, "-o", self._output) for _ in range(rounds)]
            found["seconds"] = min(_synthesis(call.output) * call.processor for call in calls)
            text = re.search(r"Controlled system: (?:exactly )?([\d,.\u00a0]+) state", calls[0].output)
            assert text is not None or "Empty supervisor" in calls[0].output, calls[0].output
            found["states"] = 0 if text is None else int(re.sub(r"\D", "", text[1]))
        return found

    def close(self) -> None:
        """End the process."""
        self._tools.__exit__()
        self._scratch.cleanup()


def _synthesis(output: str) -> float:
    """Return the share of synthesis in the time of CIF's tool."""

    def taken(phase: str) -> int:
        found = re.search(rf"^ *{phase} +([\d,]+) ms$", output, re.MULTILINE)
        return 0 if found is None else int(found[1].replace(",", ""))

    return sum(map(taken, _PHASES)) / max(1, taken("Total"))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--more", type=Path, nargs="*", default=[])
    parser.add_argument("--rounds", type=int, default=3, help="of synthesis in one process")
    parser.add_argument("--seconds", type=float, default=300, help="of the processor, for each command")
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    folder = home()
    cif = None if folder is None else Cif(folder, options.seconds)
    results: Results = {"rounds": options.rounds, "seconds": options.seconds, "models": {}}
    failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        asked = models(options.folder) | {path.stem.lower(): path for path in options.more}
        results["escet"] = len(models(options.folder))
        for name, path in (asked | robots(Path(scratch))).items():
            ours = robosc_measured(path.resolve(), options.rounds, options.seconds)
            theirs = None if cif is None else cif.measured(path.resolve(), options.rounds)
            print(name, ours, theirs, flush=True)
            failed += ours is None or (bool(theirs) and "states" in theirs and not agree(ours, theirs))
            results["models"][name] = {"robosc": ours, "cif": theirs}
    if cif is not None:
        cif.close()
    kept, pages = (options.output or ROOT / part for part in ("benchmarks", "docs"))
    (kept / "cif_models.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    (pages / "cif-models.md").write_text(page(results), encoding="utf-8")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
