"""Conditions that several guards have in common: each becomes a function, which the guards call."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.expressions import CPrinter
from robosc.m2t.c.nodes import Junction, Node, children_of, is_condition
from robosc.metamodel import sct
from robosc.semantics.operators import ATOM

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.m2t.c.context import Context

_Key = tuple[bool, frozenset[str]]
#: From how many guards on it pays to watch a single comparison of a variable for all of them.
_MANY = 4


@dataclass(frozen=True, eq=False)
class Condition:
    """A conjunction or disjunction that is part of several guards; the function's name, and the events of these."""

    name: str
    key: _Key
    node: Node
    events: list[sct.Event]

    @property
    def call(self) -> str:
        """How a guard asks for it."""
        return f"{self.name}(state)"


class Shared(CPrinter):
    """Prints guards with calls of the shared conditions. `conditions` has these so that each calls earlier ones only.

    `watched`: whether single comparisons count, too, if in many guards: the control loop then asks once for all.
    """

    def __init__(self, context: Context, *, watched: bool) -> None:
        super().__init__(context.names, context.ranges)
        self._context = context
        self._plain = context.printer
        self._watched = watched
        self._hidden: Condition | None = None
        #: By the first of their parts.
        self._beginning: dict[str, list[Condition]] = {}
        self.conditions: list[Condition] = []
        self._find()

    def body(self, condition: Condition) -> str:
        """The condition itself."""
        self._hidden = condition
        text = self.text(condition.node)
        self._hidden = None
        return text

    def parts(self, node: Node) -> list[Node | Condition]:
        """A guard as a conjunction of conditions that are shared and of others."""
        joined = self._joined(node)
        return [node] if joined is None or not joined.neutral else [part for part, _ in self._replaced(joined)]

    def shown(self, node: Node) -> tuple[str, list[tuple[frozenset[str], str]]]:
        """The outermost operator of a guard, and its operands: what each means without sharing, and its text."""
        joined = self._joined(node)
        if joined is None:
            return "&&", [(frozenset([self._plain(node)]), self.text(node))]
        return "&&" if joined.neutral else "||", [
            (part.key[1] if isinstance(part, Condition) else frozenset([self._text(joined, part)]), text)
            for part, text in self._replaced(joined)
        ]

    def terms(self, joined: Junction) -> list[str]:
        """The conditions of a conjunction or disjunction, those together that are one function."""
        return [text for _, text in self._replaced(joined)]

    def precedence(self, expression: Node) -> int:
        """How tightly the text binds: a call is an atom."""
        joined = self._joined(expression)
        if joined is not None:
            replaced = self._replaced(joined)
            if len(replaced) == 1 and isinstance(replaced[0][0], Condition):
                return ATOM
        return super().precedence(expression)

    def _replaced(self, joined: Junction) -> list[tuple[Node | Condition, str]]:
        """The parts of a conjunction or disjunction with their texts, those together that are shared."""
        parts = {self._text(joined, part): part for part in joined.parts}
        given: dict[str, tuple[Node | Condition, str]] = {}
        for condition in self._candidates(parts, joined.neutral):
            if not condition.key[1] & given.keys():
                given |= dict.fromkeys(condition.key[1], (condition, condition.call))
        for text, part in parts.items():
            if text not in given:
                given[text] = part, super().terms(Junction(joined.neutral, [part]))[0]
        return list(dict.fromkeys(given[text] for text in parts))

    def _text(self, joined: Junction, part: Node) -> str:
        """A part without sharing."""
        return self._plain.terms(Junction(joined.neutral, [part]))[0]

    def _candidates(self, parts: Mapping[str, Node], neutral: bool) -> list[Condition]:
        """The shared conditions that are among the parts, the longest first."""
        found = [
            each
            for text in parts
            for each in self._beginning.get(text, ())
            if each is not self._hidden
            and (each.key[0] == neutral or len(each.key[1]) == 1)
            and each.key[1] <= parts.keys()
        ]
        return sorted(found, key=lambda each: -len(each.key[1]))

    def _use(self, conditions: list[Condition]) -> None:
        self.conditions = conditions
        self._beginning = {}
        for each in conditions:
            self._beginning.setdefault(min(each.key[1]), []).append(each)

    def _find(self) -> None:
        """Takes what several guards have in common, but what only a longer condition would call."""
        found: dict[_Key, tuple[Node, list[sct.Event]]] = {}
        guards = {event: self._context.guard(event) for event in self._context.events}
        for event, guard in guards.items():
            for key, node in dict(self._pieces(event, guard)).items():
                found.setdefault(key, (node, []))[1].append(event)
        chosen = sorted(
            (
                (key, node, events)
                for key, (node, events) in found.items()
                if len(events) >= (_MANY if len(key[1]) == 1 else 2)
            ),
            key=lambda each: len(self._plain(each[1])),
        )
        while True:
            self._use([Condition(f"condition_{n}", *each) for n, each in enumerate(chosen, 1)])
            texts = [*map(self.text, guards.values()), *map(self.body, self.conditions)]
            calls = Counter(name for text in texts for name in set(re.findall(r"\bcondition_\d+\b", text)))
            kept = [each for each, made in zip(chosen, self.conditions, strict=True) if calls[made.name] > 1]
            if kept == chosen:
                return
            chosen = kept

    def _pieces(self, event: sct.Event, guard: Node) -> Iterator[tuple[_Key, Node]]:
        """What other guards may have in common with this one."""
        for asked in (self._context.table.required(event), self._context.table.added(event)):
            yield from self._junction(asked)
        joined = self._joined(guard)
        for part in [guard] if joined is None else joined.parts:
            if self._joined(part) is not None:
                yield from self._nested(part)
            elif self._watched and any(isinstance(each, sct.DiscreteVariable) for each in self.ranges.cells(part)):
                yield (True, frozenset([self._plain(part)])), part

    def _nested(self, node: Node) -> Iterator[tuple[_Key, Node]]:
        yield from self._junction(node)
        joined = self._joined(node)
        for part in children_of(self.ranges.reduced(node)) if joined is None else joined.parts:
            if is_condition(part):
                yield from self._nested(part)

    def _junction(self, node: Node) -> Iterator[tuple[_Key, Node]]:
        joined = self._joined(node)
        if joined is not None and len(joined.parts) > 1:
            yield (joined.neutral, frozenset(self._plain.terms(joined))), node

    def _joined(self, node: Node) -> Junction | None:
        return None if self.ranges(node).single is not None else self.ranges.joined(self.ranges.reduced(node))
