"""A discrete-event system of plain automata, as the readers of this package create it.

`cif_text` writes the system as CIF. Names in CIF are unique identifiers; all other names are those of the file.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, Severity, has_errors
from robosc.language.cif.parsing import identifier
from robosc.model.semantics.naming import Names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model.places import Place

_NO_WORD = re.compile(r"[^A-Za-z0-9]+")


class FaultError(Exception):
    """A fault in a file: its place, the rule, the message, and the hint."""

    def __init__(self, place: Place, rule: str, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.place = place
        self.rule = rule
        self.message = message
        self.hint = hint

    def finding(self, severity: Severity = Severity.ERROR) -> Diagnostic:
        """Return the fault as a finding."""
        assert self.place.file is not None
        return Diagnostic(self.place.file.path, self.place.span, severity, self.rule, self.message, self.hint)


def construct(place: Place, what: str, hint: str) -> FaultError:
    """Return the fault of a construct that synthesis does not support, with the hint that removes it."""
    return FaultError(place, "automata-construct", f"synthesis does not take {what}", hint)


@dataclass(eq=False)
class Event:
    """An event: its name in CIF, and whether the supervisor may forbid it; None if no file determines it.

    The answer of a plant is `final`.
    """

    name: str
    cif: str
    controllable: bool | None
    place: Place
    final: bool = False


@dataclass(eq=False)
class State:
    """A state of an automaton. `cif` is its name in CIF once `System.name_states` has run."""

    name: str
    place: Place
    initial: bool = False
    marked: bool = False
    forbidden: bool = False
    cif: str = ""


@dataclass(eq=False)
class Edge:
    """An edge for one event; its conditions and its updates are CIF text."""

    source: State
    event: Event
    target: State
    place: Place
    guards: list[str] = field(default_factory=list)
    updates: list[str] = field(default_factory=list)


@dataclass(eq=False)
class Automaton:
    """An automaton. `alphabet` has also events without an edge, which the automaton never permits.

    `declarations` are its variables as CIF text.
    """

    name: str
    cif: str
    requirement: bool
    place: Place
    alphabet: dict[Event, None] = field(default_factory=dict)
    states: dict[str, State] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    declarations: list[tuple[str, Place]] = field(default_factory=list)

    def at(self, state: State) -> list[str]:
        """Return the condition that the automaton is in a state; empty if it has no other state."""
        return [f"{self.cif}.{state.cif}"] if len(self.states) > 1 else []


class System:
    """Events and automata of a system. `findings` are the faults of all its files."""

    def __init__(self, name: str, place: Place) -> None:
        self.name = name
        self.place = place
        self.events: dict[str, Event] = {}
        self.automata: list[Automaton] = []
        #: Further declarations as CIF text: enumerations before the automata, predicates after them.
        self.enumerations: list[tuple[str, Place]] = []
        self.predicates: list[tuple[str, Place]] = []
        self.findings: list[Diagnostic] = []
        self._names: set[str] = set()

    def fresh(self, name: str, prefix: str) -> str:
        """Return a free identifier that is no keyword; `prefix` precedes a name that begins with a digit."""
        return self._fresh(name, prefix, self._names)

    @staticmethod
    def _fresh(name: str, prefix: str, taken: set[str]) -> str:
        word = _NO_WORD.sub("_", name).strip("_") or prefix
        word = word if word[0].isalpha() else prefix + word
        # CIF's tools do not accept every keyword with a dollar sign before it.
        fresh = Names(taken).fresh(word if identifier(word) == word else f"{word}_")
        taken.add(fresh)
        return fresh

    def event(self, name: str, place: Place, *, controllable: bool | None, final: bool = True) -> Event:
        """Return the event of a name, created if it is new. Report if another plant determines the opposite."""
        event = self.events.get(name)
        if event is None:
            event = self.events[name] = Event(name, self.fresh(name, "e"), None, place)
        if controllable is None:
            return event
        if final and event.final and event.controllable != controllable:
            message = f"the event `{name}` is {'un' * (not controllable)}controllable here, but not in another plant"
            fault = FaultError(place, "automata-declaration", message, "make it the same in all plants")
            self.findings.append(fault.finding())
        elif final or not event.final:
            event.controllable, event.final = controllable, final
        return event

    def automaton(self, name: str, place: Place, *, requirement: bool) -> Automaton:
        """Return a new automaton."""
        automaton = Automaton(name, self.fresh(name, "A"), requirement, place)
        self.automata.append(automaton)
        return automaton

    def name_states(self) -> None:
        """Give states their names in CIF. They differ from the names of events and automata, which they would hide."""
        for automaton in self.automata:
            taken = set(self._names)
            for state in automaton.states.values():
                state.cif = self._fresh(state.name, "s", taken)

    @contextmanager
    def reporting(self) -> Iterator[None]:
        """Add the fault of the `with` block to the findings."""
        try:
            yield
        except FaultError as fault:
            self.findings.append(fault.finding())

    def hidden(self, event: str, place: Place) -> None:
        """Warn about an event that the file hides from the supervisor."""
        message = f"`{event}` is unobservable in the file, but the supervisor observes every event"
        fault = FaultError(place, "automata-construct", message, "make sure that the controller can observe it")
        self.findings.append(fault.finding(Severity.WARNING))

    def check(self) -> None:
        """Report faults of whole automata: no plant, or not exactly one initial state.

        Only the latter is no consequence of other faults.
        """
        faults = []
        if all(automaton.requirement for automaton in self.automata):
            faults.append(FaultError(self.place, "automata-declaration", "there is no plant", "make one a plant"))
        for automaton in self.automata:
            if not any(state.initial for state in automaton.states.values()):
                message, hint = f"`{automaton.name}` has no initial state", "make one of its states initial"
                faults.append(FaultError(automaton.place, "initial-state", message, hint))
        if not has_errors(self.findings):
            self.findings += [fault.finding() for fault in faults]
        for automaton in self.automata:
            for state in [state for state in automaton.states.values() if state.initial][1:]:
                message, hint = f"`{automaton.name}` has several initial states", "keep one of them"
                self.findings.append(FaultError(state.place, "initial-state", message, hint).finding())
