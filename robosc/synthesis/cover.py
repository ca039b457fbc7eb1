"""Short expressions that separate two sets of states.

A cover is a sum of products over finite domains. Each product restricts some elements to sets of values. Products grow
from single states until they meet the other set, as in espresso (Rudell, Sangiovanni-Vincentelli: Multiple-valued
minimization for PLA optimization, TCAD 1987), but over decision diagrams. Expressions that would be too long to read
are nested instead (`factored`).
"""

from __future__ import annotations

from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, TypeAlias

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.synthesis.decoding import Ranges, codes, complement, cost, is_one_of
from robosc.synthesis.encoding import pick
from robosc.synthesis.factored import Factoring, TooLongError, expression_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Domain, Element, Encoding

#: Allowed codes of each element that a product restricts.
Product: TypeAlias = "dict[Domain, Ranges]"
#: An element with one value, and the states in which it has that value.
_Literal: TypeAlias = "tuple[Domain, Diagram]"
#: Maximum number of conditions of an expression that is worth the time of a cover.
_READABLE = 64
#: Maximum number of conditions of an expression. It takes about a gigabyte.
_WRITABLE = 500_000
#: Maximum number of parts of the search for an expression, for each condition that it may have.
_SEARCHED = 100


def separating_expression(
    encoding: Encoding, inside: Diagram, outside: Diagram, domains: Sequence[Domain], longest: int | None = None
) -> ex.Expression | None:
    """Return an expression that is true in all states of `inside` and false in all of `outside`.

    Neither set is empty, and both depend on `domains` only. If the expression has more conditions on an element than
    `longest`, the result is None. A short expression is a cover of `inside` or a negated cover of `outside`, whichever
    is shorter. A long one is nested, since a cover would take much longer. Raises MemoryError if it is too long to be
    written at all.
    """
    if _are_interleaved(domains):
        return _covering(encoding, inside, outside, domains, longest)
    factoring = Factoring(encoding, domains, inf if longest is None else _SEARCHED * longest)
    try:
        factored, excluded = factoring.separating(inside, outside), factoring.separating(outside, inside)
    except TooLongError:
        return None
    shorter = min(factored, excluded, key=lambda candidate: candidate.length)
    if longest is not None and shorter.length > longest:
        return None
    if shorter.length > _WRITABLE:
        raise MemoryError(f"a guard with {shorter.length:,} conditions is too long to be written")
    if shorter.length > _READABLE:
        expression = expression_of(shorter)
        return expression if shorter is factored else ex.Negation(operand=expression)
    return _covering(encoding, inside, outside, domains)


def _are_interleaved(domains: Sequence[Domain]) -> bool:
    """Return whether the bits of some domains alternate, as those of wide integers do. They cannot be factored."""
    ranges = sorted((domain.levels[0], domain.levels[-1]) for domain in domains if domain.levels)
    return any(last > first for (_, last), (first, _) in pairwise(ranges))


def _covering(
    encoding: Encoding, inside: Diagram, outside: Diagram, domains: Sequence[Domain], most: int | None = None
) -> ex.Expression | None:
    """Return the shorter of a cover of `inside` and a negated cover of `outside`.

    Returns None if both have more than `most` products.
    """
    covers = _shorter_covers(
        _Cover(encoding, inside, outside, domains), _Cover(encoding, outside, inside, domains), most
    )
    if covers is None:
        return None
    positive, negative = covers
    if positive is not None and (negative is None or _length(positive) <= _length(negative)):
        result = disjunction(_product(product) for product in positive)
    else:
        result = conjunction(_denied(product) for product in negative or ())
    assert result is not None
    return result


