"""Pass: extracts conditions that several guards share (common subexpressions)."""

from __future__ import annotations

from collections import Counter
from itertools import islice
from typing import TYPE_CHECKING

from robosc.model import engine, sct

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.m2m.sct_to_engine.combine_guards import GuardTerms
    from robosc.m2m.sct_to_engine.terms import Term, Terms
    from robosc.model import expression as ex

#: Minimum number of guards with a comparison of a variable that an incremental loop computes once for all.
_MANY = 4
_JUNCTIONS = (engine.And, engine.Or)
#: Maximum number of passes that remove conditions with only one reference, after longer ones absorbed the others.
_ROUNDS = 5

#: References to each term: guards and shared terms, at most `_MANY` of them.
_Owners = dict["Term", dict[object, None]]


class SharedTerms:
    """Shared terms, and the composition of other terms from them."""

    def __init__(self, terms: Sequence[Term], opposites: Mapping[Term, Term]) -> None:
        self.conditions = {term: engine.Condition(name=f"condition_{number}") for number, term in enumerate(terms, 1)}
        #: Terms that are the opposite of a shared one.
        self.denied = {term: shared for term, shared in opposites.items() if shared in self.conditions}
        parts = Counter(operand for term in terms for operand in term.operands)
        #: Shared junctions by their rarest operand.
        self._with: dict[Term, list[Term]] = {}
        for term in terms:
            if term.operator in _JUNCTIONS:
                self._with.setdefault(min(term.operands, key=parts.__getitem__), []).append(term)

    def fold(self, kind: type[ex.Expression], operands: Sequence[Term], but: Term | None = None) -> dict[Term, Term]:
        """Map each operand of a junction to itself or to a shared junction of several operands, long ones first.

        Does not use the term `but`: a shared term must not be composed of itself.
        """
        operand_set = set(operands)
        contained = [
            term
            for operand in operands
            for term in self._with.get(operand, ())
            if term.operator is kind and term is not but and operand_set.issuperset(term.operands)
        ]
        stands: dict[Term, Term] = {}
        for term in sorted(contained, key=lambda term: -len(term.operands)):
            if not stands.keys() & term.operands:
                stands |= dict.fromkeys(term.operands, term)
        return {operand: stands.get(operand, operand) for operand in operands}

    def operands(self, term: Term) -> Sequence[Term]:
        """Return the operands of a term. A shared junction replaces the operands that it consists of."""
        if term.operator not in _JUNCTIONS:
            return term.operands
        return list(dict.fromkeys(self.fold(term.operator, term.operands, term).values()))

    def inside(self, roots: Iterable[Term]) -> dict[Term, None]:
        """Return the shared terms in `roots`, without those inside other shared terms."""
        inner: dict[Term, None] = {}
        seen = set()
        pending = list(roots)
        while pending:
            term = pending.pop()
            if term in self.conditions or term in self.denied:
                inner[self.denied.get(term, term)] = None
            elif term not in seen:
                seen.add(term)
                pending += self.operands(term)
        return inner

    def ask_for(self, guard: GuardTerms) -> dict[Term, list[engine.Origin]]:
        """Return the conjuncts of a guard, each with the origins that require it. A shared junction is one conjunct."""
        if guard.whole.constant is not None:
            false = [origin for origin, part in guard.parts if part is guard.whole]
            either = [origin for origin, part in guard.parts if part.constant is None]
            return {} if guard.whole.constant else {guard.whole: false or either}
        stands = self.fold(engine.And, operands_of(guard.whole))
        conjuncts: dict[Term, list[engine.Origin]] = {}
        for origin, part in guard.parts:
            for operand in operands_of(part):
                origins = conjuncts.setdefault(stands[operand], [])
                if origin not in origins:
                    origins.append(origin)
        return conjuncts


