"""Generators of libFAUDES: a `.gen` file in the token format, with or without attributes in the style of XML."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.base.diagnostics import ModelError
from robosc.language.des.automata import Edge, FaultError, State, construct

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.des.automata import Event, System
    from robosc.language.des.files import Source
    from robosc.model.places import Place

_TOKEN = re.compile(
    r"""(?P<blank>\s+|%[^\n]*|<!--[\s\S]*?-->|<(?!!--)[?!][^>]*>)
    |(?P<section><(?P<end>/?)(?P<name>[A-Za-z_][\w:]*+)(?P<attributes>(?:[^<>"']|"[^"]*"|'[^']*')*?)(?P<alone>/?)>)
    |(?P<word>(?:"[^"\n]*"|'[^'\n]*')(?:\#[0-9]+)?|[^\s<>"'%]+)""",
    re.VERBOSE,
)
_ATTRIBUTE = re.compile(r"""(?<!\w)([A-Za-z_]\w*+)\s*+=\s*(?:"([^"]*)"|'([^']*)')""")
_FLAGS = re.compile(r"\+[A-Za-z_]*\+")
_STATE = re.compile(r"""(?P<name>"[^"]*"|'[^']*'|[^#]*)(?:\#(?P<number>[0-9]+))?""")
#: Sections whose contents or attributes have a meaning here.
_KNOWN = frozenset(
    [
        "Generator",
        "System",
        "cGenerator",
        "EventAttributes",
        "Alphabet",
        "Event",
        "EventSet",
        "States",
        "StateSet",
        "State",
        "Consecutive",
        "TransRel",
        "TransitionRelation",
        "Transition",
        "InitStates",
        "MarkedStates",
        "Controllable",
        "Initial",
        "Marked",
    ]
)
#: Sections without a meaning for synthesis.
_IGNORED = frozenset(["Observable", "Forcible", "Abstraction", "Highlevel", "Name"])
#: Sections that declare states.
_STATE_SECTIONS = ("States", "StateSet")
#: Maximum number of states of an automaton with ranges of numbers, and of sections inside each other.
_MOST, _DEEPEST = 100_000, 50


@dataclass(frozen=True)
class _Token:
    """A word, or the start or end of a section with its attributes."""

    text: str
    place: Place
    section: bool = False
    end: bool = False
    alone: bool = False
    attributes: dict[str, str] = field(default_factory=dict)


def read(source: Source, system: System, *, requirement: bool) -> None:
    """Add the generator of a file to a system. Raises FaultError or ModelError if it is unusable."""
    _Generator(source, system, requirement=requirement).run(list(_tokens(source)))


class _Generator:
    """The automaton of a file. States are known by name and by number, all collected before they are used."""

    def __init__(self, source: Source, system: System, *, requirement: bool) -> None:
        self._source = source
        self._system = system
        self._requirement = requirement
        self._automaton = system.automaton(source.path.stem, source.whole, requirement=requirement)
        self._event: Event | None = None
        self._has_states = False
        self._states: dict[str, State] = {}
        #: Number of states in the ranges of each section.
        self._ranged = Counter[str]()
        self._words: dict[str, list[_Token]] = {"TransRel": [], "InitStates": [], "MarkedStates": []}

    def run(self, tokens: list[_Token]) -> None:
        if not tokens or tokens[0].text not in ("Generator", "System", "cGenerator") or not tokens[0].section:
            place = tokens[0].place if tokens else self._source.whole
            raise FaultError(place, "syntax", "a generator begins with `<Generator>`", "is this a file of libFAUDES?")
        open_sections: list[_Token] = []
        foreign: set[str] = set()
        for token in tokens:
            inside = [section.text for section in open_sections]
            if token.end:
                if not inside or inside[-1] != token.text:
                    raise FaultError(token.place, "syntax", f"`</{token.text}>` ends no section that is open here")
                open_sections.pop()
                continue
            if all(name in _KNOWN for name in inside):
                with self._system.reporting():
                    if token.section and token.text not in _KNOWN | _IGNORED | foreign:
                        foreign.add(token.text)
                        hint = "convert the automaton to a `Generator` or a `System` without it"
                        raise construct(token.place, f"the section `{token.text}`", hint)
                    (self._section if token.section else self._word)(token, inside)
            if token.section and not token.alone:
                if len(open_sections) >= _DEEPEST:
                    raise FaultError(token.place, "syntax", f"more than {_DEEPEST} sections are inside each other")
                open_sections.append(token)
        if open_sections:
            raise FaultError(open_sections[-1].place, "syntax", f"`<{open_sections[-1].text}>` is not closed")
        self._finish()

    def _section(self, token: _Token, inside: list[str]) -> None:
        """Process a section with attributes, or a property of the event or the state around it."""
        match token.text:
            case "States" | "StateSet":
                self._has_states = True
            case "Event":
                self._declare(_attribute(token, "name"), token.place)
            case "State":
                name, number = token.attributes.get("name"), token.attributes.get("id")
                if name is None and number is None:
                    raise FaultError(token.place, "syntax", "the state has neither a name nor an id")
                state = State(name or number or "", token.place)
                self._automaton.states[state.name] = state
                self._states |= {key: state for key in (name, number) if key is not None}
            case "Transition":
                words = (_Token(_attribute(token, name), token.place) for name in ("x1", "event", "x2"))
                self._words["TransRel"].extend(words)
            case "Controllable" if inside[-1:] == ["Event"] and self._event is not None:
                self._event.controllable = True
            case ("Initial" | "Marked") as kind if inside[-1:] == ["State"] and self._automaton.states:
                setattr(next(reversed(self._automaton.states.values())), kind.lower(), True)

    def _word(self, token: _Token, inside: list[str]) -> None:
        section = inside[-1] if inside else ""
        match section:
            case "Alphabet" | "EventSet" if _FLAGS.fullmatch(token.text):
                self._flags(token)
            case "Alphabet" | "EventSet":
                self._declare(_plain(token.text), token.place)
            case "Controllable":
                self._known_event(token).controllable = True
            case "States" | "StateSet" if not _FLAGS.fullmatch(token.text):
                self._state(token, new=True)
            case "Consecutive":
                self._consecutive(token, inside[-2] if len(inside) > 1 else "")
            case "TransRel" | "TransitionRelation" if not _FLAGS.fullmatch(token.text):
                self._words["TransRel"].append(token)
            case "InitStates" | "MarkedStates":
                self._words[section].append(token)

    def _flags(self, token: _Token) -> None:
        """Process the attributes of the event before them."""
        if self._event is not None and "C" in token.text:
            self._event.controllable = True
        if self._event is not None and "o" in token.text and not self._requirement:
            self._system.hidden(self._event.name, token.place)

    def _declare(self, name: str, place: Place) -> None:
        # A file without the attribute leaves the choice to others.
        self._event = self._system.event(name, place, controllable=None)
        self._automaton.alphabet[self._event] = None

    def _known_event(self, token: _Token) -> Event:
        event = self._system.events.get(_plain(token.text))
        if event is None or event not in self._automaton.alphabet:
            message = f"the event `{_plain(token.text)}` is not in the alphabet"
            raise FaultError(token.place, "unresolved-reference", message, "add it there")
        return event

    def _consecutive(self, token: _Token, section: str) -> None:
        """Process a number of a section with ranges of states: the first and the last number of each."""
        pending = self._words.setdefault(f"{section} ranges", [])
        pending.append(token)
        if len(pending) < 2:
            return
        try:
            first, last = (int(word.text, 0) for word in pending)
        except ValueError:
            raise FaultError(token.place, "syntax", "a range has two numbers of states") from None
        finally:
            pending.clear()
        self._ranged[section] += max(0, last - first + 1)
        if self._ranged[section] > _MOST:
            fault = construct(token.place, f"more than {_MOST} states", "write the automaton as several ones")
            raise ModelError([fault.finding()])  # It ends the reading: each further range would be a fault.
        if section not in (*_STATE_SECTIONS, "InitStates", "MarkedStates"):
            raise FaultError(token.place, "syntax", f"`{section}` has no ranges of states")
        for number in range(first, last + 1):
            word = _Token(str(number), token.place)
            if section in _STATE_SECTIONS:
                self._state(word, new=True)
            else:
                self._words[section].append(word)

    def _state(self, token: _Token, *, new: bool = False) -> State:
        match = _STATE.fullmatch(token.text)
        name, number = (_plain(match["name"]), match["number"]) if match else (token.text, None)
        keys = [key for key in (name, number) if key] or [name]
        known = next((self._states[key] for key in keys if key in self._states), None)
        if known is None:
            if not new and self._has_states:
                raise FaultError(token.place, "unresolved-reference", f"there is no state `{keys[0]}`", "declare it")
            known = self._automaton.states[keys[0]] = State(keys[0], token.place)
            # A name without a number has the number of its position.
            keys = keys if number or name.isdecimal() else [name, str(len(self._automaton.states))]
            for key in keys:
                self._states.setdefault(key, known)
        return known

    def _finish(self) -> None:
        transitions = self._words["TransRel"]
        if len(transitions) % 3:
            raise FaultError(transitions[-1].place, "syntax", "a transition has a state, an event and a state")
        words = iter(transitions)
        for start, event, end in zip(words, words, words, strict=True):
            with self._system.reporting():
                edge = Edge(self._state(start), self._known_event(event), self._state(end), start.place)
                self._automaton.edges.append(edge)
        for section, mark in (("InitStates", "initial"), ("MarkedStates", "marked")):
            for word in self._words[section]:
                with self._system.reporting():
                    setattr(self._state(word), mark, True)


def _attribute(token: _Token, name: str) -> str:
    if name not in token.attributes:
        raise FaultError(token.place, "syntax", f"the section `{token.text}` has no attribute `{name}`")
    return token.attributes[name]


def _plain(word: str) -> str:
    """Return a name without its quotation marks."""
    return word[1:-1] if word[:1] in ("'", '"') and word[-1:] == word[:1] and len(word) > 1 else word


def _tokens(source: Source) -> Iterator[_Token]:
    """Yield the tokens of a file. Raises FaultError at a character that belongs to none."""
    content, position = source.text.content, 0
    while position < len(content):
        match = _TOKEN.match(content, position)
        if match is None:
            message = f"`{content[position]}` is not allowed here"
            if content.startswith("<!--", position):
                message = "the comment has no end `-->`"
            raise FaultError(source.text.source(position, position + 1), "syntax", message)
        position = match.end()
        place = source.text.source(match.start(), match.end())
        if match["section"]:
            attributes = {name: first or second for name, first, second in _ATTRIBUTE.findall(match["attributes"])}
            yield _Token(match["name"], place, True, bool(match["end"]), bool(match["alone"]), attributes)
        elif match["word"]:
            yield _Token(match["word"], place)
