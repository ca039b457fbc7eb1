"""What the generated engine costs: bytes of code and memory, nanoseconds and instructions per operation.

    python benchmarks/engine.py [MODEL.rscd]

Sizes are of the engine without names, built with `-Os`. An operation is one incoming event (`perform`), one with
settling and reactions (`batch`), or that with a tick behind it. Tools that are not installed leave a dash.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import robosc
from robosc.m2t.c.names import CNames
from robosc.m2t.c.types import interval_of, number
from robosc.models import Models
from robosc.roles import Roles

if TYPE_CHECKING:
    from robosc.metamodel.sct import SupervisoryControlModel

EXAMPLE = Path(__file__).parent.parent / "examples" / "line_follower" / "line_follower.rscd"
TARGETS = {"x86-64": ["gcc"], "Cortex-M3": ["arm-none-eabi-gcc", "-mcpu=cortex-m3", "-mthumb"]}
OPERATIONS = ("perform", "batch", "tick and batch")
#: What the time of an operation is measured over, and the instructions.
OFTEN, SELDOM = 5_000_000, 20_000

PROGRAM = """\
#include "{p}_supervisor.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static {p}_supervisor robot;

static void set(unsigned odd)
{{
    (void)odd;
{inputs}
}}

int main(int count, char **words)
{{
    static const {p}_event incoming[] = {{ {incoming} }};
    const unsigned kinds = sizeof incoming / sizeof *incoming;
    const char operation = count == 3 ? words[1][0] : 'p';
    const unsigned times = count == 3 ? (unsigned)atoi(words[2]) : 1U;
    struct timespec start, end;
    {p}_init(&robot, 0, 0);
    {p}_tick(&robot);
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (unsigned number = 0U; number < times; ++number) {{
        set(number / kinds & 1U);
        if (operation != 'p') {p}_begin(&robot);
        {p}_perform(&robot, incoming[number % kinds]);
        if (operation != 'p') {p}_end(&robot);
        if (operation == 't') {p}_tick(&robot);
    }}
    clock_gettime(CLOCK_MONOTONIC, &end);
    printf("%.2f %zu\\n", ((double)(end.tv_sec - start.tv_sec) * 1e9 + (double)(end.tv_nsec - start.tv_nsec)) / times,
           sizeof robot);
    return 0;
}}
"""


def main() -> None:
    """Measures one model and prints a table in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", nargs="?", type=Path, default=EXAMPLE)
    model = robosc.to_sct(robosc.load(parser.parse_args().model))
    robosc.synthesize(model)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path, text in robosc.generate("supervisor", Models(model)).items():
            (folder / path).write_text(text)
        _report(model, folder)


def _report(model: SupervisoryControlModel, folder: Path) -> None:
    roles = Roles(model)
    print(f"{model.name}: {len(roles.events)} events, {len(roles.silent)} of them silent\n")
    print("| `-Os` | .text | .rodata | .data | .bss |\n|---|---:|---:|---:|---:|")
    for target, compiler in TARGETS.items():
        sizes = _sizes(model, folder, compiler)
        print(f"| {target} | {' | '.join(sizes)} |")
    program = _program(model, folder)
    memory = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()[1]
    print(f"\nOne controller takes {memory} bytes of memory.\n")
    print("| operation | ns | instructions |\n|---|---:|---:|")
    for operation in OPERATIONS:
        print(f"| {operation} | {_nanoseconds(program, operation):.1f} | {_instructions(program, operation)} |")


def _sizes(model: SupervisoryControlModel, folder: Path, compiler: list[str]) -> list[str]:
    sections = ("text", "rodata", "data", "bss")
    if shutil.which(compiler[0]) is None:
        return ["-"] * len(sections)
    names, compiled = CNames(model), folder / "engine.o"
    source = folder / f"{names.prefix}_supervisor.c"
    options = ["-std=c99", "-Os", f"-D{names.macro}_NO_NAMES", "-c", str(source), "-o", str(compiled)]
    subprocess.run([*compiler, *options], check=True)
    size = compiler[0].replace("gcc", "size")
    listed = subprocess.run([size, "-A", str(compiled)], capture_output=True, text=True, check=True).stdout
    return [
        str(sum(int(each) for each in re.findall(rf"^\.{section}\S* +(\d+)", listed, flags=re.MULTILINE)))
        for section in sections
    ]


def _program(model: SupervisoryControlModel, folder: Path) -> Path:
    names, built = CNames(model), folder / "measured"
    inputs = [each for plant in model.plants for each in plant.inputs]
    incoming = Roles(model).incoming or Roles(model).events
    (folder / "main.c").write_text(
        PROGRAM.format(
            p=names.prefix,
            incoming=", ".join(names.enumerator(each) for each in incoming),
            inputs="\n".join(
                f"    robot.inputs.{names.member(each)} = odd ? {number(values.low)} : {number(values.high)};"
                for each in inputs
                for values in [interval_of(each.type)]
            ),
        )
    )
    source = folder / f"{names.prefix}_supervisor.c"
    subprocess.run([*TARGETS["x86-64"], "-std=gnu99", "-O2", folder / "main.c", source, "-o", built], check=True)
    return built


def _nanoseconds(program: Path, operation: str) -> float:
    """The best of five runs."""
    runs = [
        subprocess.run([program, operation, str(OFTEN // 5)], capture_output=True, text=True, check=True).stdout
        for _ in range(5)
    ]
    return min(float(each.split()[0]) for each in runs)


def _instructions(program: Path, operation: str) -> str:
    """Counted by callgrind as the difference of two runs, so that starting up is left out."""
    if shutil.which("valgrind") is None:
        return "-"
    counts = []
    for times in (SELDOM, 2 * SELDOM):
        command = [
            "valgrind",
            "--tool=callgrind",
            "--callgrind-out-file=/dev/null",
            str(program),
            operation,
            str(times),
        ]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stderr
        counts.append(int(re.findall(r"Collected : (\d+)", told)[0]))
    return f"{(counts[1] - counts[0]) / SELDOM:.1f}"


if __name__ == "__main__":
    main()