class _Cover:
    """Products that cover `required` and exclude `spared`, computed one by one."""

    def __init__(self, encoding: Encoding, required: Diagram, spared: Diagram, domains: Sequence[Domain]) -> None:
        self._encoding = encoding
        self._required = required
        self._spared = spared
        self._cube = encoding.diagrams.cube(level for domain in domains for level in domain.levels)
        self._domains = sorted(domains, key=_telling)
        #: For each domain, the variables of the other domains.
        self._others: dict[Domain, Diagram] = {}

    def products(self) -> Iterator[Product]:
        """Yield products that cover the wanted states; each covers a state that those before it do not."""
        left = self._required
        while left.satisfiable():
            product = self._widened(self._grown(pick(left, self._domains)))
            yield product
            left &= ~self._states(product)

    def tidied(self, products: list[Product]) -> list[Product]:
        """Return the products without the redundant ones, each restricted to its most readable form."""
        behind = [self._encoding.diagrams.false]
        for product in reversed(products):
            behind.append(behind[-1] | self._states(product))
        tidy, covered = [], self._encoding.diagrams.false
        for product, others in zip(products, reversed(behind[:-1]), strict=True):
            left = self._required & ~covered & ~others
            if left.satisfiable():
                tidy.append(self._narrowed(product, left))
                covered |= self._states(tidy[-1])
        return tidy

    def _narrowed(self, product: Product, states: Diagram) -> Product:
        """Return the product with the most readable values: at least those of `states`, at most its own."""
        return {
            domain: _readable(domain, self._values_in(states, domain), free)
            for domain, free in sorted(product.items(), key=lambda item: item[0].rank)
        }

    def _grown(self, state: Mapping[Element, int]) -> Product:
        """Return the product of the state without the elements that are not needed to exclude `spared`."""
        elements = ((domain, domain.element) for domain in self._domains)
        literals = [(domain, self._encoding.has_code(element, state[element])) for domain, element in elements]
        needed = self._needed(literals, self._spared)
        return {domain: [(state[domain.element],) * 2] for domain, _ in needed}

    def _needed(self, literals: Sequence[_Literal], spared: Diagram) -> list[_Literal]:
        """Return a minimal part of `literals` that excludes all states of `spared`.

        The search drops literals from the first to the last, by halves: it drops most of them many at once (Junker:
        QuickXplain, AAAI 2004).
        """
        if not spared.satisfiable():
            return []
        if len(literals) == 1:
            return [*literals]
        middle = len(literals) // 2
        first, last = literals[:middle], literals[middle:]
        needed = self._needed(first, spared & self._all(last))
        return needed + self._needed(last, spared & self._all(needed))

    def _all(self, literals: Sequence[_Literal]) -> Diagram:
        """Return the conjunction of the literals, from the bottom, so that each step builds only one level."""
        ascending = sorted(literals, key=lambda literal: literal[0].levels, reverse=True)
        return self._encoding.diagrams.all_of(holds for _, holds in ascending)

    def _widened(self, product: Product) -> Product:
        """Return the product with every value that the other elements allow."""
        all_after = [self._encoding.diagrams.true]
        for domain in reversed(product):
            all_after.append(all_after[-1] & self._values(domain, product[domain]))
        before = self._spared
        for domain, after in zip(list(product), reversed(all_after[:-1]), strict=True):
            product[domain] = complement(self._values_in(before & after, domain), domain.size)
            before &= self._values(domain, product[domain])
        return product

    def _values_in(self, states: Diagram, domain: Domain) -> Ranges:
        """Return the codes of an element in the states."""
        others = self._others.get(domain)
        if others is None:
            others = self._others[domain] = self._cube.exists(self._encoding.diagrams.cube(domain.levels))
        return codes(states.exists(others), domain)

    def _states(self, product: Product) -> Diagram:
        return self._encoding.diagrams.all_of(self._values(domain, ranges) for domain, ranges in product.items())

    def _values(self, domain: Domain, ranges: Ranges) -> Diagram:
        encoding = self._encoding
        return encoding.diagrams.any_of(encoding.between(domain.element, first, last) for first, last in ranges)


def _telling(domain: Domain) -> int:
    """Return the sort key of a domain. The least informative domains come first and are dropped first.

    The order is: data, communication, variables, states of components.
    """
    match domain.element:
        case sct.Plant(kind=sct.PlantKind.data):
            return 0
        case sct.Plant(kind=sct.PlantKind.behaviour):
            return 3
        case sct.Plant():
            return 1
    return 2


def _readable(domain: Domain, needed: Ranges, free: Ranges) -> Ranges:
    """Return the shortest set of codes between `needed` and `needed` plus `free`; of equals, the smallest."""
    candidates = [needed, free]
    for first, last in free:
        within = [span for span in needed if first <= span[0] and span[1] <= last]
        if within == needed:
            candidates += [[(first, needed[-1][1])], [(needed[0][0], last)], [(needed[0][0], needed[-1][1])]]
    return min(
        candidates, key=lambda candidate: (cost(domain, candidate), sum(last - first for first, last in candidate))
    )


def _shorter_covers(
    positive: _Cover, negative: _Cover, most: int | None
) -> tuple[list[Product] | None, list[Product] | None] | None:
    """Compute both covers in turns; None for a cover with more products than the other.

    Returns None if both have more than `most` products.
    """
    covers: tuple[list[Product], list[Product]] = ([], [])
    sources = positive.products(), negative.products()
    done = [False, False]
    while not any(done):
        if most is not None and len(covers[1]) > most:
            return None
        for index, source in enumerate(sources):
            product = next(source, None)
            if product is None:
                done[index] = True
            else:
                covers[index].append(product)
    return (
        positive.tidied(covers[0]) if done[0] else None,
        negative.tidied(covers[1]) if done[1] else None,
    )


def _length(products: list[Product]) -> int:
    return sum(cost(domain, ranges) for product in products for domain, ranges in product.items())


def _product(product: Product) -> ex.Expression:
    result = conjunction(is_one_of(domain, ranges) for domain, ranges in product.items())
    assert result is not None
    return result


def _denied(product: Product) -> ex.Expression:
    if len(product) > 1:
        return ex.Negation(operand=_product(product))
    [(domain, ranges)] = product.items()
    return is_one_of(domain, complement(ranges, domain.size))
