"""Random CIF specifications, and their synthesis by the definition, state by state.

The definition uses the drawn structures, not the text. A specification draws its automata first, each by itself. Then
it draws their textual form: in groups, as instances of definitions, and in one file or several. A definition may have a
second instance (a twin) with other events and names.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from random import Random
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

State = dict[str, Any]


@dataclass(frozen=True)
class Term:
    """An expression: its text, and its value in a state."""

    text: str
    value: Callable[[State], Any]


@dataclass
class Edge:
    events: list[str]
    guard: Term
    updates: list[tuple[str, Term]]
    target: str
    #: `!` and `?` by channel, and the sent values.
    uses: dict[str, str] = field(default_factory=dict)
    sent: dict[str, Term] = field(default_factory=dict)


@dataclass
class Invariant:
    """A condition on states, or on events: a condition that they need, or one that disables them."""

    kind: str
    name: str
    condition: Term
    events: list[str] = field(default_factory=list)
    needs: bool = True

    def within(self, place: Term) -> Invariant:
        """Return the equivalent invariant on all states for one in a location; `place` is true in that location."""
        inner = self.condition
        if self.needs:
            condition = Term("", lambda s: not place.value(s) or inner.value(s))
        else:
            condition = Term("", lambda s: place.value(s) and inner.value(s))
        return Invariant(self.kind, self.name, condition, self.events, self.needs)


@dataclass
class Location:
    name: str
    initial: Term | None = None
    marked: Term | None = None
    edges: list[Edge] = field(default_factory=list)
    invariants: list[Invariant] = field(default_factory=list)
    urgent: bool = False


@dataclass
class Automaton:
    """An automaton.

    `variables` maps each name to the type, its values, the text of the initial values, and the initial values.
    `algebraic` maps each name to the type and the value in each location. `declared` is the alphabet, if the text has
    one.
    """

    name: str
    kind: str
    locations: list[Location] = field(default_factory=list)
    variables: dict[str, tuple[str, list[Any], str, list[Any]]] = field(default_factory=dict)
    algebraic: dict[str, tuple[str, dict[str, Term]]] = field(default_factory=dict)
    watched: list[str] = field(default_factory=list)
    declared: list[str] | None = None
    initial: list[Term] = field(default_factory=list)
    marked: list[Term] = field(default_factory=list)
    invariants: list[Invariant] = field(default_factory=list)
    #: The automaton with the same definition (this one is its twin), and this one's name for each event of that one.
    twin_of: Automaton | None = None
    renamed: dict[str, str] = field(default_factory=dict)

    @property
    def alphabet(self) -> list[str]:
        used = list(
            dict.fromkeys(
                event
                for location in self.locations
                for edge in location.edges
                for event in edge.events
                if event not in edge.uses
            )
        )
        return used if self.declared is None else self.declared


TRUE = Term("true", lambda _: True)
_CONSTANTS: dict[Any, list[str]] = {2: ["two", "two", 'known["b"]', "both[n]", "size(halves)"]}
_NARROW: list[tuple[str, Callable[[int, int], int]]] = [
    ("({} + {})", lambda a, b: a + b),
    ("(({} + {}) mod 3)", lambda a, b: (a + b) % 3),
    ("(({} + {}) div 2)", lambda a, b: (a + b) // 2),
]
_WIDE: list[tuple[str, Callable[[int, int], int]]] = [
    ("({} - {})", lambda a, b: a - b),
    ("({} * {})", lambda a, b: a * b),
    ("min({}, {})", min),
    ("max({}, {})", max),
    ("abs({} - {})", lambda a, b: abs(a - b)),
    ("(abs({} - {}) mod 3)", lambda a, b: abs(a - b) % 3),
    ("(abs({} - {}) div 2)", lambda a, b: abs(a - b) // 2),
]
#: An automaton in an expression, and the parameters of a definition: locations and variables of other automata.
_AUTOMATON = re.compile(r"(?<![\w.])[AR]\d\b")
_OUTSIDE = re.compile(r"(?<![\w.])[AR]\d\.[lv]\d\b")
#: The maximum number of states of a specification, reachable or not: the definition visits each.
_MOST_STATES = 4_000
#: Constructs that synthesis does not support: a statement, and the construct's name in the finding.
FOREIGN = (
    ("automaton S0: location: initial; marked; edge {event}; end", "automata of no kind"),
    ("event plainly; plant S0: location: initial; marked; edge plainly; end", "neither controllable nor"),
    ("plant S0: location: initial; marked; edge tau; end", "edges without an event"),
    ("plant S0: location: initial; marked; edge {event}, tau when true; end", "edges without an event"),
    ("plant S0: location: initial; marked; edge when false; end", "edges without an event"),
    ("plant S0: disc int n; location: initial; marked; edge {event}; end", "an int without range"),
    ("plant S0: disc list bool n; location: initial; marked; edge {event}; end", "the type `list`"),
    ("plant S0: cont n der 1.0; location: initial; marked; edge {event}; end", "continuous variables"),
    ("invariant true;", "invariants of no kind"),
    ("func bool f(): return true; end requirement invariant f();", "functions"),
)


class Specification:
    """A random specification; a `narrow` one uses only constructs of CIF's own synthesis.

    `foreign` is the construct that a finding must name, if the specification has one that synthesis does not support.
    """

    def __init__(self, seed: int, *, narrow: bool = False) -> None:
        self.random = Random(seed)  # noqa: S311 - models, no secrets
        some = self.random
        self.narrow = narrow
        # Later additions draw from their own source, so that the specification of a seed stays the same otherwise.
        self.later = Random(seed + 1_000_000)  # noqa: S311 - models, no secrets
        #: Whether the requirement automata are supervisors in the text, which CIF's synthesis rejects.
        self.supervised = not narrow and seed % 4 == 0
        self.negative = not narrow and some.random() < 0.25
        self.events = {f"{'c' if number % 3 else 'u'}{number}": number % 3 > 0 for number in range(some.randint(2, 5))}
        self.grouped = {event for event in self.events if some.random() < 0.3}
        self.inputs: dict[str, tuple[str, list[Any]]] = {}
        self.domains: dict[str, list[Any]] = {}
        self.algebraic: dict[str, Term] = {}
        self.numbers: dict[str, Term] = {}
        self.invariants: list[Invariant] = []
        self.initial: list[Term] = []
        self.marked: list[Term] = []
        self._states = 1
        if some.random() < 0.25:
            self._input()
        self.automata = [Automaton(f"A{number}", "plant") for number in range(some.randint(1, 3))]
        self.automata += [Automaton(f"R{number}", "requirement") for number in range(some.randint(0, 1))]
        for automaton in self.automata:
            self._declare(automaton)
        self._declare_twin()
        self.outer = {f"a{number}": self.condition(2) for number in range(some.randint(0, 2))}
        self.algebraic.update({name: _named(name, "", term.value) for name, term in self.outer.items()})
        for automaton in self.automata:
            self._compute(automaton)
        for automaton in self.automata:
            # The twin comes last.
            (self._fill if automaton.twin_of is None else self._copy)(automaton)
        self._add_outside()
        self.random, drawn = self.later, self.random
        self.channels: dict[str, str] = {}
        some = self.later
        for number in range(some.choice([1, 2]) if some.random() < 0.5 else 0):
            self._channel(number)
        for location in (location for automaton in self.automata for location in automaton.locations):
            location.urgent = some.random() < 0.05
        self.random = drawn
        self._shape()

    def _add_outside(self) -> None:
        """Draw the elements outside the automata."""
        some = self.random
        for _ in range(some.choice([0, 0, 1, 2])):
            self.invariants += self._excluding()
        for _ in range(some.choice([0, 0, 1])):
            self.invariants.append(self._restricting())
        if some.random() < 0.1:
            self.initial.append(self.condition(2))
        if some.random() < 0.1:
            self.marked.append(self.condition(2))

    def _channel(self, number: int) -> None:
        """Draw a channel, the automata that send, receive and synchronize, and an invariant of the channel."""
        some = self.random
        twins = {other.name for twin in self.automata if twin.twin_of for other in (twin, twin.twin_of)}
        free = [automaton for automaton in self.automata if automaton.name not in twins]
        plants = [automaton for automaton in free if automaton.kind == "plant"]
        if len(plants) < 2:
            return
        controllable = some.random() < 0.6
        name = f"{'k' if controllable else 'w'}{number}"
        kinds = {"void": [None], "bool": [False, True], "int": [0, 1, 2, 3], "E": ["e0", "e1", "e2"]}
        kind = self.channels[name] = some.choice(list(kinds))
        self.events[name] = controllable
        some.shuffle(plants)
        most = some.randint(1, len(plants) - 1)
        parties = {"!": plants[:most][:2], "?": plants[most:][:2]}
        for use, members in parties.items():
            choice = self.condition(0)
            for place, automaton in enumerate(members):
                # Only one pair can use a controllable channel in a state.
                mine = [TRUE, TRUE] if len(members) == 1 or not controllable else [choice, _not(choice)]
                for location in some.sample(automaton.locations, some.randint(1, len(automaton.locations))):
                    for _ in range(1 if controllable else some.choice([1, 1, 2])):
                        guard = _both(mine[place], self.condition(1) if some.random() < 0.3 else TRUE)
                        edge = Edge([name], guard, [], some.choice(automaton.locations).name, {name: use})
                        if use == "!" and kind != "void":
                            edge.sent[name] = self.term(kinds[kind], 1)
                        received = kinds[kind] if use == "?" and kind != "void" else [None]
                        edge.updates = list(self._updates(automaton, received))
                        location.edges.append(edge)
        others = [automaton for automaton in free if automaton not in parties["!"] + parties["?"]]
        if others and some.random() < 0.5:
            self._synchronize(some.choice(others), name)
        if some.random() < 0.3:
            self.invariants.append(Invariant("requirement", "", self.condition(1), [name], some.random() < 0.5))

    def _updates(self, automaton: Automaton, received: list[Any]) -> Iterator[tuple[str, Term]]:
        """Draw updates that may use the received value, one of these values."""
        some = self.random
        for name, (_, values, _, _) in automaton.variables.items():
            if type(values[0]) is type(received[0]) and some.random() < 0.8:
                value = Term("?", lambda s: s["?"])
                if isinstance(values[0], bool | str) or some.random() < 0.5:
                    yield f"{automaton.name}.{name}", value
                else:
                    other = self.term(values, 0)
                    yield f"{automaton.name}.{name}", Term(f"(? + {other.text})", _sum(other))
            elif some.random() < 0.3:
                yield f"{automaton.name}.{name}", self.term(values, 1)

    def _synchronize(self, automaton: Automaton, channel: str) -> None:
        """Draw edges of an automaton that neither sends nor receives."""
        some = self.random
        for location in automaton.locations:
            if some.random() < 0.7:
                edge = self._edge([channel], automaton)
                location.edges.append(edge)
        if automaton.declared is not None and channel not in automaton.declared:
            automaton.declared = [*automaton.declared, channel]
        elif automaton.watched and channel in automaton.alphabet and some.random() < 0.5:
            automaton.watched = [*automaton.watched, channel]

    def _shape(self) -> None:
        """Draw the textual form of the specification."""
        some = self.random
        self.inside = {automaton.name for automaton in self.automata if some.random() < 0.25}
        self.defined = {
            automaton.name for automaton in self.automata if automaton.twin_of is None and some.random() < 0.25
        }
        self.defined |= {automaton.twin_of.name for automaton in self.automata if automaton.twin_of is not None}
        self.group_defined = some.random() < 0.2
        self.several_files = some.random() < 0.25
        self.annotated = some.random() < 0.3
        statement, self.foreign = some.choice(FOREIGN) if not self.narrow and some.random() < 0.05 else ("", "")
        self.extra = [statement.format(event=self.event(next(iter(self.events))))] if statement else []

    def event(self, name: str) -> str:
        return f"g.{name}" if name in self.grouped else name

    # Drawing

    def _grow(self, name: str, values: list[Any]) -> bool:
        """Give a variable or an automaton its values, unless there would be too many states."""
        if self._states * len(values) > _MOST_STATES:
            return False
        self._states *= len(values)
        self.domains[name] = values
        return True

    def _input(self) -> None:
        kinds = [("bool", [False, True]), ("int[0..2]", [0, 1, 2]), ("E", ["e0", "e1", "e2"])]
        kind, values = self.random.choice(kinds)
        self.inputs["in0"] = kind, values
        self._grow("in0", values)

    def _declare(self, automaton: Automaton) -> None:
        some = self.random
        automaton.locations = [Location(f"l{number}") for number in range(some.randint(1, 3))]
        if not self._grow(automaton.name, [location.name for location in automaton.locations]):
            del automaton.locations[1:]
            self._grow(automaton.name, ["l0"])
        kinds: list[tuple[str, list[Any]]] = [
            ("bool", [False, True]),
            ("int[0..3]", [0, 1, 2, 3]),
            ("int[1..two]", [1, 2]),
            ("T", [0, 1, 2]),
            ("E", ["e0", "e1", "e2"]),
        ]
        if self.negative:
            kinds.append(("int[-2..1]", [-2, -1, 0, 1]))
        for number in range(some.randint(0, 2)):
            kind, values = some.choice(kinds)
            several = some.sample(values, some.randint(1, 2))
            initial = f"= {_text(several[0])}" if len(several) == 1 else f"in {{{', '.join(map(_text, several))}}}"
            if some.random() < 0.1:
                initial, several = "in any", values
            elif some.random() < 0.1:
                initial, several = "", [0 if 0 in values else values[0]]
            if self._grow(f"{automaton.name}.v{number}", values):
                automaton.variables[f"v{number}"] = kind, values, initial, several

    def _declare_twin(self) -> None:
        """Declare a second instance of an automaton's definition."""
        some = self.random
        if some.random() > 0.2:
            return
        first = some.choice(self.automata)
        size = len(first.locations)
        for _, values, _, _ in first.variables.values():
            size *= len(values)
        if self._states * size > _MOST_STATES:
            return
        twin = Automaton(f"{first.name[0]}9", first.kind, [Location(location.name) for location in first.locations])
        twin.variables, twin.twin_of = first.variables, first
        for control in (False, True):
            own = [event for event, controllable in self.events.items() if controllable == control]
            twin.renamed.update(zip(own, some.sample(own, len(own)), strict=True))
        self.automata.append(twin)
        for name in [name for name in self.domains if name.split(".")[0] == first.name]:
            self._grow(name.replace(first.name, twin.name), self.domains[name])

    def _compute(self, automaton: Automaton) -> None:
        """Draw the algebraic variables of an automaton, with one value or one in each location."""
        some = self.random
        if automaton.twin_of is not None:
            for name, (kind, values) in automaton.twin_of.algebraic.items():
                own = {place: self._twin_term(automaton, value) for place, value in values.items()}
                automaton.algebraic[name] = kind, own
        elif some.random() < 0.3:
            kind = some.choice(["bool", "int[0..3]"])
            places = [location.name for location in automaton.locations] if some.random() < 0.5 else [""]
            # Its operands exclude such variables of this automaton and of later ones.
            automaton.algebraic["y0"] = (
                kind,
                {place: self.condition(1) if kind == "bool" else self.term([0, 1, 2, 3], 0) for place in places},
            )
        for name, (kind, values) in automaton.algebraic.items():
            self._know(automaton, name, kind, values)

    def _know(self, automaton: Automaton, name: str, kind: str, values: dict[str, Term]) -> None:
        def value(state: State) -> Any:
            return (values.get("") or values[state[automaton.name]]).value(state)

        known = self.algebraic if kind == "bool" else self.numbers
        known[f"{automaton.name}.{name}"] = _named(f"{automaton.name}.{name}", automaton.name, value)

    def _twin_term(self, automaton: Automaton, term: Term) -> Term:
        """Return the counterpart of a term in the twin: the names of the first automaton become those of the twin."""
        first = automaton.twin_of
        assert first is not None
        pattern = re.compile(rf"\b{first.name}\b")
        names = {name: pattern.sub(automaton.name, name) for name in self.domains if name.split(".")[0] == first.name}
        text = pattern.sub(automaton.name, term.text)
        return Term(
            text, lambda s: term.value({**s, **{name: s[other] for name, other in names.items()}, "": (first.name, s)})
        )

    def _copy(self, automaton: Automaton) -> None:
        """Fill the twin like the first instance."""
        first = automaton.twin_of
        assert first is not None

        def events(names: list[str]) -> list[str]:
            return [automaton.renamed[name] for name in names]

        def term(of: Term | None) -> Any:
            return of if of is None or of is TRUE else self._twin_term(automaton, of)

        def invariants(of: list[Invariant]) -> list[Invariant]:
            return [Invariant(i.kind, i.name, term(i.condition), events(i.events), i.needs) for i in of]

        automaton.locations = [
            Location(
                place.name,
                term(place.initial),
                term(place.marked),
                [
                    Edge(
                        events(edge.events),
                        term(edge.guard),
                        [(name.replace(first.name, automaton.name), term(value)) for name, value in edge.updates],
                        edge.target,
                    )
                    for edge in place.edges
                ],
                invariants(place.invariants),
            )
            for place in first.locations
        ]
        automaton.watched = events(first.watched)
        automaton.declared = None if first.declared is None else events(first.declared)
        automaton.initial, automaton.marked = [term(i) for i in first.initial], [term(i) for i in first.marked]
        automaton.invariants = invariants(first.invariants)

    def _fill(self, automaton: Automaton) -> None:
        some = self.random
        first = some.choice(automaton.locations)
        for location in automaton.locations:
            if location is first or some.random() < 0.15:
                location.initial = self.condition(1) if some.random() < 0.15 else TRUE
            if location is first or some.random() < 0.6:
                location.marked = self.condition(1) if some.random() < 0.15 else TRUE
            free = [event for event, controllable in self.events.items() if controllable]
            for _ in range(some.randint(0, 3)):
                events = some.sample(list(self.events), some.randint(1, 2))
                # A controllable event has one edge in a location: two could be possible at once, which CIF rejects.
                events = [event for event in events if not self.events[event] or event in free]
                free = [event for event in free if event not in events]
                if events:
                    location.edges.append(self._edge(events, automaton))
        self._add_rest(automaton)

    def _add_rest(self, automaton: Automaton) -> None:
        """Draw the alphabet, the monitored events, and the initial, marked and invariant predicates."""
        some = self.random
        if some.random() < 0.15:
            more = [event for event in self.events if event not in automaton.alphabet and some.random() < 0.2]
            automaton.declared = automaton.alphabet + more
        if some.random() < 0.2:
            automaton.watched = (
                some.sample(automaton.alphabet, min(len(automaton.alphabet), 1))
                if some.random() < 0.7
                else automaton.alphabet
            )
        if some.random() < 0.1:
            automaton.initial.append(self.condition(1))
        if some.random() < 0.1:
            automaton.marked.append(self.condition(1))
        for place in [automaton, *automaton.locations]:
            if some.random() < 0.07:
                place.invariants += self._excluding()
            if some.random() < 0.05:
                place.invariants.append(self._restricting())

    def _edge(self, events: list[str], automaton: Automaton) -> Edge:
        some = self.random
        guard = self.condition(2) if some.random() < 0.5 else TRUE
        updates = []
        for name, (_, values, _, _) in automaton.variables.items():
            if some.random() < 0.5:
                updates.append((f"{automaton.name}.{name}", self.term(values, 1)))
        return Edge(events, guard, updates, some.choice(automaton.locations).name)

    def _excluding(self) -> list[Invariant]:
        """Draw an invariant of one or several events. It may have a name if it has one event."""
        some = self.random
        kind, condition = some.choice(["requirement", "requirement", "plant"]), self.condition(2)
        events = some.sample(list(self.events), some.choice([1, 1, 1, 2]))
        name = self._fresh() if some.random() < 0.3 and len(events) == 1 else ""
        return [Invariant(kind, name, condition, events, some.random() < 0.5)]

    def _restricting(self) -> Invariant:
        kind, condition = self.random.choice(["requirement", "requirement", "plant"]), self.condition(2)
        return Invariant(kind, self._fresh() if self.random.random() < 0.5 else "", condition)

    def _fresh(self) -> str:
        self._named = getattr(self, "_named", 0) + 1
        return f"i{self._named}"

    def condition(self, depth: int) -> Term:
        """Draw a boolean term of a random shape."""
        some = self.random
        if depth and some.random() < 0.5:
            left, right = self.condition(depth - 1), self.condition(depth - 1)
            word, compute = some.choice(
                [
                    ("and", lambda a, b: a and b),
                    ("or", lambda a, b: a or b),
                    ("=>", lambda a, b: not a or b),
                    ("<=>", lambda a, b: a == b),
                    ("!=", lambda a, b: a != b),
                ]
            )
            return Term(f"({left.text} {word} {right.text})", lambda s: compute(left.value(s), right.value(s)))
        if some.random() < 0.2:
            inner = self.condition(0)
            return Term(f"(not {inner.text})", lambda s: not inner.value(s))
        if self.algebraic and some.random() < 0.3:
            return some.choice(list(self.algebraic.values()))
        if some.random() < 0.03:
            return Term("yes", lambda _: True)
        name = some.choice(list(self.domains))
        values = self.domains[name]
        if name in {automaton.name for automaton in self.automata}:
            location = some.choice(values)
            return Term(f"{name}.{location}", lambda s: s[name] == location)
        if isinstance(values[0], bool):
            return Term(self._called(name), lambda s: s[name])
        if isinstance(values[0], str):
            literal = some.choice(values)
            return Term(f"({self._called(name)} = {literal})", lambda s: s[name] == literal)
        left, right = self.term(values, 1), self.term(values, 0)
        word, compute = some.choice(
            [("<", lambda a, b: a < b), (">=", lambda a, b: a >= b), ("=", lambda a, b: a == b)]
        )
        return Term(f"({left.text} {word} {right.text})", lambda s: compute(left.value(s), right.value(s)))

    def _called(self, name: str) -> str:
        return f"g.{name}" if name in self.inputs else name

    def term(self, values: list[Any], depth: int) -> Term:
        """Draw a term with the type of these values; a number may be outside them."""
        some = self.random
        if isinstance(values[0], bool):
            return self.condition(1)
        same = [name for name, other in self.domains.items() if type(other[0]) is type(values[0])]
        if isinstance(values[0], str):
            same = [name for name in same if self.domains[name][0] == "e0"]
        if isinstance(values[0], int) and self.numbers and some.random() < 0.1:
            return some.choice(list(self.numbers.values()))
        if depth and some.random() < 0.5:
            return self._computed(values, depth)
        if same and some.random() < 0.6:
            name = some.choice(same)
            return Term(self._called(name), lambda s: s[name])
        chosen = some.choice(values)
        return Term(
            self.later.choice(_CONSTANTS[chosen]) if chosen in _CONSTANTS and some.random() < 0.5 else _text(chosen),
            lambda _: chosen,
        )

    def _computed(self, values: list[Any], depth: int) -> Term:
        some = self.random
        left, right, test = self.term(values, depth - 1), self.term(values, depth - 1), self.condition(0)
        if isinstance(values[0], str) or some.random() < 0.3:
            if some.random() < 0.5:
                automaton = some.choice([other for other in self.automata if other.name in self.domains])
                place = self.domains[automaton.name][0]
                text = f"switch {automaton.name}: case {place}: {left.text} else {right.text} end"
                return Term(text, lambda s: left.value(s) if s[automaton.name] == place else right.value(s))
            text = f"if {test.text}: {left.text} else {right.text} end"
            return Term(text, lambda s: left.value(s) if test.value(s) else right.value(s))
        # Synthesis divides only nonnegative numbers.
        operators = _NARROW if self.narrow else _WIDE if self.negative else _NARROW + _WIDE
        word, compute = some.choice(operators)
        return Term(word.format(left.text, right.text), lambda s: compute(left.value(s), right.value(s)))

    # The text

    @property
    def text(self) -> str:
        """Return the specification as one file."""
        return "\n".join([*self._names(), *self._components(), *self._rules(), ""])

    @property
    def files(self) -> dict[str, str]:
        """Return the specification by file; the first imports the others."""
        if not self.several_files:
            return {"random.cif": self.text}
        main = ['import "names.cif", "rules.cif";', *self._components(), ""]
        rules = ['import "names.cif";', *self._rules(), ""]
        files = {"random.cif": main, "names.cif": [*self._names(), ""], "rules.cif": rules}
        return {name: "\n".join(lines) for name, lines in files.items()}

    def _names(self) -> list[str]:
        lines = [
            "const list[2] real halves = [1.5, 0.5];",
            'const dict(string: int[0..2]) known = {"a": 1, "b": 2};',
            "const tuple(int[0..2] n; bool b) both = (2, true);",
            "const int two = 2;",
            "const bool yes = both[b] and floor(2.5) = two and round(halves[0]) = two and 2 in {1, 2};",
            "enum E = e0, e1, e2;",
            "type T = int[0..two];",
        ]
        inner = [f"  input {kind} {name};" for name, (kind, _) in self.inputs.items()]
        if self.annotated:
            lines.insert(0, '@@doc("What @doc(\\"it\\") is, a: b;")')
        for event, controllable in self.events.items():
            line = f"{'' if controllable else 'un'}controllable {self._typed(event)}{event};"
            if self.annotated and event == "u0":
                line = f'@doc("The first.") @other:one(a: 1, b: [true, false], c: (2, "x")) {line}'
            if event in self.grouped:
                inner.append(f"  {line}")
            else:
                lines.append(line)
        if inner:
            lines += ["group def G():" if self.group_defined else "group g:", *inner, "end"]
            if self.group_defined:
                lines.append("g: G();")
        return lines

    def _typed(self, event: str) -> str:
        """Return the type of a channel, followed by a space."""
        return f"{self.channels[event]} " if event in self.channels else ""

    def _components(self) -> list[str]:
        lines, grouped = [], []
        for automaton in self.automata:
            written = self._automaton(automaton, lines)
            (grouped if automaton.name in self.inside else lines).extend(written)
        return [*lines, "group h:", *grouped, "end"] if grouped else lines

    def _rules(self) -> list[str]:
        lines = [f"alg bool {name} = {term.text};" for name, term in self.outer.items()]
        lines += [_stated(invariant, self.event) for invariant in self.invariants]
        lines += [f"initial {term.text};" for term in self.initial]
        lines += [f"marked {term.text};" for term in self.marked]
        return [*map(self._absolute, lines), *self.extra]

    def _absolute(self, text: str, root: str = ".") -> str:
        """Replace names of automata by their paths. In a definition, a path from the root begins with `^`."""
        called = {name: f"h.{name}" if len(self.inside) % 2 else f"{root}h.{name}" for name in self.inside}
        return _AUTOMATON.sub(lambda match: called.get(match[0], match[0]), text)

    def _word(self, automaton: Automaton) -> str:
        """Return the keyword of an automaton."""
        return "supervisor" if self.supervised and automaton.kind == "requirement" else automaton.kind

    def _automaton(self, automaton: Automaton, definitions: list[str]) -> list[str]:
        """Return the lines of an automaton; add the lines of its definition, if it has one, to `definitions`."""
        first = automaton.twin_of or automaton
        if first.name not in self.defined:
            header = (
                f"{self._word(automaton)} automaton {automaton.name}:"
                if automaton.name == "A0"
                else f"{self._word(automaton)} {automaton.name}:"
            )
            return [header, *(self._absolute(line) for line in self._body(automaton, self.event)), "end"]
        body = self._body(first, lambda name: f"p_{name}")
        parameters = {name for line in body for name in re.findall(r"\bp_(\w+)", line)}
        declared = [
            f"{'' if self.events[name] else 'un'}controllable {self._typed(name)}p_{name}"
            for name in sorted(parameters)
        ]
        given = [self.event(automaton.renamed.get(name, name)) for name in sorted(parameters)]
        for outside in sorted({name for line in body for name in _OUTSIDE.findall(line)}):
            if outside.split(".")[0] != first.name:
                parameter = outside.replace(".", "_")
                kind = self._type(outside)
                declared.append(f"location {parameter}" if kind is None else f"alg {kind} {parameter}")
                given.append(self._absolute(outside))
                body = [re.sub(rf"\b{re.escape(outside)}\b", parameter, line) for line in body]
        if automaton is first:
            own = re.compile(rf"(?<![\w.]){first.name}\.")
            body = [re.sub(rf"\bswitch {first.name}\b", "switch self", own.sub("", line)) for line in body]
            header = f"{self._word(first)} def D{first.name}({'; '.join(declared)}):"
            definitions += [header, *(self._absolute(line, "^") for line in body), "end"]
        return [f"{automaton.name}: D{first.name}({', '.join(given)});"]

    def _type(self, name: str) -> str | None:
        """Return the type of a variable of an automaton; None for a location."""
        automaton, _, part = name.partition(".")
        variables = next(instance.variables for instance in self.automata if instance.name == automaton)
        return variables[part][0] if part in variables else None

    def _body(self, automaton: Automaton, event: Callable[[str], str]) -> list[str]:
        lines = [f"  disc {kind} {name} {initial};" for name, (kind, _, initial, _) in automaton.variables.items()]
        for name, (kind, values) in automaton.algebraic.items():
            value = f" = {values[''].text}" if "" in values else ""
            lines.append(f"  alg {kind} {name}{value};")
        if automaton.declared is not None:
            lines.append(
                f"  alphabet {', '.join(map(event, automaton.declared))};" if automaton.declared else "  alphabet;"
            )
        if automaton.watched:
            everything = automaton.watched == automaton.alphabet
            lines.append("  monitor;" if everything else f"  monitor {', '.join(map(event, automaton.watched))};")
        lines += [f"  initial {term.text};" for term in automaton.initial]
        lines += [f"  marked {term.text};" for term in automaton.marked]
        lines += [f"  {_stated(invariant, event)}" for invariant in automaton.invariants]
        for location in automaton.locations:
            inner = [*_elements(location, automaton, event)]
            lines += [f"  location {location.name}{':' if inner else ';'}", *(f"    {line}" for line in inner)]
        return lines

    # Synthesis by the definition

    @cached_property
    def states(self) -> list[State]:
        """Return all states that satisfy the plant invariants."""
        names = list(self.domains)
        every = (dict(zip(names, chosen, strict=True)) for chosen in product(*self.domains.values()))
        return [state for state in every if self._kept("plant", state)]

    @cached_property
    def everywhere(self) -> list[Invariant]:
        """Return all invariants; those of locations in their form for all states."""
        found = list(self.invariants)
        for automaton in self.automata:
            found += automaton.invariants
            for location in automaton.locations:
                found += [invariant.within(_at(automaton.name, location.name)) for invariant in location.invariants]
        return found

    def differs_in_cif(self) -> bool:
        """Return whether CIF's tool may count other states: docs/coming-from-cif.md, "Differences"."""
        if not any(invariant.kind == "plant" and not invariant.events for invariant in self.everywhere):
            return False
        wide = {name: values for name, (_, values) in self.inputs.items() if len(values) > 2}
        for state in self.states:
            if any(not self._kept("plant", {**state, name: value}) for name in wide for value in wide[name]):
                return True
            for event, after in self._tried(state):
                if not self.events[event] and any(after[name] not in values for name, values in self.domains.items()):
                    return True
        return False

    def _kept(self, kind: str, state: State) -> bool:
        return all(
            invariant.condition.value(state)
            for invariant in self.everywhere
            if invariant.kind == kind and not invariant.events
        )

    def _allowed(self, kind: str, event: str, state: State) -> bool:
        return all(
            invariant.condition.value(state) == invariant.needs
            for invariant in self.everywhere
            if invariant.kind == kind and event in invariant.events
        )

    def _starts(self, state: State) -> bool:
        for automaton in self.automata:
            here = next(location for location in automaton.locations if location.name == state[automaton.name])
            if here.initial is None or not here.initial.value(state):
                return False
            if any(
                state[f"{automaton.name}.{name}"] not in several
                for name, (_, _, _, several) in automaton.variables.items()
            ):
                return False
        return all(
            term.value(state)
            for term in [*self.initial, *(term for automaton in self.automata for term in automaton.initial)]
        )

    def _marks(self, state: State) -> bool:
        if not all(
            term.value(state)
            for term in [*self.marked, *(term for automaton in self.automata for term in automaton.marked)]
        ):
            return False
        places = (
            location
            for automaton in self.automata
            for location in automaton.locations
            if location.name == state[automaton.name]
        )
        return all(place.marked is not None and place.marked.value(state) for place in places)

    def _taken(self, event: str, state: State) -> Iterator[list[tuple[Automaton, Edge]]]:
        """Yield the combinations of edges that automata can take together, without those of monitors."""
        choices: list[list[tuple[Automaton, Edge] | None]] = []
        for automaton in self.automata:
            if event not in automaton.alphabet:
                continue
            here = next(location for location in automaton.locations if location.name == state[automaton.name])
            own: list[Any] = [
                (automaton, edge) for edge in here.edges if event in edge.events and edge.guard.value(state)
            ]
            watches = automaton.kind == "requirement" or event in automaton.watched
            choices.append(own or ([None] if watches else []))
        if event in self.channels:
            choices += [list(self._parties(event, use, state)) for use in "!?"]
        yield from ([taken for taken in chosen if taken is not None] for chosen in product(*choices))

    def _parties(self, channel: str, use: str, state: State) -> Iterator[tuple[Automaton, Edge]]:
        """Yield the edges that send, or those that receive."""
        for automaton in self.automata:
            here = next(location for location in automaton.locations if location.name == state[automaton.name])
            for edge in here.edges:
                if edge.uses.get(channel) == use and edge.guard.value(state):
                    yield automaton, edge

    def _required(self, event: str, state: State) -> bool:
        for automaton in self.automata:
            if automaton.kind == "requirement" and event in automaton.alphabet and event not in automaton.watched:
                here = next(location for location in automaton.locations if location.name == state[automaton.name])
                if not any(event in edge.events and edge.guard.value(state) for edge in here.edges):
                    return False
        return self._allowed("requirement", event, state)

    def controlled_states(self) -> int:
        """Return the number of reachable states under the supervisor."""
        steps, bad = self._steps()
        initial = {number for number, state in enumerate(self.states) if self._starts(state)}
        marked = {number for number, state in enumerate(self.states) if self._marks(state)}
        good = set(range(len(self.states))) - bad
        while True:
            within = [(before, after) for before, after, _ in steps if before in good and after in good]
            alive = _closure(marked & good, [(after, before) for before, after in within])
            kept_away = [(after, before) for before, after, controllable in steps if not controllable]
            lost = _closure(set(range(len(self.states))) - alive, kept_away)
            if good == good - lost:
                return len(_closure(initial & good, within))
            good -= lost

    def suffices(self) -> bool:
        """Return whether the system is safe and does not block under its requirements alone."""
        steps, bad = self._steps()
        reached = _closure(
            {number for number, state in enumerate(self.states) if self._starts(state)}, [step[:2] for step in steps]
        )
        alive = _closure(
            {number for number in reached if self._marks(self.states[number])},
            [(after, before) for before, after, _ in steps if before in reached],
        )
        leaving = (
            number
            for number in reached
            for event, after in self._after(self.states[number])
            if self._required(event, self.states[number])
            and any(after[name] not in values for name, values in self.domains.items())
        )
        return bool(reached) and not reached & bad and reached == alive and not any(True for _ in leaving)

    def _steps(self) -> tuple[list[tuple[int, int, bool]], set[int]]:
        """Return the steps between states, with their controllability, and the bad states."""
        key = {tuple(state.values()): number for number, state in enumerate(self.states)}
        steps: list[tuple[int, int, bool]] = []
        bad = {number for number, state in enumerate(self.states) if not self._kept("requirement", state)}
        for number, state in enumerate(self.states):
            changes = ({**state, name: value} for name, (_, values) in self.inputs.items() for value in values)
            steps += [(number, key.get(tuple(after.values()), number), False) for after in changes]
            for event, after in self._after(state):
                controllable = self.events[event]
                if any(after[name] not in values for name, values in self.domains.items()):
                    bad |= set() if controllable else {number}
                elif self._required(event, state):
                    steps.append((number, key[tuple(after.values())], controllable))
                elif not controllable:
                    bad.add(number)
        return steps, bad

    def _after(self, state: State) -> Iterator[tuple[str, State]]:
        """Yield the events that the plants permit in a state, with their successors, also outside the ranges."""
        return ((event, after) for event, after in self._tried(state) if self._kept("plant", after))

    def _tried(self, state: State) -> Iterator[tuple[str, State]]:
        """Yield the same without regard to plant invariants on states."""
        for event in self.events:
            used = event in self.channels or any(event in automaton.alphabet for automaton in self.automata)
            if used and self._allowed("plant", event, state):
                for taken in self._taken(event, state):
                    after = dict(state)
                    sent = [edge.sent[event].value(state) for _, edge in taken if event in edge.sent]
                    before = {**state, "?": sent[0]} if sent else state
                    for automaton, edge in taken:
                        after[automaton.name] = edge.target
                        after.update({name: value.value(before) for name, value in edge.updates})
                    yield event, after


