"""Pass: builds expressions of the engine model from terms, with conversions between integers of different storage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.m2m.sct_to_engine.terms import COMPLEMENTS
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.domains import Width, working_width

if TYPE_CHECKING:
    from collections.abc import Collection

    from robosc.m2m.sct_to_engine.share_conditions import SharedTerms
    from robosc.m2m.sct_to_engine.terms import Term


def build_expression(
    root: Term,
    shared: SharedTerms | None = None,
    before: Collection[engine.StateVariable] = (),
    *,
    body: bool = False,
) -> ex.Expression:
    """Return the expression of a term.

    `shared` terms in it become references to conditions. With `body`, the term itself is built even if it is shared.
    Variables in `before` are read with their value before the event.
    """
    built: list[ex.Expression] = []
    pending = [(root, 0)]
    while pending:
        term, ready = pending.pop()
        if ready:
            operands = built[len(built) - ready :]
            del built[len(built) - ready :]
            built.append(_built(term, operands))
        elif shared is not None and term in shared.conditions and not (body and term is root):
            built.append(engine.ConditionReference(condition=shared.conditions[term]))
        elif shared is not None and term in shared.denied and not (body and term is root):
            reference = engine.ConditionReference(condition=shared.conditions[shared.denied[term]])
            built.append(ex.Negation(operand=reference))
        elif term.operands:
            parts = term.operands if shared is None else shared.operands(term)
            pending.append((term, len(parts)))
            pending += [(part, 0) for part in reversed(parts)]
        else:
            built.append(_leaf(term, before))
    return built[0]


def build_value(variable: engine.StateVariable, value: Term, before: Collection[engine.StateVariable]) -> ex.Expression:
    """Return the expression of a value that is assigned to a variable, converted to its storage."""
    expression = build_expression(value, None, before)
    if value.sort is not int or value.constant is not None:
        return expression
    stored = Width(variable.bits, variable.signed)
    computed = isinstance(value.leaf, engine.Declaration) or _width(value) != Width(16, signed=True)
    return expression if computed and _width(value) == stored else _converted(expression, stored, widens=False)


def as_denial(condition: ex.Expression) -> ex.Expression:
    """Rewrite a condition from synthesis, a denial of states: the first of two locations becomes "not the second".

    Compilers for ARM generate shorter code for it.
    """
    if not isinstance(condition, engine.Or):
        return condition
    for position, operand in enumerate(condition.operands):
        match operand:
            case ex.Equation(left=reference, right=engine.LocationLiteral(location=first)):
                places = first.eContainer().locations
                if len(places) == 2 and places[0] is first:
                    second = engine.LocationLiteral(location=places[1])
                    condition.operands[position] = ex.Inequation(left=reference, right=second)
    return condition


def _leaf(term: Term, before: Collection[engine.StateVariable]) -> ex.Expression:
    leaf = term.leaf
    if isinstance(leaf, engine.StateVariable):
        return engine.VariableReference(variable=leaf, before=leaf in before)
    if isinstance(leaf, engine.Input):
        return engine.InputReference(input=leaf)
    assert isinstance(leaf, int)
    match term.sort:
        case None:
            return ex.BooleanLiteral(value=bool(leaf))
        case ex.Enumeration():
            return ex.EnumerationLiteralReference(literal=term.sort.literals[leaf])
        case sct.Plant():
            return engine.LocationLiteral(location=term.sort.locations[leaf])
    literal = ex.IntegerLiteral(value=abs(leaf))
    return literal if leaf >= 0 else ex.UnaryMinus(operand=literal)


def _built(term: Term, operands: list[ex.Expression]) -> Any:
    """Return the expression of an operator. Its operands are converted to the width of the computation."""
    kind: Any = term.operator
    if kind is engine.Saturation:
        low, high = term.leaf
        bits = working_width(term.operands[0].values.union(term.leaf), least=32).bits
        return engine.Saturation(operand=operands[0], minimum=low, maximum=high, bits=bits)
    if kind in (engine.And, engine.Or):
        return kind(operands=operands)
    numbers = [position for position, operand in enumerate(term.operands) if operand.sort is int]
    if numbers and not (kind in COMPLEMENTS and any(operand.constant is not None for operand in term.operands)):
        _convert(term, numbers, operands)
    match operands:
        case [operand]:
            return kind(operand=operand)
        case [condition, then, otherwise]:
            return ex.Conditional(condition=condition, then=then, otherwise=otherwise)
    return kind(left=operands[0], right=operands[1])


def _convert(term: Term, numbers: list[int], operands: list[ex.Expression]) -> None:
    """Convert numeric operands to the width of the operator. Literals are converted only in a conditional."""
    choice = term.operator is ex.Conditional
    width = _working(term)
    for position in numbers:
        operand = term.operands[position]
        if choice if operand.constant is not None else _width(operand) != width:
            operands[position] = _converted(operands[position], width, widens=True)


def _converted(expression: ex.Expression, width: Width, *, widens: bool) -> engine.Conversion:
    return engine.Conversion(operand=expression, bits=width.bits, signed=width.signed, widens=widens)


def _width(number: Term) -> Width:
    """Return the width in which a nonliteral integer is stored or computed."""
    if isinstance(number.leaf, engine.Declaration):
        return Width(number.leaf.bits, number.leaf.signed)
    if number.operator is engine.Saturation:
        return working_width(number.operands[0].values.union(number.leaf), least=32)
    return _working(number)


def _working(term: Term) -> Width:
    """Return the width in which an operator computes.

    It is that of a signed integer that holds the operands and the result.
    """
    values = [operand.values for operand in term.operands if operand.sort is int]
    values += [term.values] if term.sort is int else []
    union = values[0]
    for interval in values[1:]:
        union = union.union(interval)
    return working_width(union, least=32 if term.operator is ex.Conditional else 16)
