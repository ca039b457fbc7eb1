"""Count the costs of the generated engine: instructions, steps, bytes of code and memory, stack. Nothing is timed.

    python benchmarks/engine.py                 measures the examples and the families of `families.py`, and writes
                                                benchmarks/engine.json and docs/engine.md
    python benchmarks/engine.py MODEL.rscd ...  measures these, and prints the costs
    python benchmarks/engine.py --page          writes the page anew from benchmarks/engine.json

Needs gcc. Without arm-none-eabi-gcc or valgrind their columns are missing.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

import robosc  # noqa: E402
from benchmarks.engine_costs import measured  # noqa: E402
from benchmarks.families import FAMILIES  # noqa: E402
from robosc.m2m.sct_to_engine import POLLED  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

RESULTS, PAGE = ROOT / "benchmarks" / "engine.json", ROOT / "docs" / "engine.md"
EXAMPLES = [path for path in sorted((ROOT / "examples").glob("*/*.rscd")) if path.stem == path.parent.name]
SIZES = {"cells": (1, 4, 8, 20, 64), "line": (4, 64), "sensors": (8, 64), "services": (8, 32), "philosophers": (4, 16)}
Results = dict[str, Any]


def main() -> None:
    """Measure the costs and write them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", type=Path, metavar="MODEL.rscd")
    parser.add_argument("--page", action="store_true")
    arguments = parser.parse_args()
    if arguments.models:
        found = [{"title": path.stem, **_costs(path)} for path in arguments.models]
        print(_instructions(found), _bytes(found), sep="\n")
        return
    if not arguments.page:
        RESULTS.write_text(json.dumps({"examples": list(_examples()), "families": list(_families())}, indent=1) + "\n")
    PAGE.write_text(page(json.loads(RESULTS.read_text())))


def _examples() -> Iterator[Results]:
    for path in EXAMPLES:
        print(path.stem, file=sys.stderr)
        yield {"title": path.stem.replace("_", " ").capitalize(), **_costs(path)}


def _families() -> Iterator[Results]:
    with tempfile.TemporaryDirectory() as folder:
        for name, numbers in SIZES.items():
            for number in numbers:
                print(name, number, file=sys.stderr)
                path = Path(folder) / f"{name}.rscd"
                path.write_text(FAMILIES[name].text(number))
                yield {"title": FAMILIES[name].title.replace("N", str(number), 1), **_costs(path)}


def _costs(path: Path) -> Results:
    model = robosc.to_sct(robosc.load(path))
    robosc.synthesize(model)
    with tempfile.TemporaryDirectory() as folder:
        return asdict(measured(model, Path(folder)))


def page(results: Results) -> str:
    """Return the page of the documentation."""
    text = (ROOT / "benchmarks" / "engine_page.md").read_text()
    examples, families = results["examples"], results["families"]
    return text.format(
        small=POLLED,
        instructions=_instructions(examples),
        bytes=_bytes(examples),
        families=_instructions(families),
    )


def _instructions(found: Sequence[Results]) -> str:
    head = (
        "robot",
        "events",
        "perform: mean",
        "most",
        "batch: mean",
        "most",
        "tick: mean",
        "most",
        "idle",
        "steps",
        "bound",
    )
    return _table(
        head,
        (
            [
                machine["title"],
                machine["events"],
                *(number for operation in ("perform", "batch", "tick") for number in _count(machine[operation])),
                "-" if machine["idle"] is None else f"{machine['idle']:,}",
                machine["steps"]["most"],
                f"{machine['bound']:,}",
            ]
            for machine in found
        ),
    )


def _count(count: Results | None) -> list[str]:
    return ["-", "-"] if count is None else [f"{count['mean']:,.0f}", f"{count['most']:,}"]


def _bytes(found: Sequence[Results]) -> str:
    targets = list(dict.fromkeys(target for machine in found for target in machine["sizes"]))
    columns = ("text", "rodata", "data", "bss", "controller", "stack")
    head = (
        "robot",
        *(f"{target}: {columns[0]}" if not at else column for target in targets for at, column in enumerate(columns)),
    )
    return _table(
        head,
        (
            [machine["title"], *(f"{machine['sizes'][target][of]:,}" for target in targets for of in columns)]
            for machine in found
        ),
    )


def _table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


if __name__ == "__main__":
    main()
