"""Plays the generated C against the supervised model, state by state."""

from __future__ import annotations

import errno
import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass
from math import prod
from typing import TYPE_CHECKING

from robosc.analysis.system import GuardedSystem, counted
from robosc.analysis.verify.differences import different, event_in_words, on_one_side, refuted, where
from robosc.analysis.verify.loop_walk import LoopWalk
from robosc.analysis.verify.transitions import AmbiguityError, of_system
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.files.resources import locate
from robosc.files.writing import temporary_folder
from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.names import CNames
from robosc.semantics.roles import event_name, is_from_cif
from robosc.semantics.start import first_state
from robosc.synthesis import MEMORY
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import Encoding, Layout, domain_size, smallest

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from robosc.metamodel import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

PROPERTY = "c-translation"
TEXT = "the generated C"
COMPILERS = ("cc", "gcc", "clang")
#: The control loop in Python takes so many questions whether an event can happen; an operation asks all of them.
_LOOP = 500_000
#: What a compiler says that lacks room, and not an understanding of its text.
_SHORTAGE = re.compile(
    "|".join([*map(os.strerror, (errno.ENOSPC, errno.EDQUOT, errno.ENOMEM)), "Killed signal", "memory exhausted"])
)


@dataclass(frozen=True)
class Effort:
    """How far to go: all states are explored up to so many, with up to so many steps from them, else a walk is taken.

    A step is an event with values of its inputs. `walk` is the number of random steps, always the same ones;
    `operations` that of the control loop's (messages, events, ticks), fewer where a robot has many events.
    """

    states: int = 1_000_000
    steps: int = 500_000_000
    walk: int = 1_000_000
    operations: int = 5_000


def validate_c(model: sct.SupervisoryControlModel, files: Mapping[str, str], effort: Effort | None = None) -> Verdict:
    """Whether the C in these files (relative path to text), compiled, does what the model says with its supervisor.

    Raises MemoryError where the decision diagrams take more than 4 GB.
    """
    compiler = next(filter(shutil.which, COMPILERS), None)
    if compiler is None:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", f"there is no C compiler ({', '.join(COMPILERS)}) to try it with")
    try:
        with temporary_folder() as folder:
            trial = _Trial(model, folder, effort or Effort())
            fault = trial.build(compiler, files)
            if fault is not None:
                return refuted(PROPERTY, fault)
            return with_enough_memory(trial.run, MEMORY)
    except AmbiguityError as open_:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", f"{open_}, and {TEXT} takes the first")
    except OSError as error:  # that says nothing about the C
        return Verdict(PROPERTY, Outcome.SKIPPED, "", f"it can't be tried in the folder for temporary files: {error}")


