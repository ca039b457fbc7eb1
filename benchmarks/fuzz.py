"""Run many faulty and random valid models through the whole pipeline; end with 1 on a failure.

    python benchmarks/fuzz.py [--mutants 20000] [--valid 2000] [--cif 2000] [--cif-mutants 5000] [--seed 0] [--jobs 2]
        [--keep FOLDER]

A mutant must end in located findings or in generated code, within 10 s of processor time and 1 GB of memory. For every
hundredth the command line must end with the right exit status. Each fifth is a saved model (XMI), for which the command
line must not reveal the content of other files. Each fiftieth has a pipe, a device or the like in place of a file. Each
hundredth is written by a command that a signal ends.

A valid robot has no errors. Its CIF can be read back, and its engine in C performs 200 random operations like the
interpreter. A random specification of CIF has the states of synthesis by the definition, or a located finding that
names what synthesis does not support. A mutant of one goes through `check`, `synthesize` and `transform`. Each model is
made from a number alone: `--mutants 1 --valid 0 --cif 0 --cif-mutants 0 --seed N` tries the mutant N again. `--keep`
writes the failed models to a folder.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import sys
import tempfile
import traceback
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.fuzz.broken_off import broken_off_tried  # noqa: E402
from tests.fuzz.cif_mutants import cif_mutant  # noqa: E402
from tests.fuzz.mutants import mutant  # noqa: E402
from tests.fuzz.saved_mutants import saved_mutant  # noqa: E402
from tests.fuzz.special import special_tried  # noqa: E402
from tests.fuzz.trial import called, cif_tried, saved_tried, time_limit, tried  # noqa: E402
from tests.fuzz.valid import checked, compared, compiled, valid_robot  # noqa: E402
from tests.language.cif.comparing import agrees  # noqa: E402
from tests.language.cif.random_specifications import Specification  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable

#: Limits of a mutant: processor seconds, and bytes of memory beyond those of the program itself.
LIMIT, MEMORY = 10, 10**9
#: Limits of a valid robot: synthesis of a few densely connected ones takes minutes, and much memory.
VALID_LIMIT, VALID_MEMORY = 600, 4 * 10**9
CHUNKS = {"mutants": 100, "valid": 25, "cif": 50, "cif-mutants": 50}
CALLED_EACH, SAVED_EACH, SPECIAL_EACH, BROKEN_OFF_EACH = 100, 5, 50, 100
#: Trials of numbers that stand for no text of a model.
OTHERS = {"saved": saved_tried, "special": special_tried, "broken off": broken_off_tried}


@dataclass
class Result:
    """Results of some models: counts of outcomes, the slowest, the largest, and the failures."""

    statuses: Counter[str] = field(default_factory=Counter)
    slowest: tuple[float, int] = (0.0, 0)
    largest: tuple[int, int] = (0, 0)
    failures: list[tuple[int, str]] = field(default_factory=list)

    def try_one(
        self, seed: int, trial: Callable[..., Any], *arguments: object, limit: int = LIMIT, memory: int = MEMORY
    ) -> Any:
        """Return the result of a trial with these arguments; None if it fails."""
        began = process_time()
        _forget_peak()
        # A hang that no signal can stop ends with its process; the limit allows for a busy machine.
        faulthandler.dump_traceback_later(200 * limit, exit=True)
        try:
            with time_limit(limit):
                return trial(*arguments)
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            where = f"{Path(place.filename).name}:{place.lineno}"
            self.failures.append((seed, f"{type(error).__name__}: {str(error)[:300]} ({where})"))
            self.statuses["failed"] += 1
            return None
        finally:
            faulthandler.cancel_dump_traceback_later()
            self.slowest = max(self.slowest, (process_time() - began, seed))
            self.largest = max(self.largest, (_peak(), seed))
            if _peak() > memory:
                self.failures.append((seed, f"takes {_peak() / 1e6:.0f} MB"))

    def add(self, other: Result) -> None:
        """Add another result to this one."""
        self.statuses += other.statuses
        self.slowest = max(self.slowest, other.slowest)
        self.largest = max(self.largest, other.largest)
        self.failures += other.failures


def _forget_peak() -> None:
    """Reset the peak memory of this process in Linux."""
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def _peak() -> int:
    """Return the peak memory of this process since the reset, in bytes."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM:"))


def _kind(seed: int) -> str:
    if seed % BROKEN_OFF_EACH == 2:
        return "broken off"
    return "special" if seed % SPECIAL_EACH == 3 else "saved" if seed % SAVED_EACH == 1 else "text"


def mutants(seeds: range) -> Result:
    """Try the mutants of these numbers."""
    result = Result()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.rscd"
        for seed in seeds:
            kind = _kind(seed)
            if kind != "text":
                status = result.try_one(seed, OTHERS[kind], Path(folder), seed)
                result.statuses[f"{kind}: {status}"] += status is not None
                continue
            path.write_text(mutant(seed), encoding="utf-8")
            targets = ["cif", "supervisor", ("ros1", "ros2", "xmi")[seed % 3]]
            outcome = result.try_one(seed, tried, path, targets)
            if outcome is not None:
                result.statuses[f"exit status {outcome.status}"] += 1
                if seed % CALLED_EACH == 0:
                    result.try_one(seed, called, path, seed)
                    result.statuses["by command line"] += 1
    return result


