"""What the supervisor needs of a robot or library, and where in its text to say that it can't have it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.checks.definitions import unit_of
from robosc.checks.libraries import fact, instances, reachable
from robosc.checks.rule import Finding
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.semantics.cone_of_influence import (
    LARGEST_TABLE,
    ConeOfInfluence,
    Reason,
    accesses,
    conditions,
    cone_of_influence,
    read_type,
)
from robosc.semantics.operators import COMPARISONS
from robosc.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    UNKNOWN,
    EnumType,
    Types,
    declared_type,
    type_of,
    value_type,
)
from robosc.semantics.walks import fold, operands, parts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robosc.semantics.cone_of_influence import Assigned
    from robosc.semantics.instances import Instance, Instances


@dataclass(frozen=True)
class Fault:
    """An element in the cone of influence that has to change, and the first reason why it is in there."""

    element: ex.Located
    reason: Reason
    message: str
    hint: str


#: `abs`, `min` and `max` are written out by cases, up to so many parts.
_LARGEST_CHOICE = 1 << 12
#: Finds the faults of one kind among what is needed of some instances.
Search: TypeAlias = "Callable[[Instances, ConeOfInfluence], Iterator[Fault]]"


def supervised_faults(base: rsc.Base, search: Search) -> Iterator[Finding]:
    """A finding for each fault of a base that is not one of a library by itself.

    It stands at the element where the base's text has it, else at the reference in this text that makes it needed.
    """
    reported = set()
    result = fact(_cone, base)
    of_libraries: set[ex.Located] | None = None
    for fault in search(instances(base), result):
        if of_libraries is None:
            of_libraries = {fault.element for library in reachable(base) for fault in _faults(library, search)}
        if fault.element in of_libraries:
            continue
        unit = unit_of(fault.element)
        place = fault.element if unit is base else _reference(base, fault.reason, result)
        if (place, fault.element) not in reported:
            reported.add((place, fault.element))
            hint = fault.hint if unit is base else f"in library `{unit.name}`, {fault.hint}"
            yield Finding(place, fault.message, hint)


def can_be_needed(variable: rsc.Variable) -> bool:
    """Whether the supervisor can hold values of the variable's type, or the type is not known."""
    found = declared_type(variable.type)
    return found in {BOOLEAN, INTEGER, UNKNOWN} or isinstance(found, EnumType)


def data_reads(result: ConeOfInfluence) -> Iterator[tuple[Assigned, rsc.Access]]:
    """Every reading of an event's data that a needed variable is computed from.

    Only where the variable itself is fine, and gets a value of its type.
    """
    for assigned in result.computations:
        if assigned.variable is not None and can_be_needed(assigned.variable.variable) and _fits(assigned):
            for access in accesses(assigned.value):
                if access.value and isinstance(assigned.transition, rsc.ResultTransition):
                    yield assigned, access


def _fits(assigned: Assigned) -> bool:
    assert assigned.variable is not None
    wanted = declared_type(assigned.variable.type)
    value = assigned.assignment.value
    found = UNKNOWN if value is None else type_of(value)
    return UNKNOWN in {wanted, found} or found == wanted


def _faults(base: rsc.Base, search: Search) -> Iterator[Fault]:
    return search(instances(base), fact(_cone, base))


def _cone(base: rsc.Base) -> ConeOfInfluence:
    return cone_of_influence(instances(base))


def _reference(base: rsc.Base, reason: Reason, result: ConeOfInfluence) -> rsc.Access:
    while reason.within is not None and reason.within.unit is not base and reason.variable is not None:
        reason = result.variables[reason.variable]
    return reason.access


class _Limit(NamedTuple):
    """Up to how many combinations of values something is computed, and what helps beyond."""

    what: str
    most: int
    repair: str


_COMPARISON = _Limit(
    "this comparison of doubles", LARGEST_TABLE, "compare integers, or give the integers smaller ranges"
)
#: What synthesis does within seconds: the decision diagram of a product has a node for many a combination.
_PRODUCT = _Limit(
    "this product", 1 << 22, "give the integers smaller ranges, or let an enum stand for what matters about them"
)


