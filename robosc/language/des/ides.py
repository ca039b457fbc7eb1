"""Automata of IDES: an `.xmd` file of version 2.1, with one finite-state automaton."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.language.des.automata import Edge, FaultError, State, System, construct
from robosc.language.des.files import Source, attribute

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.language.des.automata import Event
    from robosc.model.xmi.markup import Element

_T = TypeVar("_T")


def read(source: Source, system: System, *, requirement: bool) -> None:
    """Add the automaton of a file to a system. Raises FaultError or ModelError if it is unusable."""
    model = source.root("model")
    kind = model.attributes.get(("", "type"), "FSA")
    if kind != "FSA":
        raise construct(source.place(model, "type"), f"an IDES model of the type `{kind}`", "convert it to an `FSA`")
    data = [child for child in model.children if child.name == "data"]
    if not data:
        raise FaultError(source.place(model), "syntax", "the model has no element `data`")
    automaton = system.automaton(source.path.stem, source.whole, requirement=requirement)
    states: dict[str, State] = {}
    events: dict[str, Event] = {}
    for element in (child for part in data for child in part.children):
        with system.reporting():
            match element.name:
                case "state":
                    number = _new(element, "unique-state", states, source)
                    states[number] = automaton.states[number] = _state(element, source)
                case "event":
                    event = _event(element, source, system, requirement=requirement)
                    events[_new(element, "automata-declaration", events, source)] = event
                    automaton.alphabet[event] = None
    for element in (child for part in data for child in part.children if child.name == "transition"):
        with system.reporting():
            if ("", "event") not in element.attributes:
                raise construct(source.place(element), "transitions without an event", "give it an event")
            start, end = (_named(element, role, states, source) for role in ("source", "target"))
            automaton.edges.append(Edge(start, _named(element, "event", events, source), end, source.place(element)))


def _new(element: Element, rule: str, known: Mapping[str, object], source: Source) -> str:
    """Return the id of a state or an event. Raises FaultError if another one has it."""
    number = attribute(element, "id", source)
    if number in known:
        message = f"there are two {element.name}s with the id `{number}`"
        raise FaultError(source.place(element, "id"), rule, message, "give one of them another id")
    return number


def _state(element: Element, source: Source) -> State:
    properties = _properties(element)
    name = _name(element) or attribute(element, "id", source)
    return State(name, source.place(element), initial="initial" in properties, marked="marked" in properties)


def _event(element: Element, source: Source, system: System, *, requirement: bool) -> Event:
    name = _name(element)
    if not name:
        raise FaultError(source.place(element), "syntax", "the event has no name")
    properties = _properties(element)
    if "observable" not in properties and not requirement:
        system.hidden(name, source.place(element))
    controllable = "controllable" in properties
    return system.event(name, source.place(element), controllable=controllable, final=not requirement)


def _properties(element: Element) -> set[str]:
    """Return the properties of a state or an event."""
    return {inner.name for child in element.children if child.name == "properties" for inner in child.children}


def _name(element: Element) -> str:
    return next((child.text.strip() for child in element.children if child.name == "name"), "")


def _named(element: Element, role: str, known: Mapping[str, _T], source: Source) -> _T:
    number = attribute(element, role, source)
    if number not in known:
        kind = "event" if role == "event" else "state"
        message = f"there is no {kind} with the id `{number}`"
        raise FaultError(source.place(element, role), "unresolved-reference", message)
    return known[number]