class _Trial:
    """An explorer of one model's engine, built in a folder."""

    def __init__(self, model: sct.SupervisoryControlModel, folder: Path, effort: Effort) -> None:
        self._model = model
        self._folder = folder
        self._effort = effort
        self._layout = Layout(model)
        #: What the engine's state holds, and then its inputs.
        self._cells: list[Element] = []
        for plant in model.plants:
            self._cells += [*([plant] if len(plant.locations) > 1 else []), *plant.variables]
        self._inputs: list[Element] = [parameter for plant in model.plants for parameter in plant.inputs]
        self._events = [event for plant in model.plants for event in plant.events]

    def build(self, compiler: str, files: Mapping[str, str]) -> str | None:
        """Compiles engine and explorer; what is wrong with the engine, if anything. Raises OSError where it can't."""
        for path, text in files.items():
            (self._folder / path).write_text(text, encoding="utf-8")
        names = CNames(self._model)
        shutil.copy(locate("analysis/verify/explorer.c"), self._folder)
        (self._folder / "model.h").write_text(self._header(names), encoding="utf-8")
        sources = [f"{names.prefix}_supervisor.c", "explorer.c"]
        command = [compiler, "-std=c99", "-O1", "-w", *sources, "-o", "explorer"]
        done = self._done(command)
        if done.returncode == 0:
            return None
        short = next((line for line in done.stderr.splitlines() if _SHORTAGE.search(line)), None)
        if short is not None or done.returncode < 0:
            raise OSError(short or f"{compiler} was ended by signal {-done.returncode}")
        first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr.strip())
        return f"{compiler} does not compile {TEXT}: {first}"

    def _done(self, command: Sequence[str]) -> subprocess.CompletedProcess[str]:
        """As `subprocess.run` in the folder; but where that is interrupted, what the command has begun ends, too."""
        with subprocess.Popen(  # noqa: S603
            command,
            cwd=self._folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env={**os.environ, "LC_ALL": "C"},
            process_group=0,
        ) as process:
            try:
                output, errors = process.communicate()
            except BaseException:
                if sys.platform == "win32":
                    process.kill()
                else:
                    os.killpg(process.pid, signal.SIGKILL)
                raise
        return subprocess.CompletedProcess(command, process.returncode, output, errors)

    def _header(self, names: CNames) -> str:
        """What of `explorer.c` the model decides; `explorer.c` says what each macro is."""

        def for_all(elements: Sequence[Element]) -> str:
            told = (
                f"DO({number}, {names.member(one)}, {smallest(one) % 2**64})" for number, one in enumerate(elements)
            )
            return " ".join(told)

        durations = (f"DO({number}, {names.setting(one)})" for number, one in enumerate(self._model.durations))
        events = " ".join(f"{string_literal(event_name(event))}," for event in self._events)
        return (
            f'#include "{names.prefix}_supervisor.h"\n'
            f"enum {{ CELLS = {len(self._cells)}, INPUTS = {len(self._inputs)}, EVENTS = {len(self._events)} }};\n"
            f"#define EVENT_NAMES {events}\n"
            f"#define FOR_CELLS(DO) {for_all(self._cells)}\n"
            f"#define FOR_INPUTS(DO) {for_all(self._inputs)}\n"
            f"#define ENGINE(name) {names.prefix}_##name\n"
            f"#define ENGINE_EVENTS {names.macro}_EVENT_COUNT\n"
            f"#define FOR_DURATIONS(DO) {' '.join(durations)}\n"
            + ("#define TIMES\n" if any(event.timer for event in self._events) else "")
            + ("#define STEPWISE\n" if is_from_cif(self._model) else "")
        )

    def run(self, capacity: int) -> Verdict:
        """What the explorer finds, with so many nodes for the decision diagrams."""
        encoding = Encoding(self._layout, Diagrams(self._layout.levels, capacity))
        system = GuardedSystem(self._model, encoding)
        (self._folder / "reference").write_text("\n".join(self._reference(system)), encoding="ascii")
        effort = self._effort
        # The supervisor knows how many states there are; the explorer gives up by itself where it should be wrong.
        known = system.supervisor.controlledStates or 0
        widest = max((prod(map(domain_size, event.inputs)) for event in self._events), default=1)
        states = effort.states if known <= effort.states and known * widest <= effort.steps else 0
        stepwise = is_from_cif(self._model)
        loop = None if stepwise else LoopWalk(self._model, min(effort.operations, _LOOP // max(len(self._events), 1)))
        (self._folder / "script").write_text("\n".join(loop.script if loop else ()), encoding="ascii")
        command = ["./explorer", "reference", str(states), str(effort.steps), str(effort.walk), "script"]
        done = self._done(command)
        if done.returncode != 0:
            return refuted(PROPERTY, f"{TEXT} ends with status {done.returncode}: {done.stderr.strip()}")
        found, *said = done.stdout.split("\n")
        word, *numbers = found.split()
        verdict = self._verdict(system, word, list(map(int, numbers)))
        fault = loop.difference(said, TEXT) if loop and verdict.outcome is not Outcome.REFUTED else None
        return verdict if fault is None else refuted(PROPERTY, fault)

    def _reference(self, system: GuardedSystem) -> Iterator[str]:
        """What `load` in the explorer reads."""
        encoding = system.encoding
        nodes = _Nodes(encoding.diagrams)
        effects = list(self._effects(system, nodes))
        yield f"{self._layout.levels} {len(nodes.lines)}"
        yield from nodes.lines
        for cell in (*self._cells, *self._inputs):
            levels = self._layout.domains[cell].levels[::-1]
            yield " ".join(map(str, (domain_size(cell) - 1, len(levels), *levels)))
        start = _start(self._model)
        yield from (str(start[cell]) for cell in self._cells)
        yield from effects

    def _effects(self, system: GuardedSystem, nodes: _Nodes) -> Iterator[str]:
        cells = {cell: position for position, cell in enumerate(self._cells)}
        inputs = {parameter: position for position, parameter in enumerate(self._inputs)}
        for event, transition in of_system(system).items():
            changed = [cell for cell in self._cells if cell in transition.after]
            yield " ".join(map(str, (nodes.number(transition.enabled), len(event.inputs))))
            yield from (str(inputs[parameter]) for parameter in event.inputs)
            yield str(len(changed))
            for element in changed:
                bits = transition.bits(element, system.encoding)
                yield " ".join(map(str, (cells[element], *map(nodes.number, bits))))

    def _verdict(self, system: GuardedSystem, word: str, numbers: Sequence[int]) -> Verdict:
        match word:
            case "explored":
                evidence = f"{counted(numbers[0], 'state')}, {counted(numbers[1], 'step')}"
                return Verdict(PROPERTY, Outcome.PROVED, evidence)
            case "walked":
                return Verdict(PROPERTY, Outcome.SAMPLED, counted(numbers[0], "random step"))
            case "missing":
                return refuted(PROPERTY, f"{TEXT} has no event `{event_name(self._events[numbers[0]])}`")
            case "initial":
                codes = dict(zip(self._cells, numbers, strict=True))
                return refuted(PROPERTY, f"at the start {different(codes, _start(self._model), TEXT)}")
        return self._difference(system, numbers)

    def _difference(self, system: GuardedSystem, numbers: Sequence[int]) -> Verdict:
        event, (possible, enabled, performed) = self._events[numbers[0]], numbers[1:4]
        told = iter(numbers[4:])
        before, inputs, after, expected = (
            dict(zip(elements, told, strict=False))
            for elements in (self._cells, self._inputs, self._cells, self._cells)
        )
        state = {domain.element: before.get(domain.element, 0) for domain in self._layout.state}
        way = system.trace(system.path_to(system.encoding.state(state)))
        step = event_in_words(event, inputs if possible and enabled else {})
        if enabled != possible:
            what = on_one_side(step, TEXT, translated=bool(enabled))
        elif performed != possible:
            what = f"{step} {'is enabled but does not' if possible else 'is not enabled but does'} happen in {TEXT}"
        else:
            what = f"after {step}, {'' if possible else 'which can not happen, '}{different(after, expected, TEXT)}"
        return refuted(PROPERTY, what + where(system, event, state), way)


def _start(model: sct.SupervisoryControlModel) -> dict[Element, int]:
    """The code of each element at the start."""
    return {cell: value - smallest(cell) for cell, value in first_state(model).items()}


class _Nodes:
    """The nodes of decision diagrams, numbered: false is 0, true 1, and of each other the children come first."""

    def __init__(self, diagrams: Diagrams) -> None:
        self.lines: list[str] = []
        self._numbers = {diagrams.false: 0, diagrams.true: 1}

    def number(self, diagram: Diagram) -> int:
        """The number of a diagram's root."""
        pending = [diagram]
        while pending:
            top = pending[-1]
            if top in self._numbers:
                pending.pop()
                continue
            children = top.cofactors()
            assert children is not None
            missing = [child for child in children if child not in self._numbers]
            if missing:
                pending += missing
            else:
                high, low = (self._numbers[child] for child in children)
                self._numbers[top] = len(self.lines) + 2
                self.lines.append(f"{top.node_level()} {high} {low}")
        return self._numbers[diagram]
