"""Compare operations and processor time of synthesis between two commits.

    python benchmarks/costs.py OLD [NEW] [--rounds 3] [--models line_32 FILE.cif ...] [--limit 1.5]

OLD and NEW are commits; the default of NEW is the working tree. Each model runs in its own process, old and new in
turn, so that a busy machine slows both. The least seconds of all rounds count. Ends with 1 if a model takes more than
`--limit` times as many processor seconds as before, or has another number of controlled states.

`tests/synthesis/test_costs.py` pins operations and nodes of the same models; seconds are only compared here.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from io import BytesIO
from pathlib import Path
from time import process_time
from typing import Any
from zipfile import ZipFile

ROOT = Path(__file__).parent.parent
INTERFACES = ROOT / "benchmarks" / "interfaces"
#: Robots of the families that synthesis counts within a second.
ROBOTS = {
    "cells": (8, 32),
    "sensors": (16, 64),
    "line": (16, 32),
    "philosophers": (10, 20),
    "warehouse": (8, 10, 12),
    "services": (16, 32, 48),
}


def robots() -> dict[str, str]:
    """Return the text of each robot, by its name."""
    sys.path.insert(0, str(ROOT))
    from benchmarks.families import FAMILIES  # noqa: PLC0415  # a run of another commit needs no families

    return {
        f"{family}_{number}": FAMILIES[family].text(number) for family, numbers in ROBOTS.items() for number in numbers
    }


def counted(path: Path) -> dict[str, Any]:
    """Count the controlled states of the model in a file, `.rscd` or `.cif`."""
    import robosc  # noqa: PLC0415  # of the commit on the path
    from robosc.language.cif import read  # noqa: PLC0415
    from robosc.synthesis import Statistics, count  # noqa: PLC0415

    if path.suffix == ".cif":
        model = read(str(path)).model
        assert model is not None, path
    else:
        model = robosc.to_sct(robosc.load(path, (), [INTERFACES]))
    statistics = Statistics()
    began = process_time()
    states = count(model, statistics=statistics).controlled_states
    seconds = process_time() - began
    return {
        "states": states,
        "operations": statistics.operations,
        "nodes": statistics.peak_nodes,
        "seconds": seconds,
    }


def compare(paths: list[Path], roots: tuple[Path, Path], rounds: int, limit: float) -> int:
    """Print a table of the models; return how many are slower or have other states."""
    print("| model | operations, old | new | µs an operation, old | new | seconds, new to old |")
    print("|---|---:|---:|---:|---:|---:|")
    worse = 0
    for path in paths:
        runs = [[_run(path, root) for root in roots] for _ in range(rounds)]
        old, new = (min(repeated, key=lambda run: run["seconds"]) for repeated in zip(*runs, strict=True))
        ratio = new["seconds"] / old["seconds"]
        operations = f"{old['operations']:,} | {new['operations']:,}"
        microseconds = " | ".join(f"{1e6 * run['seconds'] / max(1, run['operations']):.0f}" for run in (old, new))
        same = old["states"] == new["states"]
        print(
            f"| {path.stem} | {operations} | {microseconds} | {ratio:.2f}{'' if same else ', other states'} |",
            flush=True,
        )
        worse += ratio > limit or not same
    return worse


def _run(path: Path, root: Path) -> dict[str, Any]:
    """Return the costs of a model with the `robosc` in a folder."""
    environment = os.environ | {"PYTHONPATH": str(root)}
    command = [sys.executable, __file__, "--one", str(path)]
    done = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=True)
    costs: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return costs


def checked_out(commit: str, folder: Path) -> Path:
    """Write the files of a commit into a folder."""
    command = ["git", "-C", str(ROOT), "archive", "--format=zip", commit]
    archive = subprocess.run(command, capture_output=True, check=True).stdout
    with ZipFile(BytesIO(archive)) as files:
        files.extractall(folder)
    return folder


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", nargs="?", help="a commit")
    parser.add_argument("new", nargs="?", help="another one; the working tree if none is named")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--models", nargs="+", help="names of robots, or files; all robots if none is named")
    parser.add_argument("--limit", type=float, default=1.5, help="how many times as many seconds are too many")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(counted(options.one)))
        return 0
    if not options.old:
        parser.error("name a commit")
    texts = robots()
    with tempfile.TemporaryDirectory() as scratch:
        roots = tuple(
            ROOT if commit is None else checked_out(commit, Path(scratch, name))
            for name, commit in (("old", options.old), ("new", options.new))
        )
        paths = []
        for name in options.models or texts:
            path = Path(scratch, f"{name}.rscd") if name in texts else Path(name).resolve()
            if name in texts:
                path.write_text(texts[name], encoding="utf-8")
            paths.append(path)
        return int(compare(paths, (roots[0], roots[1]), options.rounds, options.limit) > 0)


if __name__ == "__main__":
    sys.exit(main())