def valid(seeds: range) -> Result:
    """Try the random robots of these numbers, their engines compiled together."""
    result = Result()
    limits = {"limit": VALID_LIMIT, "memory": VALID_MEMORY}
    with tempfile.TemporaryDirectory() as name:
        folder, robots = Path(name), []
        for seed in seeds:
            found = result.try_one(seed, checked, seed, folder / "robot.rscd", **limits)
            if found is not None:
                outcome, robot = found
                result.statuses[f"exit status {outcome.status}"] += 1
                robots += [robot] if robot else []
        built = result.try_one(seeds[0], compiled, robots, folder, ["-O0"], **limits) if robots else None
        for robot in robots if built else ():
            result.try_one(robot.seed, compared, robot, built, **limits)
        result.statuses["compiled and compared"] += len(robots) if built else 0
    return result


def _specification(seed: int) -> Specification:
    """Return a random specification of CIF; every other one is limited to what CIF's own synthesis supports."""
    return Specification(seed, narrow=seed % 2 == 1)


def cif(seeds: range) -> Result:
    """Compare the random specifications of CIF of these numbers with synthesis by the definition."""
    result = Result()
    for seed in seeds:
        failed = len(result.failures)
        count = result.try_one(seed, agrees, _specification(seed))
        if len(result.failures) == failed:
            outcome = "not taken" if count is None else "supervisor" if count else "empty"
            result.statuses[outcome] += 1
    return result


def cif_mutants(seeds: range) -> Result:
    """Try the mutants of CIF specifications of these numbers."""
    result = Result()
    for seed in seeds:
        with tempfile.TemporaryDirectory() as folder:
            status = result.try_one(seed, cif_tried, Path(folder), cif_mutant(seed))
            result.statuses[f"exit status {status}"] += status is not None
    return result


TRIALS = {"mutants": mutants, "valid": valid, "cif": cif, "cif-mutants": cif_mutants}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutants", type=int, default=20_000)
    parser.add_argument("--valid", type=int, default=2_000)
    parser.add_argument("--cif", type=int, default=2_000, help="random specifications of CIF")
    parser.add_argument("--cif-mutants", type=int, default=5_000)
    parser.add_argument("--seed", type=int, default=0, help="the number of the first model")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", type=Path, help="the folder for models that failed")
    options = parser.parse_args()
    print("| models | number | s | a second | outcomes | slowest | largest | failed |")
    print("|---|---:|---:|---:|---|---|---|---:|")
    failed = False
    for kind, trial in TRIALS.items():
        number = getattr(options, kind.replace("-", "_"))
        seeds = range(options.seed, options.seed + number)
        began = perf_counter()
        result = _in_parallel(
            trial, [seeds[at : at + CHUNKS[kind]] for at in range(0, number, CHUNKS[kind])], options.jobs
        )
        seconds = perf_counter() - began
        outcomes = ", ".join(f"{status}: {count}" for status, count in sorted(result.statuses.items()))
        slowest = f"{result.slowest[0]:.1f} s (seed {result.slowest[1]})"
        largest = f"{result.largest[0] / 1e6:.0f} MB (seed {result.largest[1]})"
        print(
            f"| {kind} | {number} | {seconds:.0f} | {number / max(seconds, 1e-9):.1f} | {outcomes} | {slowest} "
            f"| {largest} | {len(result.failures)} |",
            flush=True,
        )
        _show(kind, result.failures, options.keep)
        failed = failed or bool(result.failures)
    return int(failed)


def _in_parallel(trial: Callable[[range], Result], chunks: list[range], jobs: int) -> Result:
    whole = Result()
    with ProcessPoolExecutor(jobs) as pool:
        running = {pool.submit(trial, chunk): chunk for chunk in chunks}
        for done in as_completed(running):
            try:
                whole.add(done.result())
            except BrokenProcessPool:
                chunk = running[done]
                whole.failures.append((chunk[0], f"the process ended in or beside {chunk[0]} to {chunk[-1]}"))
    return whole


def _files(kind: str, seed: int) -> dict[str, str]:
    """Return the files of a tried model, without special files in place of files."""
    if kind == "cif":
        return _specification(seed).files
    if kind == "cif-mutants":
        return {name: content.decode(errors="surrogateescape") for name, content in cif_mutant(seed).items()}
    if kind == "valid":
        return {"model.rscd": valid_robot(seed)}
    if _kind(seed) == "saved":
        return saved_mutant(seed)[1]
    return {"model.rscd": mutant(seed)} if _kind(seed) == "text" else {}


def _show(kind: str, failures: list[tuple[int, str]], folder: Path | None) -> None:
    for seed, message in sorted(failures):
        others = " ".join(f"--{other} 0" for other in TRIALS if other != kind)
        print(
            f"failed: {message}\n  again: python benchmarks/fuzz.py --{kind} 1 {others} --seed {seed}", file=sys.stderr
        )
        if folder:
            folder.mkdir(parents=True, exist_ok=True)
            files = _files(kind, seed)
            for name, text in files.items():
                (folder / f"{kind}_{seed}.{name}").write_bytes(text.encode(errors="surrogateescape"))


if __name__ == "__main__":
    sys.exit(main())
