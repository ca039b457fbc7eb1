"""Costs of a generated engine, counted and so reproducible: instructions, steps, bytes, stack.

Instructions are those of x86-64 under callgrind, in a random walk through the events of the robot and its controller.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robosc.language.configuration import ControlLoop
from robosc.m2m.sct_to_engine import transform
from robosc.m2t.c import engine
from robosc.m2t.c.names import CNames
from robosc.model.semantics.domains import domain
from robosc.model.semantics.roles import Roles

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from robosc.model.sct import SupervisoryControlModel

#: Batches in a walk; every fourth is followed by a tick.
BATCHES = 400
TARGETS = {"x86-64": ["gcc"], "Cortex-M3": ["arm-none-eabi-gcc", "-mcpu=cortex-m3", "-mthumb"]}
OPTIONS = ["-std=c99", "-Os"]

PROGRAM = """\
#include "{p}_supervisor.h"
#include <stdio.h>
#include <stdlib.h>

static {p}_supervisor robot;
static unsigned steps;
static uint32_t now;
static uint64_t number = 1U;

static uint64_t chance(void)
{{
    number = number * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return number >> 33;
}}

static void count(void *context, {p}_event event)
{{
    (void)context;
    (void)event;
    ++steps;
}}

static void set(void)
{{
{inputs}
}}

/* One of the events from the robot that can happen now, at random; -1 if there is none. */
static int choose(void)
{{
    static const {p}_event incoming[] = {{ {incoming} }};
    int chosen = -1;
    unsigned found = 0U;
    for (unsigned index = 0U; index < sizeof incoming / sizeof *incoming; ++index) {{
        if ({p}_enabled(&robot, incoming[index]) && chance() % ++found == 0U) chosen = (int)incoming[index];
    }}
    return chosen;
}}

static unsigned enabled(void)
{{
    unsigned found = 0U;
    for (unsigned index = 0U; index < {queued}U; ++index) found += {p}_enabled(&robot, ({p}_event)index);
    return found;
}}