def _closure(start: set[int], steps: list[tuple[int, int]]) -> set[int]:
    following: dict[int, list[int]] = {}
    for before, after in steps:
        following.setdefault(before, []).append(after)
    found, pending = set(start), list(start)
    while pending:
        fresh = set(following.get(pending.pop(), ())) - found
        found |= fresh
        pending += fresh
    return found


def _not(term: Term) -> Term:
    return Term(f"(not {term.text})", lambda s: not term.value(s))


def _both(left: Term, right: Term) -> Term:
    if TRUE in (left, right):
        return right if left is TRUE else left
    return Term(f"({left.text} and {right.text})", lambda s: left.value(s) and right.value(s))


def _sum(other: Term) -> Callable[[State], Any]:
    return lambda s: s["?"] + other.value(s)


def _at(automaton: str, location: str) -> Term:
    return Term(f"{automaton}.{location}", lambda s: s[automaton] == location)


def _named(name: str, automaton: str, value: Callable[[State], Any]) -> Term:
    """Return a named term: in a twin, its own elements have the twin's values, all others the common values."""

    def of(state: State) -> Any:
        first, whole = state.get("", (automaton, state))
        return value(state if first == automaton else whole)

    return Term(name, of)


def _elements(location: Location, automaton: Automaton, event: Callable[[str], str]) -> Iterator[str]:
    """Yield the elements of a location."""
    for word, condition in (("initial", location.initial), ("marked", location.marked)):
        if condition is not None:
            yield f"{word}{'' if condition is TRUE else f' {condition.text}'};"
    if location.urgent:
        yield "urgent;"
    for name, (_, values) in automaton.algebraic.items():
        if location.name in values:
            yield f"equation {name} = {values[location.name].text};"
    for invariant in location.invariants:
        yield _stated(invariant, event)
    for edge in location.edges:
        guard = "" if edge.guard is TRUE else f" when {edge.guard.text}"
        updates = ", ".join(f"{name} := {value.text}" for name, value in edge.updates)
        events = ", ".join(
            f"{event(name)}{edge.uses.get(name, '')}{edge.sent[name].text if name in edge.sent else ''}"
            for name in edge.events
        )
        goto = "" if edge.target == location.name else f" goto {edge.target}"
        yield f"edge {events}{guard}{f' do {updates}' if updates else ''}{goto};"


def _stated(invariant: Invariant, event: Callable[[str], str]) -> str:
    """Return the text of an invariant."""
    name = f"{invariant.name}: " if invariant.name else ""
    if not invariant.events:
        return f"{invariant.kind} invariant {name}{invariant.condition.text};"
    events = ", ".join(map(event, invariant.events))
    events = f"{{{events}}}" if len(invariant.events) > 1 else events
    text = (
        f"{events} needs {invariant.condition.text}"
        if invariant.needs
        else f"{invariant.condition.text} disables {events}"
    )
    # The word `invariant` is optional in CIF without a name and required with one.
    return f"{invariant.kind} invariant {name}{text};" if name else f"{invariant.kind} {text};"


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