def table_faults(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    """Each comparison of doubles and each product that the supervisor computes from too many valuations."""
    for expression, within, assigned in _computed(instances, result):
        yield from _in_expression(instances, expression, within, assigned)


def _computed(
    instances: Instances, result: ConeOfInfluence
) -> Iterator[tuple[ex.Expression | None, Instance | None, Assigned | None]]:
    """What the supervisor computes, with the instance whose text it is and where it is assigned."""
    for condition, within in conditions(instances):
        yield condition, within, None
    for assigned in result.computations:
        if assigned.variable is not None and can_be_needed(assigned.variable.variable):
            yield assigned.value, assigned.instance, assigned


def function_faults(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    """Each function that the supervisor would have to compute of doubles, or in too many cases.

    What reads a double, a string or an array has a finding of its own.
    """
    for expression, within, assigned in _computed(instances, result):
        value = value_type(assigned.assignment) if assigned else None
        types, cases = Types(value), dict[ex.Expression | None, int]()
        fold(_cases, expression, memo=cases)
        for part in parts(expression):
            read = next(accesses(part), None) if isinstance(part, ex.FunctionCall) else None
            if read is None or not isinstance(part, ex.FunctionCall) or part.function == "mod":
                continue
            reason = Reason(read, within, assigned.variable if assigned else None)
            kinds = {types(access) for access in accesses(part)}
            if not kinds <= {BOOLEAN, INTEGER} and not any(isinstance(kind, EnumType) for kind in kinds):
                continue
            if DOUBLE in {types(part), *map(types, part.arguments)}:
                message = f"`{part.function}` of doubles is nothing that the supervisor computes, expected integers"
                yield Fault(part, reason, message, "compute it of `value` in an enum's rule, and compare the enum")
            elif cases[part] > _LARGEST_CHOICE >= max(cases[argument] for argument in part.arguments):
                message = f"this has more than {_LARGEST_CHOICE} cases when `abs`, `min` and `max` are written out"
                yield Fault(part, reason, message, "let a variable remember a part of it")


def _cases(expression: ex.Expression | None, inside: list[int]) -> int:
    """How large an expression is when functions are written out by cases."""
    size = 1 + sum(inside)
    return (
        3 * size if isinstance(expression, ex.FunctionCall) and expression.function in {"abs", "min", "max"} else size
    )


def _in_expression(
    instances: Instances, expression: ex.Expression | None, within: Instance | None, assigned: Assigned | None
) -> Iterator[Fault]:
    types = Types(value_type(expression) if expression else None)
    reads: dict[ex.Expression | None, bool] = {}
    fold(lambda part, inside: isinstance(part, rsc.Access) or any(inside), expression, memo=reads)
    pending = [expression]
    while pending:
        part = pending.pop()
        if isinstance(part, COMPARISONS) and DOUBLE in {types(part.left), types(part.right)}:
            yield from _too_many(instances, part, _COMPARISON, within, assigned)
        elif isinstance(part, ex.Multiplication) and reads[part.left] and reads[part.right]:
            yield from _too_many(instances, part, _PRODUCT, within, assigned)
        else:
            pending += reversed(operands(part))


def _too_many(
    instances: Instances,
    expression: ex.BinaryExpression,
    limit: _Limit,
    within: Instance | None,
    assigned: Assigned | None,
) -> Iterator[Fault]:
    ranges: dict[object, int] = {}
    reads = list(accesses(expression))
    for access in reads:
        variable = instances.variable(access, within)
        if variable is not None:
            ranges[variable] = _size(variable.type)
        elif access.value and assigned is not None:
            path = tuple(segment.property for segment in access.segments if isinstance(segment, rsc.PropertySegment))
            ranges[path] = _size(read_type(assigned, access))
    count = math.prod(ranges.values())
    if count > limit.most:
        yield Fault(
            expression,
            Reason(reads[0], within, assigned.variable if assigned else None),
            f"{limit.what} depends on {count} combinations of integer values, expected at most {limit.most}",
            limit.repair,
        )


def _size(declared: rsc.DataType | None) -> int:
    """How many values there are; 1 where there is no range, which is reported as such."""
    if not isinstance(declared, rsc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
        return 1
    return max(declared.maximum - declared.minimum + 1, 1)