int main(int words, char **word)
{{
    const {p}_hooks hooks = {{ NULL, NULL, count, NULL }};
    const unsigned batches = (unsigned)atoi(word[1]);
    (void)words;
    {p}_init(&robot, NULL, word[2][0] == 's' ? &hooks : NULL{now});
    {p}_tick(&robot{now});
    for (unsigned batch = 1U; batch <= batches; ++batch) {{
        const int event = choose();
        set();
        steps = 0U;
        now += 10U;
        {p}_begin(&robot{now});
        if (event >= 0) {p}_perform(&robot, ({p}_event)event{now});
        {p}_end(&robot{now});
        printf("batch %u %d\\n", steps, event);
        if (batch % 4U == 0U) {{
            const unsigned before = enabled();
            steps = 0U;
            {p}_tick(&robot{now});
            printf("tick %u %u\\n", steps, before);
        }}
    }}
    return 0;
}}
"""


@dataclass(frozen=True)
class Size:
    """Sizes in bytes: sections of the object file (without names), one controller, and the stack of an engine call."""

    text: int
    rodata: int
    data: int
    bss: int
    controller: int
    stack: int


@dataclass(frozen=True)
class Count:
    """Mean and maximum over the calls of one function."""

    mean: float
    most: int


@dataclass(frozen=True)
class Costs:
    """Costs of one model's engine. `steps` are events in a tick, `bound` is their maximum in the worst case.

    Instructions: `perform` one event; `batch` is begin and end; `tick` one tick, and `idle` the cheapest one. None if
    callgrind is not installed.
    """

    events: int
    sizes: dict[str, Size]
    steps: Count
    bound: int
    perform: Count | None = None
    batch: Count | None = None
    tick: Count | None = None
    idle: int | None = None


def measured(model: SupervisoryControlModel, folder: Path, targets: Mapping[str, Sequence[str]] = TARGETS) -> Costs:
    """Build the engine of a model with its supervisor in a folder, and count its costs; sizes for the given targets."""
    names = CNames(model)
    for path, text in engine.generate(transform(model), ControlLoop()).items():
        (folder / path).write_text(text)
    source = folder / f"{names.prefix}_supervisor.c"
    sizes = {target: size(source, names, command) for target, command in targets.items() if shutil.which(command[0])}
    program = _program(model, source)
    walked = [line.split() for line in _run(program, str(BATCHES), "steps").splitlines()]
    ticks = [int(steps) for kind, steps, _ in walked if kind == "tick"]
    costs = Costs(len(Roles(model).events), sizes, _count(ticks), tick_bound(Roles(model)))
    if shutil.which("valgrind") is None:
        return costs
    begins, performs, ends, ticked = (
        _instructions(program, f"{names.prefix}_{function}") for function in ("begin", "perform", "end", "tick")
    )
    ticked = ticked[1:]  # The first one comes before the walk.
    return replace(
        costs,
        perform=_count(performs),
        batch=_count([begin + end for begin, end in zip(begins, ends, strict=True)]),
        tick=_count(ticked),
        idle=min(ticked),
    )


def tick_bound(roles: Roles) -> int:
    """Return the maximum number of events in a tick: one settling, and one more after each cancel and trigger.

    Settling runs at most its bound of silent events. Before each of them and at the end, each data plant moves once.
    """
    silent = roles.settling_bound if roles.silent else 0
    settling = silent + (silent + 1) * len(roles.data)
    return settling + (len(roles.cancels) + len(roles.triggers)) * (1 + settling)


def size(source: Path, names: CNames, command: Sequence[str]) -> Size:
    """Return the sizes of an engine in bytes, with one compiler."""
    compiled = source.with_suffix(".o")
    asked = [f"-D{names.macro}_NO_NAMES", "-fcallgraph-info=su", "-c", source.name, "-o", compiled.name]
    subprocess.run([*command, *OPTIONS, *asked], cwd=source.parent, check=True)
    listed = _run(command[0].replace("gcc", "size"), "-A", str(compiled))
    sections = [
        sum(int(number) for number in re.findall(rf"^\.{section}\S* +(\d+)", listed, flags=re.MULTILINE))
        for section in ("text", "rodata", "data", "bss")
    ]
    probe = source.parent / "probe.c"
    probe.write_text(f'#include "{source.stem}.h"\nchar controller[sizeof({names.prefix}_supervisor)];\n')
    subprocess.run([*command, *OPTIONS, "-c", probe.name], cwd=source.parent, check=True)
    symbols = _run(command[0].replace("gcc", "nm"), "-S", str(probe.with_suffix(".o")))
    controller = int(symbols.split()[1], 16)
    return Size(*sections, controller, stack(source.with_suffix(".ci").read_text()))


def stack(graph: str) -> int:
    """Return the deepest stack of gcc's call graph (`-fcallgraph-info=su`), without the needs of hooks.

    Raises RecursionError if a function can call itself.
    """
    own = {
        title: int(used)
        for title, used in re.findall(r'node: \{ title: "([^"]+)" label: "[^"]*?(\d+) bytes \(static\)', graph)
    }
    calls: dict[str, set[str]] = {}
    for caller, called in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', graph):
        calls.setdefault(caller, set()).add(called)

    def below(function: str, callers: tuple[str, ...] = ()) -> int:
        if function in callers:
            raise RecursionError(f"{function} can call itself")
        inner = (below(callee, (*callers, function)) for callee in calls.get(function, ()))
        return own.get(function, 0) + max(inner, default=0)

    return max(map(below, own))


def _program(model: SupervisoryControlModel, source: Path) -> Path:
    names, roles = CNames(model), Roles(model)
    main, built = source.parent / "main.c", source.parent / "measured"
    main.write_text(
        PROGRAM.format(
            p=names.prefix,
            now=", now" if roles.timeouts else "",
            incoming=", ".join(names.enumerator(event) for event in roles.incoming or roles.events),
            queued=len(roles.cancels) + len(roles.triggers),
            inputs="\n".join(_inputs(model, names)),
        )
    )
    gcc = TARGETS["x86-64"]
    subprocess.run([*gcc, *OPTIONS, "-c", source.name, "-o", "engine.o"], cwd=source.parent, check=True)
    subprocess.run([*gcc, "-std=gnu99", "-O1", main.name, "engine.o", "-o", built], cwd=source.parent, check=True)
    return built


def _inputs(model: SupervisoryControlModel, names: CNames) -> Iterator[str]:
    """Yield statements that set each input to any of its values."""
    for input_ in (input_ for plant in model.plants for input_ in plant.inputs):
        low, high = domain(input_.type)
        member = f"robot.inputs.{names.member(input_)}"
        value = f"INT64_C({low}) + (int64_t)(chance() % UINT64_C({high - low + 1}))"
        yield f"    {member} = (__typeof__({member}))({value});"


def _instructions(program: Path, function: str) -> list[int]:
    """Return the number of instructions in each call of a function, from its first to its last."""
    dumps = program.parent / "dumps"
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={dumps}", "--combine-dumps=yes"]
    command += [f"--dump-after={function}", f"--toggle-collect={function}"]
    subprocess.run([*command, program, str(BATCHES), "instructions"], capture_output=True, check=True)
    counted = [int(number) for number in re.findall(r"^totals: (\d+)", dumps.read_text(), flags=re.MULTILINE)]
    dumps.unlink()
    return counted[:-1]  # The last dump follows the last call and is empty.


def _count(numbers: Sequence[int]) -> Count:
    return Count(sum(numbers) / len(numbers) if numbers else 0.0, max(numbers, default=0))


def _run(*command: str | Path) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
