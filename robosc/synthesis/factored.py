"""Nested expressions that separate two sets of states, for conditions that are too long for a sum of products.

The recursion is that of irredundant sums of products (Minato: Fast generation of irredundant sum-of-products forms from
binary decision diagrams, SASIMI 1992), over finite domains. It keeps the products nested by their common values. The
result takes a small part of the time of a sum of products, and is mostly shorter.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, NamedTuple

from robosc.model import expression as ex
from robosc.model.semantics.printing import disjunction
from robosc.model.semantics.walks import walk
from robosc.synthesis.bdd import split
from robosc.synthesis.decoding import is_one_of

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.decoding import Ranges
    from robosc.synthesis.encoding import Domain, Encoding

    #: States that an expression must contain, and states that it may contain.
    Interval = tuple[Diagram, Diagram]


class Factored(NamedTuple):
    """Nested expression: one of the parts must hold, each under a condition on one element.

    A part without an element holds under no condition. Without parts, the expression is true. `holds` are the states in
    which it is true, `length` is the number of conditions.
    """

    holds: Diagram
    length: int
    parts: Sequence[tuple[Domain | None, Ranges, Factored]]


class TooLongError(Exception):
    """The search for an expression exceeds its limit."""


class Factoring:
    """Nested expressions over some domains."""

    def __init__(self, encoding: Encoding, domains: Sequence[Domain], most: float = inf) -> None:
        """Limit the search to `most` different parts."""
        self._encoding = encoding
        self._most = most
        self._domain_at = {level: domain for domain in domains for level in domain.levels}
        self._known: dict[Interval, Factored | None] = {}
        self._true = Factored(encoding.diagrams.true, 0, ())

    def separating(self, inside: Diagram, outside: Diagram) -> Factored:
        """Return an expression that is true in all states of `inside` and false in all of `outside`.

        Neither set is empty. Raises TooLongError if the search exceeds its limit.
        """
        factored = walk(self._step, (inside, ~outside), self._known)
        assert factored is not None
        return factored

    def _step(self, interval: Interval) -> Generator[Interval, Factored | None, Factored | None]:
        """Return an expression for an interval, or None if no state must be in it."""
        if len(self._known) > self._most:
            raise TooLongError
        must, may = interval
        if not must.satisfiable():
            return None
        if may.valid():
            return self._true
        tops = (must.node_level(), may.node_level())
        domain = self._domain_at[min(level for level in tops if level is not None)]
        cases = _cases(interval, domain)
        if len(cases) == 1:
            return (yield next(iter(cases)))
        always = self._encoding.diagrams.all_of(free for _, free in cases)
        rest = holds = self._encoding.diagrams.false
        #: Codes and expression for each set of states: several cases may get the same one.
        alike: dict[Diagram, tuple[Ranges, Factored]] = {}
        for (needed, free), ranges in cases.items():
            part = yield needed & ~always, free
            rest |= needed if part is None else needed & ~part.holds
            if part is not None:
                codes, _ = alike.get(part.holds, ([], part))
                alike[part.holds] = _union(codes, ranges), part
        parts: list[tuple[Domain | None, Ranges, Factored]] = []
        for codes, part in alike.values():
            values = (self._encoding.between(domain.element, first, last) for first, last in codes)
            holds |= part.holds & self._encoding.diagrams.any_of(values)
            parts.append((domain, codes, part))
        common = yield rest, always
        if common is not None:
            holds |= common.holds
            parts.append((None, [], common))
        return Factored(holds, sum(part.length + (own is not None) for own, _, part in parts), parts)


def expression_of(factored: Factored) -> ex.Expression:
    """Return a nested expression as a tree."""

    def step(whole: Factored) -> Generator[Factored, ex.Expression, ex.Expression]:
        parts = []
        for domain, codes, part in whole.parts:
            if domain is None:
                parts.append((yield part))
                continue
            condition = is_one_of(domain, codes)
            parts.append(ex.Conjunction(left=condition, right=(yield part)) if part.parts else condition)
        result = disjunction(parts)
        assert result is not None
        return result

    return walk(step, factored)


def _cases(interval: Interval, domain: Domain) -> dict[Interval, Ranges]:
    """Return the interval below each value of a domain, with the codes of these values."""
    cases: dict[Interval, Ranges] = {}

    def collect(must: Diagram, may: Diagram, levels: Sequence[int], first: int) -> None:
        if first >= domain.size:
            return
        if not levels or (not _begins_at(must, levels) and not _begins_at(may, levels)):
            last = min(first + (1 << len(levels)), domain.size) - 1
            cases[must, may] = _union(cases.get((must, may), []), [(first, last)])
            return
        (must_high, must_low), (may_high, may_low) = split(must, levels[0]), split(may, levels[0])
        collect(must_low, may_low, levels[1:], first)
        collect(must_high, may_high, levels[1:], first + (1 << len(levels) - 1))

    collect(*interval, domain.levels, 0)
    return cases


def _begins_at(diagram: Diagram, levels: Sequence[int]) -> bool:
    level = diagram.node_level()
    return level is not None and level <= levels[-1]


def _union(first: Ranges, second: Ranges) -> Ranges:
    """Return the codes of two lists of ranges that do not overlap."""
    union: Ranges = []
    for start, end in sorted([*first, *second]):
        adjoins = union and union[-1][1] == start - 1
        union.append((union.pop()[0] if adjoins else start, end))
    return union
