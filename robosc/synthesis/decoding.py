"""Conversion of decision diagrams to values and readable expressions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.synthesis.bdd import split
from robosc.synthesis.encoding import smallest

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Domain, Element

    #: Element with a value that is no location.
    _Cell: TypeAlias = sct.DiscreteVariable | sct.Input

#: Codes of a domain as ranges, both ends included, ascending, with gaps between them.
Ranges: TypeAlias = "list[tuple[int, int]]"
#: Value outside of the model: a location or a literal by its name.
Value: TypeAlias = bool | int | str


def codes(diagram: Diagram, domain: Domain) -> Ranges:
    """Return the codes for which a function of one domain is true."""
    ranges: Ranges = []
    _collect(diagram, domain.levels, 0, ranges)
    return [(first, min(last, domain.size - 1)) for first, last in ranges if first < domain.size]


def _collect(diagram: Diagram, levels: Sequence[int], first: int, ranges: Ranges) -> None:
    if not diagram.satisfiable():
        return
    if diagram.valid():
        last = first + (1 << len(levels)) - 1
        if ranges and ranges[-1][1] == first - 1:
            first = ranges.pop()[0]
        ranges.append((first, last))
        return
    high, low = split(diagram, levels[0])
    _collect(low, levels[1:], first, ranges)
    _collect(high, levels[1:], first + (1 << len(levels) - 1), ranges)


def complement(ranges: Ranges, size: int) -> Ranges:
    """Return the codes 0 … size-1 that are in none of the ranges."""
    edges = [-1, *(end for span in ranges for end in span), size]
    gaps = zip(edges[::2], edges[1::2], strict=True)
    return [(before + 1, after - 1) for before, after in gaps if before + 1 < after]


def value(element: Element, code: int) -> Value:
    """Return the value of a code: the name of a location or literal, a boolean or an integer."""
    if isinstance(element, sct.Plant):
        return element.locations[code].name
    match element.type:
        case ex.EnumerationType(enumeration=enumeration):
            return enumeration.literals[code + smallest(element)].name
        case ex.IntegerType():
            return code + smallest(element)
    return bool(code)


def text(chosen: Value) -> str:
    """Return a value in the syntax of expressions."""
    return str(chosen).lower() if isinstance(chosen, bool) else str(chosen)


def is_one_of(domain: Domain, ranges: Ranges) -> ex.Expression:
    """Return an expression for "the element's code is in the ranges", which are neither empty nor full."""
    rest = complement(ranges, domain.size)
    if _is_integer(domain.element):
        if _size(rest) == 1:
            return _compared(ex.Inequation, domain.element, rest[0][0])
        return _either(_in_range(domain.element, domain.size, *span) for span in ranges)
    inside, outside = ([code for first, last in chosen for code in range(first, last + 1)] for chosen in (ranges, rest))
    if len(inside) <= len(outside):
        return _either(_is(domain.element, code) for code in inside)
    return _all(_is_not(domain.element, code) for code in outside)


def cost(domain: Domain, ranges: Ranges) -> int:
    """Return the number of comparisons of that expression."""
    rest = complement(ranges, domain.size)
    if not _is_integer(domain.element):
        return min(_size(ranges), _size(rest))
    if _size(rest) == 1:
        return 1
    return sum(1 if first in (last, 0) or last == domain.size - 1 else 2 for first, last in ranges)


def _size(ranges: Ranges) -> int:
    return sum(last - first + 1 for first, last in ranges)


def _is_integer(element: Element) -> TypeGuard[_Cell]:
    return not isinstance(element, sct.Plant) and isinstance(element.type, ex.IntegerType)


def _is(element: Element, code: int) -> ex.Expression:
    if isinstance(element, sct.Plant):
        return sct.LocationReference(location=element.locations[code])
    if isinstance(element.type, ex.BooleanType):
        return _reference(element) if code else ex.Negation(operand=_reference(element))
    return _compared(ex.Equation, element, code)


def _is_not(element: Element, code: int) -> ex.Expression:
    if not isinstance(element, sct.Plant) and isinstance(element.type, ex.EnumerationType):
        return _compared(ex.Inequation, element, code)
    return ex.Negation(operand=_is(element, code))


def _in_range(element: _Cell, size: int, first: int, last: int) -> ex.Expression:
    if first == last:
        return _compared(ex.Equation, element, first)
    bounds = []
    if first > 0:
        bounds.append(_compared(ex.GreaterOrEqual, element, first))
    if last < size - 1:
        bounds.append(_compared(ex.LessOrEqual, element, last))
    return _all(bounds)


def _compared(operator: type[ex.BinaryExpression], element: _Cell, code: int) -> ex.Expression:
    return operator(left=_reference(element), right=_literal(element, code))


def _reference(element: _Cell) -> ex.Expression:
    if isinstance(element, sct.Input):
        return sct.InputReference(input=element)
    return sct.VariableReference(variable=element)


def _literal(element: _Cell, code: int) -> ex.Expression:
    number = code + smallest(element)
    if isinstance(element.type, ex.EnumerationType):
        return ex.EnumerationLiteralReference(literal=element.type.enumeration.literals[number])
    literal = ex.IntegerLiteral(value=abs(number))
    return literal if number >= 0 else ex.UnaryMinus(operand=literal)


def _all(parts: Iterable[ex.Expression]) -> ex.Expression:
    result = conjunction(parts)
    assert result is not None
    return result


def _either(parts: Iterable[ex.Expression]) -> ex.Expression:
    result = disjunction(parts)
    assert result is not None
    return result