def share_conditions(
    guards: Mapping[sct.Event, GuardTerms], events: Mapping[sct.Event, engine.Event], terms: Terms, *, incremental: bool
) -> SharedTerms:
    """Return the shared terms, inner ones first.

    A junction is shared if several guards or other shared conditions refer to it or to its opposite. One reference to
    each is not enough, because calls cost more. An incremental control loop also shares a comparison of a variable that
    is a conjunct of many guards.
    """
    terms_shared, opposites = _find(guards.values(), terms, incremental=incremental)
    denied = set(opposites.values())
    for _ in range(_ROUNDS):
        shared = SharedTerms(terms_shared, opposites)
        called = Counter(term for guard in guards.values() for term in shared.inside(shared.ask_for(guard)))
        called.update(inner for term in terms_shared for inner in shared.inside(shared.operands(term)))
        worthwhile = [term for term in terms_shared if called[term] > (2 if term in denied else 1)]
        if len(worthwhile) == len(terms_shared):
            break
        terms_shared = worthwhile
    shared = SharedTerms(_inner_first(SharedTerms(terms_shared, opposites)), opposites)
    for event, guard in guards.items():
        pending = list(shared.inside(shared.ask_for(guard)))
        visited = set()
        while pending:
            term = pending.pop()
            if term not in visited:
                visited.add(term)
                shared.conditions[term].events.append(events[event])
                pending += shared.inside(shared.operands(term))
    return shared


def _inner_first(shared: SharedTerms) -> list[Term]:
    """Return the shared terms, each after those that it refers to: a junction may refer to any part of its operands."""
    ordered: dict[Term, None] = {}
    pending = [(term, False) for term in reversed(shared.conditions)]
    while pending:
        term, is_visited = pending.pop()
        if is_visited:
            ordered[term] = None
        elif term not in ordered:
            pending.append((term, True))
            pending += [(inner, False) for inner in reversed(shared.inside(shared.operands(term)))]
    return list(ordered)


def _find(guards: Iterable[GuardTerms], terms: Terms, *, incremental: bool) -> tuple[list[Term], dict[Term, Term]]:
    """Find the common subexpressions of the guards. Visits each term once, outer terms first.

    Also returns the junctions that are opposites of others. References to them count as references to their opposites.
    """
    order: dict[Term, None] = {}
    owners: _Owners = {}
    origins: _Owners = {}
    for guard in guards:
        if guard.whole.constant is None:
            roots = [*operands_of(guard.plants), guard.requirement, guard.synthesis]
            _refer(owners, roots, [guard])
            _refer(origins, roots, [guard])
            for root in roots:
                order |= dict.fromkeys(root.below())
    number = {term: position for position, term in enumerate(order)}
    opposites = {
        term: opposite
        for term in order
        if term.operator in _JUNCTIONS and number.get(opposite := terms.opposite(term), len(order)) < number[term]
    }
    shared = []
    for term in reversed(order):
        own, direct = owners.pop(term, {}), origins.pop(term, {})
        junction = term.operator in _JUNCTIONS
        if term in opposites:
            pass  # References to it are references to its opposite.
        elif len(own) > 1 if junction else incremental and len(direct) >= _MANY and _reads_variable(term):
            shared.append(term)
            own, direct = {term: None}, {}
        _refer(owners, [opposites[term]] if term in opposites else term.operands, own)
        if term.operator is engine.And:
            _refer(origins, term.operands, direct)
    return shared[::-1], opposites


def operands_of(condition: Term) -> Sequence[Term]:
    """Return the conjuncts of a condition."""
    if condition.constant is not None:
        return () if condition.constant else (condition,)
    return condition.operands if condition.operator is engine.And else (condition,)


def _refer(owners: _Owners, terms: Iterable[Term], by: Iterable[object]) -> None:
    for term in terms:
        known = owners.setdefault(term, {})
        known |= dict.fromkeys(islice(by, _MANY))


def _reads_variable(term: Term) -> bool:
    return term.constant is None and any(
        isinstance(declaration, engine.StateVariable) and declaration.variable is not None
        for declaration in term.reads()
    )
