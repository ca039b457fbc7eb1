"""Comparison of the generated C with the supervised model, state by state."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod
from typing import TYPE_CHECKING

from robosc.analysis.system import GuardedSystem, format_count
from robosc.analysis.verify.c_program import TEXT, CProgram
from robosc.analysis.verify.differences import different, event_in_words, on_one_side, refute, where
from robosc.analysis.verify.transitions import AmbiguityError, of_system
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.model import sct
from robosc.model.semantics.roles import assumption_text, event_name
from robosc.model.semantics.start import first_state
from robosc.synthesis import MEMORY
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import BitLayout, Encoding, domain_size, smallest

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

PROPERTY = "c-translation"


@dataclass(frozen=True)
class Effort:
    """Limits of the exploration: all states are explored up to these limits, else a random walk is taken.

    `states` is the maximum number of states, and `steps` that of steps from them. A step is an event with values of its
    inputs. `walk` is the number of random steps, which are the same on every run.
    """

    states: int = 1_000_000
    steps: int = 500_000_000
    walk: int = 1_000_000


def explore_events(program: CProgram, effort: Effort | None = None) -> Verdict:
    """Return whether the events of the compiled C agree with the model under its supervisor.

    Raises CompileError if the text is not valid C, and MemoryError if the decision diagrams take more than 4 GB.
    """
    try:
        return with_enough_memory(_Trial(program, effort or Effort()).run, MEMORY)
    except AmbiguityError as open_:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", f"{open_}, and {TEXT} takes the first")


class _Trial:
    """Comparison run of one model's engine."""

    def __init__(self, program: CProgram, effort: Effort) -> None:
        self._program = program
        self._model = program.model
        self._effort = effort
        self._layout = BitLayout(program.model)
        self._cells, self._inputs, self._events = program.cells, program.inputs, program.events

    def run(self, capacity: int) -> Verdict:
        """Return the verdict, with room for `capacity` nodes in the decision diagrams."""
        encoding = Encoding(self._layout, Diagrams(self._layout.levels, capacity))
        system = GuardedSystem(self._model, encoding)
        (self._program.folder / "reference").write_text("\n".join(self._reference(system)), encoding="ascii")
        effort = self._effort
        # The supervisor holds the number of states. If it is wrong, the explorer stops at its limit.
        known = system.supervisor.controlledStates or 0
        widest = max((prod(map(domain_size, event.inputs)) for event in self._events), default=1)
        states = effort.states if known <= effort.states and known * widest <= effort.steps else 0
        command = [self._program.explorer, "reference", str(states), str(effort.steps), str(effort.walk)]
        done = self._program.run_command(command)
        if done.returncode != 0:
            return refute(PROPERTY, f"{TEXT} ends with status {done.returncode}: {done.stderr.strip()}")
        word, *numbers = done.stdout.split()
        return self._verdict(system, word, list(map(int, numbers)))

    def _reference(self, system: GuardedSystem) -> Iterator[str]:
        """Yield the lines that `load` in the explorer reads."""
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
            conditions = nodes.number(system.allowed[event]), nodes.number(transition.enabled)
            yield " ".join(map(str, (*conditions, len(event.inputs))))
            yield from (str(inputs[parameter]) for parameter in event.inputs)
            yield str(len(changed))
            for element in changed:
                bits = transition.bits(element, system.encoding)
                yield " ".join(map(str, (cells[element], *map(nodes.number, bits))))
            yield from (str(nodes.number(violated)) for violated in self._violations(system, event))

    def _violations(self, system: GuardedSystem, event: sct.Event) -> Iterator[Diagram]:
        """Yield the states in which an event violates each assumption: all other plants allow it there."""
        enabled_by = system.relations[event].enabled_by
        others = [enabled for plant, enabled in enabled_by.items() if plant.kind != sct.PlantKind.assumption]
        for assumption in self._program.assumptions:
            holds = enabled_by.get(assumption, system.diagrams.true)
            yield system.diagrams.all_of([~holds, *others])

    def _verdict(self, system: GuardedSystem, word: str, numbers: Sequence[int]) -> Verdict:
        match word:
            case "explored":
                evidence = f"{format_count(numbers[0], 'state')}, {format_count(numbers[1], 'step')}"
                return Verdict(PROPERTY, Outcome.PROVED, evidence)
            case "walked":
                return Verdict(PROPERTY, Outcome.SAMPLED, format_count(numbers[0], "random step"))
            case "missing":
                return refute(PROPERTY, f"{TEXT} has no event `{event_name(self._events[numbers[0]])}`")
            case "initial":
                codes = dict(zip(self._cells, numbers, strict=True))
                return refute(PROPERTY, f"at the start {different(codes, _start(self._model), TEXT)}")
            case "violates":
                return self._violation(system, numbers)
        return self._difference(system, numbers)

    def _violation(self, system: GuardedSystem, numbers: Sequence[int]) -> Verdict:
        event, assumption = self._events[numbers[0]], self._program.assumptions[numbers[1]]
        before = dict(zip(self._cells, numbers[3:], strict=True))
        state = {domain.element: before.get(domain.element, 0) for domain in self._layout.state}
        sides = (TEXT, "the model") if numbers[2] else ("the model", TEXT)
        what = f"{event_in_words(event, {})} violates `{assumption_text(assumption)}` in {sides[0]}"
        way = system.trace(system.path_to(system.encoding.state(state)))
        return refute(PROPERTY, f"{what} and not in {sides[1]}{where(system, event, state)}", way)

    def _difference(self, system: GuardedSystem, numbers: Sequence[int]) -> Verdict:
        event, (possible, enabled, allowed, performed) = self._events[numbers[0]], numbers[1:5]
        codes = iter(numbers[5:])
        before, inputs, after, expected = (
            dict(zip(elements, codes, strict=False))
            for elements in (self._cells, self._inputs, self._cells, self._cells)
        )
        state = {domain.element: before.get(domain.element, 0) for domain in self._layout.state}
        way = system.trace(system.path_to(system.encoding.state(state)))
        step = event_in_words(event, inputs if possible and enabled else {})
        if enabled != possible:
            what = on_one_side(step, TEXT, translated=bool(enabled))
        elif possible and not allowed:
            what = on_one_side(step, TEXT, translated=True)
        elif performed != possible:
            what = f"{step} {'is enabled but does not' if possible else 'is not enabled but does'} happen in {TEXT}"
        else:
            what = f"after {step}, {'' if possible else 'which can not happen, '}{different(after, expected, TEXT)}"
        return refute(PROPERTY, what + where(system, event, state), way)


def _start(model: sct.SupervisoryControlModel) -> dict[Element, int]:
    """Return the code of each element at the start."""
    return {cell: value - smallest(cell) for cell, value in first_state(model).items()}


class _Nodes:
    """Numbered nodes of decision diagrams: false is 0, true is 1, and children come before their parents."""

    def __init__(self, diagrams: Diagrams) -> None:
        self.lines: list[str] = []
        self._numbers = {diagrams.false: 0, diagrams.true: 1}

    def number(self, diagram: Diagram) -> int:
        """Add the nodes of a diagram; return the number of its root."""
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
