"""Doubles and products that are computed from so many integer values that no supervisor can tabulate them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from robosc.checks.supervised import Fault, can_be_needed
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.semantics.cone_of_influence import LARGEST_TABLE, ConeOfInfluence, Reason, accesses, conditions, read_type
from robosc.semantics.operators import COMPARISONS
from robosc.semantics.typing import DOUBLE, Types, value_type
from robosc.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.semantics.cone_of_influence import Assigned
    from robosc.semantics.instances import Instance, Instances


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
    for condition, within in conditions(instances):
        yield from _in_expression(instances, condition, within, None)
    for assigned in result.computations:
        if assigned.variable is not None and can_be_needed(assigned.variable.variable):
            yield from _in_expression(instances, assigned.assignment.value, assigned.instance, assigned)


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
            ranges[variable] = _size(variable.variable.type)
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
