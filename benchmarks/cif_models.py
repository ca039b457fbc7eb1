"""Synthesis of models that others wrote in CIF: how long it takes, and how many states they are left.

    python benchmarks/cif_models.py FOLDER [--more FILE.cif ...] [--seconds 300] [--guards]

FOLDER holds the models that Eclipse ESCET times for synthesis (`cif/org.eclipse.escet.cif.examples/benchmarks` in its
repository), which are no part of this one: its scripts `benchmark_*.tooldef` say which these are. `--more` are files
beside them. Each is synthesized by a process of its own, with `--counts`; with `--guards` as `robosc synthesize` does.
Ends with 1 where one has no answer in the given seconds.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path
from time import perf_counter
from typing import Any

ROOT = Path(__file__).parent.parent
#: What a script calls: the name of the benchmark, its folder, its file.
_SCRIPT = re.compile(r'^benchmark\("([^"]*)", "([^"]*)", "([^"]*)"\)', re.MULTILINE)


def models(folder: Path) -> dict[str, Path]:
    """The files that the scripts in a folder name."""
    found = (
        _SCRIPT.search(script.read_text(encoding="utf-8")) for script in sorted(folder.glob("benchmark_*.tooldef"))
    )
    return {match[1]: folder / match[2] / match[3] for match in found if match is not None}


def synthesized(path: Path, seconds: float, *options: str) -> tuple[float, dict[str, Any] | None]:
    """The seconds of the whole process, and what it says; None where it takes longer, or finds a fault."""
    command = [sys.executable, "-m", "robosc", "synthesize", str(path.resolve()), "--json", *options]
    began = perf_counter()
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return perf_counter() - began, None
    if done.returncode not in {0, 3}:
        print(done.stderr, file=sys.stderr)
        return perf_counter() - began, None
    return perf_counter() - began, json.loads(done.stdout)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--more", type=Path, nargs="*", default=[])
    parser.add_argument("--seconds", type=float, default=300, help="for each model")
    parser.add_argument("--guards", action="store_true", help="writes the guards out, too")
    options = parser.parse_args()
    asked = models(options.folder) | {path.stem: path for path in options.more}
    print("| model | controlled states | s, all in all | s of synthesis | most nodes | operations | MB |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    lacking = 0
    for name, path in asked.items():
        seconds, said = synthesized(path, options.seconds, *([] if options.guards else ["--counts"]))
        if said is None:
            lacking += 1
            print(f"| {name} | no answer | {seconds:.1f} | | | | |", flush=True)
            continue
        states, nodes, operations = (said[key] for key in ("controlled_states", "peak_nodes", "operations"))
        memory = (said["peak_bytes"] or 0) / 1e6
        times = f"{seconds:.2f} | {said['seconds']:.2f}"
        print(f"| {name} | {states:,} | {times} | {nodes:,} | {operations:,} | {memory:.0f} |", flush=True)
    return int(lacking > 0)


if __name__ == "__main__":
    sys.exit(main())
