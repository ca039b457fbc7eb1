"""Random CIF specifications, and their synthesis by the definition, state by state, from what was drawn."""

from __future__ import annotations

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


@dataclass
class Location:
    name: str
    initial: Term | None = None
    marked: Term | None = None
    edges: list[Edge] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)


@dataclass
class Automaton:
    """`variables` are, by their names, the type, its values, how the text gives initial values, and these."""

    name: str
    kind: str
    locations: list[Location] = field(default_factory=list)
    variables: dict[str, tuple[str, list[Any], str, list[Any]]] = field(default_factory=dict)
    watched: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)

    @property
    def alphabet(self) -> list[str]:
        return list(dict.fromkeys(e for one in self.locations for edge in one.edges for e in edge.events))


TRUE = Term("true", lambda _: True)


class Specification:
    """A random specification."""

    def __init__(self, seed: int) -> None:
        self.random = Random(seed)  # noqa: S311 - models, no secrets
        some = self.random
        self.events = {
            f"{'c' if number % 2 else 'u'}{number}": bool(number % 2) for number in range(some.randint(2, 5))
        }
        self.grouped = {event for event in self.events if some.random() < 0.3}
        self.inputs = {"in0": ["false", "true"]} if some.random() < 0.25 else {}
        self.domains: dict[str, list[Any]] = {name: [False, True] for name in self.inputs}
        self.automata = [Automaton(f"A{number}", "plant") for number in range(some.randint(1, 3))]
        self.automata += [Automaton(f"R{number}", "requirement") for number in range(some.randint(0, 1))]
        for one in self.automata:
            self._declare(one)
        self.algebraic = {f"a{number}": self.condition(2) for number in range(some.randint(0, 2))}
        self.excluded: list[tuple[str, str, bool, Term]] = []
        self.invariants: list[tuple[str, Term]] = []
        for one in self.automata:
            self._fill(one)
        self.outer = [f"alg bool {name} = {term.text};" for name, term in self.algebraic.items()]
        for _ in range(some.choice([0, 0, 1, 2])):
            self._exclude(self.outer)
        for _ in range(some.choice([0, 0, 1])):
            self._restrict(self.outer)

    def event(self, name: str) -> str:
        return f"g.{name}" if name in self.grouped else name

    # Drawing

    def _declare(self, one: Automaton) -> None:
        some = self.random
        one.locations = [Location(f"l{number}") for number in range(some.randint(1, 3))]
        self.domains[one.name] = [location.name for location in one.locations]
        for number in range(some.randint(0, 2)):
            kind, values = some.choice(
                [
                    ("bool", [False, True]),
                    ("int[0..3]", [0, 1, 2, 3]),
                    ("int[1..two]", [1, 2]),
                    ("E", ["e0", "e1", "e2"]),
                ]
            )
            several = some.sample(values, some.randint(1, 2))
            initial = f"= {_text(several[0])}" if len(several) == 1 else f"in {{{', '.join(map(_text, several))}}}"
            if some.random() < 0.1:
                initial, several = "in any", values
            elif some.random() < 0.1:
                initial, several = "", [values[0]]
            one.variables[f"v{number}"] = kind, values, initial, several
            self.domains[f"{one.name}.v{number}"] = values

    def _fill(self, one: Automaton) -> None:
        some = self.random
        first = some.choice(one.locations)
        for location in one.locations:
            if location is first or some.random() < 0.15:
                location.initial = self.condition(1) if some.random() < 0.15 else TRUE
            if location is first or some.random() < 0.6:
                location.marked = self.condition(1) if some.random() < 0.15 else TRUE
            free = [event for event, controllable in self.events.items() if controllable]
            for _ in range(some.randint(0, 3)):
                events = some.sample(list(self.events), some.randint(1, 2))
                # A controllable event has one edge in a location: two may be possible at once, which CIF refuses.
                events = [event for event in events if not self.events[event] or event in free]
                free = [event for event in free if event not in events]
                if events:
                    location.edges.append(self._edge(events, one))
        if some.random() < 0.2:
            one.watched = some.sample(one.alphabet, min(len(one.alphabet), 1))

    def _edge(self, events: list[str], one: Automaton) -> Edge:
        some = self.random
        guard = self.condition(2) if some.random() < 0.5 else TRUE
        updates = []
        for name, (_, values, _, _) in one.variables.items():
            if some.random() < 0.5:
                updates.append((f"{one.name}.{name}", self.term(values, 1)))
        return Edge(events, guard, updates, some.choice(one.locations).name)

    def _exclude(self, lines: list[str]) -> None:
        some = self.random
        kind, event = some.choice(["requirement", "requirement", "plant"]), some.choice(list(self.events))
        needs, condition = some.random() < 0.5, self.condition(2)
        if not any(event in one.alphabet for one in self.automata):
            return
        self.excluded.append((kind, event, needs, condition))
        text = (
            f"{self.event(event)} needs {condition.text}" if needs else f"{condition.text} disables {self.event(event)}"
        )
        lines.append(f"{kind} invariant {text};")

    def _restrict(self, lines: list[str]) -> None:
        kind, condition = self.random.choice(["requirement", "requirement", "plant"]), self.condition(2)
        self.invariants.append((kind, condition))
        lines.append(f"{kind} invariant i{len(self.invariants)}: {condition.text};")

    def condition(self, depth: int) -> Term:
        """A boolean of a random shape."""
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
        if getattr(self, "algebraic", None) and some.random() < 0.3:
            name = some.choice(list(self.algebraic))
            return Term(name, self.algebraic[name].value)
        name = some.choice(list(self.domains))
        values = self.domains[name]
        if name in {one.name for one in self.automata}:
            location = some.choice(values)
            return Term(f"{name}.{location}", lambda s: s[name] == location)
        if isinstance(values[0], bool):
            return Term(self._called(name), lambda s: s[name])
        if isinstance(values[0], str):
            literal = some.choice(values)
            return Term(f"({name} = {literal})", lambda s: s[name] == literal)
        left, right = self.term(values, 1), self.term(values, 0)
        word, compute = some.choice(
            [("<", lambda a, b: a < b), (">=", lambda a, b: a >= b), ("=", lambda a, b: a == b)]
        )
        return Term(f"({left.text} {word} {right.text})", lambda s: compute(left.value(s), right.value(s)))

    def _called(self, name: str) -> str:
        return f"g.{name}" if name in self.inputs else name

    def term(self, values: list[Any], depth: int) -> Term:
        """A value of the kind of some values; a number may lie outside of them."""
        some = self.random
        if isinstance(values[0], bool):
            return self.condition(1)
        same = [name for name, other in self.domains.items() if "." in name and type(other[0]) is type(values[0])]
        if isinstance(values[0], str):
            same = [name for name in same if self.domains[name][0] == "e0"]
        if depth and some.random() < 0.5:
            return self._computed(values, depth)
        if same and some.random() < 0.6:
            name = some.choice(same)
            return Term(name, lambda s: s[name])
        chosen = some.choice(values)
        return Term("two" if chosen == 2 and some.random() < 0.5 else _text(chosen), lambda _: chosen)

    def _computed(self, values: list[Any], depth: int) -> Term:
        some = self.random
        left, right, test = self.term(values, depth - 1), self.term(values, depth - 1), self.condition(0)
        if isinstance(values[0], str) or some.random() < 0.3:
            if some.random() < 0.5:
                one = some.choice(self.automata)
                place = one.locations[0].name
                text = f"switch {one.name}: case {place}: {left.text} else {right.text} end"
                return Term(text, lambda s: left.value(s) if s[one.name] == place else right.value(s))
            text = f"if {test.text}: {left.text} else {right.text} end"
            return Term(text, lambda s: left.value(s) if test.value(s) else right.value(s))
        word, compute = some.choice(
            [
                ("({} + {})", lambda a, b: a + b),
                ("({} - {})", lambda a, b: a - b),
                ("({} * {})", lambda a, b: a * b),
                ("min({}, {})", min),
                ("max({}, {})", max),
                ("abs({} - {})", lambda a, b: abs(a - b)),
                ("(({} + {}) mod 3)", lambda a, b: (a + b) % 3),
                ("(({} + {}) div 2)", lambda a, b: (a + b) // 2),
            ]
        )
        return Term(word.format(left.text, right.text), lambda s: compute(left.value(s), right.value(s)))

    # The text

    @property
    def text(self) -> str:
        lines = ["const int two = 2;", "enum E = e0, e1, e2;"]
        inner = [f"  input bool {name};" for name in self.inputs]
        for event, controllable in self.events.items():
            line = f"{'' if controllable else 'un'}controllable {event};"
            if event in self.grouped:
                inner.append(f"  {line}")
            else:
                lines.append(line)
        if inner:
            lines += ["group g:", *inner, "end"]
        for one in self.automata:
            lines += self._automaton(one)
        return "\n".join([*lines, *self.outer, ""])

    def _automaton(self, one: Automaton) -> list[str]:
        lines = [f"{one.kind} automaton {one.name}:" if one.name == "A0" else f"{one.kind} {one.name}:"]
        for name, (kind, _, initial, _) in one.variables.items():
            lines.append(f"  disc {kind} {name} {initial};")
        if one.watched:
            lines.append(f"  monitor {', '.join(map(self.event, one.watched))};")
        for location in one.locations:
            lines.append(f"  location {location.name}:")
            for word, condition in (("initial", location.initial), ("marked", location.marked)):
                if condition is not None:
                    lines.append(f"    {word}{'' if condition is TRUE else f' {condition.text}'};")
            for edge in location.edges:
                guard = "" if edge.guard is TRUE else f" when {edge.guard.text}"
                updates = ", ".join(f"{name} := {value.text}" for name, value in edge.updates)
                events = ", ".join(map(self.event, edge.events))
                goto = "" if edge.target == location.name else f" goto {edge.target}"
                lines.append(f"    edge {events}{guard}{f' do {updates}' if updates else ''}{goto};")
            if lines[-1].endswith(":"):
                lines[-1] = f"  location {location.name};"
        return [*lines, "end"]

    # Synthesis by the definition

    @cached_property
    def states(self) -> list[State]:
        """All states in which the plant invariants hold."""
        names = list(self.domains)
        every = (dict(zip(names, chosen, strict=True)) for chosen in product(*self.domains.values()))
        return [state for state in every if self._kept("plant", state)]

    def _kept(self, kind: str, state: State) -> bool:
        return all(condition.value(state) for own, condition in self.invariants if own == kind)

    def _allowed(self, kind: str, event: str, state: State) -> bool:
        return all(
            condition.value(state) == needs for own, on, needs, condition in self.excluded if (own, on) == (kind, event)
        )

    def _starts(self, state: State) -> bool:
        for one in self.automata:
            here = next(location for location in one.locations if location.name == state[one.name])
            if here.initial is None or not here.initial.value(state):
                return False
            if any(state[f"{one.name}.{name}"] not in several for name, (_, _, _, several) in one.variables.items()):
                return False
        return True

    def _marked(self, state: State) -> bool:
        places = (location for one in self.automata for location in one.locations if location.name == state[one.name])
        return all(place.marked is not None and place.marked.value(state) for place in places)

    def _taken(self, event: str, state: State) -> Iterator[list[tuple[Automaton, Edge]]]:
        """The edges that automata can take together, those that only watch left out."""
        choices: list[list[tuple[Automaton, Edge] | None]] = []
        for one in self.automata:
            if event not in one.alphabet:
                continue
            here = next(location for location in one.locations if location.name == state[one.name])
            own: list[Any] = [(one, edge) for edge in here.edges if event in edge.events and edge.guard.value(state)]
            watches = one.kind == "requirement" or event in one.watched
            choices.append(own or ([None] if watches else []))
        yield from ([taken for taken in chosen if taken is not None] for chosen in product(*choices))

    def _required(self, event: str, state: State) -> bool:
        for one in self.automata:
            if one.kind == "requirement" and event in one.alphabet and event not in one.watched:
                here = next(location for location in one.locations if location.name == state[one.name])
                if not any(event in edge.events and edge.guard.value(state) for edge in here.edges):
                    return False
        return self._allowed("requirement", event, state)

    def controlled_states(self) -> int:
        """How many states are reachable under the supervisor."""
        steps, bad = self._steps()
        initial = {number for number, state in enumerate(self.states) if self._starts(state)}
        marked = {number for number, state in enumerate(self.states) if self._marked(state)}
        good = set(range(len(self.states))) - bad
        while True:
            within = [(before, after) for before, after, _ in steps if before in good and after in good]
            alive = _closure(marked & good, [(after, before) for before, after in within])
            kept_away = [(after, before) for before, after, controllable in steps if not controllable]
            lost = _closure(set(range(len(self.states))) - alive, kept_away)
            if good == good - lost:
                return len(_closure(initial & good, within))
            good -= lost

    def _steps(self) -> tuple[list[tuple[int, int, bool]], set[int]]:
        """What leads from state to state, controllable or not, and the states that are bad."""
        key = {tuple(state.values()): number for number, state in enumerate(self.states)}
        steps: list[tuple[int, int, bool]] = []
        bad = {number for number, state in enumerate(self.states) if not self._kept("requirement", state)}
        for number, state in enumerate(self.states):
            changes = ({**state, name: not state[name]} for name in self.inputs)
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
        """What can happen in a state so far as the plants go, with what follows, also out of the ranges."""
        for event in self.events:
            if any(event in one.alphabet for one in self.automata) and self._allowed("plant", event, state):
                for taken in self._taken(event, state):
                    after = dict(state)
                    for one, edge in taken:
                        after[one.name] = edge.target
                        after.update({name: value.value(state) for name, value in edge.updates})
                    if self._kept("plant", after):
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


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
