"""Views of the present state of a run: places of components, values, timers, possible and impossible events."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robosc.analysis.blocking_in_words import counterexample_in_words
from robosc.analysis.explain import NEEDLESS, explain, explore, parse_state
from robosc.analysis.wording import in_words, name, words
from robosc.base.files import reading as files
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.roles import event_name
from robosc.run.simulation.script import REFUSE, WAIT
from robosc.run.simulation.simulation import refusal_in_words, whole_state

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from robosc.analysis.explain import Explanation
    from robosc.engine.state import State
    from robosc.run.simulation.replay import Moment, Replay

_COMMUNICATIONS = (
    sct.PlantKind.message,
    sct.PlantKind.service,
    sct.PlantKind.action,
    sct.PlantKind.serviceServer,
    sct.PlantKind.actionServer,
)


@dataclass(frozen=True)
class Frame:
    """A frame of the stack: a name, a place in a text (None if there is no text), and the plant that it shows."""

    name: str
    file: str | None
    line: int = 1
    column: int = 1
    end_line: int | None = None
    end_column: int | None = None
    plant: sct.Plant | None = None


@dataclass(frozen=True)
class Variable:
    """A name with a value; `children` are computed on demand. `path` is its name in the debug console."""

    name: str
    value: str
    children: Callable[[], Sequence[Variable]] | None = None
    path: str | None = None


class Views:
    """Views of the present state of a run."""

    def __init__(self, replay: Replay, script: str | None) -> None:
        self._replay = replay
        self._engine = replay.engine
        self._model = replay.engine.model
        self._script = script
        self.events = {event_name(event): event for event in self._engine.roles.events}
        self._texts: dict[str, list[str]] = {}
        self._explained: dict[tuple[str, State], Explanation] = {}

    # The stack

    def frames(self) -> list[Frame]:
        """Return the stack: the last step, then each component at its state, then the next line of the script."""
        last = self._replay.past[-1] if self._replay.past else None
        frames = [self._last(last)]
        for plant in self._model.plants:
            if plant.kind == sct.PlantKind.behaviour:
                here = plant.locations[self._engine.location(plant)]
                frames.append(self._frame(f"{name(plant)}: {here.name}", here, plant))
        line = self._replay.next_line
        if self._script is not None and line is not None:
            frames.append(Frame(f"next: line {line} of {Path(self._script).name}", self._script, line))
        return frames

    def _last(self, last: Moment | None) -> Frame:
        if last is None:
            return self._frame("start", self._model)
        if last.event == WAIT:
            return self._frame("time has passed", self._model)
        if last.event == REFUSE:
            return self._frame(self.describe(last), self._model)
        event = self.events[last.event]
        return self._frame(self.describe(last), next(iter(last.edges), event))

    def describe(self, moment: Moment) -> str:
        """Return a step in words."""
        if moment.event == WAIT:
            return f"{_seconds(moment.end.timers[0])} on the clock"
        phrase = (
            refusal_in_words(self._engine, moment.data["of"])
            if moment.event == REFUSE
            else words(self.events[moment.event])
        )
        return (
            phrase
            if moment.by is None
            else f"{phrase} cannot happen: {self._replay.simulation.reason(moment.event, moment.by)}"
        )

    def _frame(self, label: str, element: Any, plant: sct.Plant | None = None) -> Frame:
        file, span = place(element)
        if not Path(file).is_file():
            return Frame(label, None, plant=plant)
        return Frame(
            label,
            os.path.abspath(file),  # noqa: PTH100 - must not resolve links: the editor has the file open by this path
            span.line,
            self._units(file, span.line, span.column),
            span.end_line,
            self._units(file, span.end_line, span.end_column),
            plant,
        )

    def _units(self, file: str, line: int, column: int) -> int:
        """Return a column in UTF-16 units, as editors count them, from 1."""
        if file not in self._texts:
            try:
                self._texts[file] = files.read(file).decode("utf-8", errors="replace").split("\n")
            except OSError:
                self._texts[file] = []
        lines = self._texts[file]
        before = lines[line - 1][: column - 1] if line <= len(lines) else ""
        return column + len(before.encode("utf-16-le")) // 2 - len(before)

    # Variables

    def scopes(self, plant: sct.Plant | None) -> list[Variable]:
        """Return the scopes of a frame, its own component first."""
        own = [] if plant is None else [Variable(name(plant), "", lambda: self._component(plant))]
        scopes = [
            Variable(
                "Components", "", lambda: [self._plant(automaton) for automaton in self._of(sct.PlantKind.behaviour)]
            ),
            Variable("Communication", "", self._communication),
            Variable(
                "Requirements",
                "",
                lambda: [self._plant(automaton) for automaton in self._of(sct.PlantKind.requirement)],
            ),
            Variable("Times", "", self._times),
            Variable("Can happen", "", self._possible),
            Variable("Cannot happen", "", self._impossible),
        ]
        always = ("Components", "Can happen", "Cannot happen")
        return [*own, *(scope for scope in scopes if scope.name in always or (scope.children and scope.children()))]

    def _of(self, *kinds: sct.PlantKind) -> list[sct.Plant]:
        return [plant for plant in self._model.plants if plant.kind in kinds]

    def _component(self, plant: sct.Plant) -> list[Variable]:
        here = plant.locations[self._engine.location(plant)].name
        return [Variable("state", here, path=name(plant)), *self._variables(plant)]

    def _plant(self, plant: sct.Plant) -> Variable:
        here = plant.locations[self._engine.location(plant)].name
        return Variable(name(plant), here, (lambda: self._variables(plant)) if plant.variables else None, name(plant))

    def _variables(self, plant: sct.Plant) -> list[Variable]:
        return [
            Variable(variable.name, format_value(self._engine.value(variable)), path=f"{name(plant)}.{variable.name}")
            for variable in plant.variables
        ]

    def _communication(self) -> list[Variable]:
        plants = [plant for plant in self._of(*_COMMUNICATIONS, sct.PlantKind.data) if len(plant.locations) > 1]
        return [
            Variable(
                f"data of {name(plant)}" if plant.kind == sct.PlantKind.data else name(plant), self._plant(plant).value
            )
            for plant in plants
        ]

    def _times(self) -> list[Variable]:
        running = self._replay.timers.running
        return [
            Variable(words(self.events[event]), f"in {_seconds(left)}", path=event) for event, left in running.items()
        ]

    def _possible(self) -> list[Variable]:
        return [Variable(event, words(self.events[event]), path=event) for event in self._replay.simulation.enabled]

    def _impossible(self) -> list[Variable]:
        blocked = ((event, self._engine.blocked_by(event)) for event in self._engine.events)
        return [
            Variable(event, self._replay.simulation.reason(event, by), self._why(event), event)
            for event, by in blocked
            if by is not None
        ]

    def _why(self, event: str) -> Callable[[], Sequence[Variable]]:
        return lambda: self._reasons(self.explain(event))

    def explain(self, event: str) -> Explanation:
        """Return the explanation of `explain` for an event in the present state."""
        key = event, self._engine.state
        if key not in self._explained:
            codes = parse_state(self._model, json.dumps({"state": whole_state(self._engine)}))
            self._explained[key] = explore(self._model, lambda system: explain(system, self.events[event], codes))
        return self._explained[key]

    def _reasons(self, explanation: Explanation) -> list[Variable]:
        reasons = [
            Variable(at(note.element), note.text, _details(note.details))
            for note in (*explanation.plants, *explanation.requirements)
        ]
        if explanation.counterexample is not None:
            reasons.append(Variable("otherwise", counterexample_in_words(explanation.counterexample, self._model)))
        elif explanation.needless:
            reasons.append(Variable("supervisor", NEEDLESS))
        reasons += [Variable("would help", note.text) for note in explanation.changes]
        if explanation.way:
            reasons.append(Variable("shortest way", in_words(explanation.way, self._model)))
        return reasons

    # Names in the debug console

    def value(self, text: str) -> str | None:
        """Return the value of a component, a variable or a state by its name, or None if there is none."""
        owner, _, last = text.rpartition(".")
        for plant in self._model.plants:
            here = plant.locations[self._engine.location(plant)].name
            if plant.kind == sct.PlantKind.data:
                continue
            if text in (name(plant), plant.name):
                return str(here)
            if owner in (name(plant), plant.name):
                variable = next((variable for variable in plant.variables if variable.name == last), None)
                if variable is not None:
                    return format_value(self._engine.value(variable))
                if last in {location.name for location in plant.locations}:
                    return format_value(here == last)
        return None

    def state_name(self, text: str) -> str | None:
        """Return the name of a component or variable in the state, or None if it never changes."""
        state = self._engine.state
        owner, _, last = text.rpartition(".")
        for plant in self._model.plants:
            own, inner = text in (name(plant), plant.name), owner in (name(plant), plant.name)
            known = [plant.name] if own else [f"{plant.name}.{last}", f"{name(plant)}.{last}"] if inner else []
            match = next((candidate for candidate in known if candidate in state), None)
            if match is not None:
                return match
        return text if text in state else None


def at(element: Any) -> str:
    """Return the place of an element as `file:line:column`, without the file's folder to save room."""
    file, span = place(element)
    return f"{Path(file).name}:{span.line}:{span.column}"


def format_value(value: object) -> str:
    """Return a value as the language writes it."""
    return json.dumps(value) if isinstance(value, bool) else str(value)


def _details(details: Iterable[str]) -> Callable[[], Sequence[Variable]] | None:
    texts = list(details)
    return (lambda: [Variable(str(number), text) for number, text in enumerate(texts, 1)]) if texts else None


def _seconds(milliseconds: int) -> str:
    return f"{milliseconds / 1000:g} s"
