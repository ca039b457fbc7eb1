"""CIF text of a system. Each line has the place in the file from which it was created."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.des.automata import Automaton, Edge, System
    from robosc.model.places import Place


def lines(system: System) -> Iterator[tuple[str, Place]]:
    """Yield the lines of a system with their places. The states have their names in CIF."""
    for event in system.events.values():
        kind = "controllable" if event.controllable else "uncontrollable"
        yield f"{kind} {event.cif};", event.place
    yield from system.enumerations
    for automaton in system.automata:
        yield "", automaton.place
        yield from _automaton(automaton)
    forbidden = [
        (f"requirement invariant not {automaton.cif}.{state.cif};", state.place)
        for automaton in system.automata
        for state in automaton.states.values()
        if state.forbidden
    ]
    if forbidden or system.predicates:
        yield "", system.place
    yield from forbidden
    yield from system.predicates


def _automaton(automaton: Automaton) -> Iterator[tuple[str, Place]]:
    kind = "requirement" if automaton.requirement else "plant"
    yield f"{kind} {automaton.cif}:", automaton.place
    if set(automaton.alphabet) - {edge.event for edge in automaton.edges}:
        names = ", ".join(event.cif for event in automaton.alphabet)
        yield f"  alphabet {names};", automaton.place
    for text, place in automaton.declarations:
        yield f"  {text}", place
    # Inside an automaton, its variables and states need no qualifier.
    own = re.compile(rf"(?<![\w.$]){re.escape(automaton.cif)}\.")
    edges: dict[object, list[Edge]] = {}
    for edge in automaton.edges:
        edges.setdefault(edge.source, []).append(edge)
    for state in automaton.states.values():
        attributes = ["initial;"] * state.initial + ["marked;"] * state.marked
        colon = ":" if attributes or state in edges else ";"
        yield f"  location {state.cif}{colon}", state.place
        if attributes:
            yield f"    {' '.join(attributes)}", state.place
        for edge in edges.get(state, ()):
            yield f"    {own.sub('', _edge(edge))}", edge.place
    yield "end", automaton.place


def _edge(edge: Edge) -> str:
    guard = f" when {', '.join(edge.guards)}" if edge.guards else ""
    updates = f" do {', '.join(edge.updates)}" if edge.updates else ""
    target = f" goto {edge.target.cif}" if edge.target is not edge.source else ""
    return f"edge {edge.event.cif}{guard}{updates}{target};"
