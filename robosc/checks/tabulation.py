"""Comparisons of doubles that are computed from so many integer values that no supervisor can tabulate them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.supervised import Fault, can_be_needed
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.needed import LARGEST_TABLE, Need, Needed, accesses, conditions, read_type
from robosc.typing import DOUBLE, EQUALITY, ORDERING, infer, value_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.instances import Instance, Instances
    from robosc.needed import Assigned


def table_faults(instances: Instances, result: Needed) -> Iterator[Fault]:
    """Each comparison of doubles that the supervisor evaluates and that has more valuations than a table can have."""
    for condition, within in conditions(instances):
        yield from _in_expression(instances, condition, within, None)
    for assigned in result.computations:
        if assigned.variable is not None and can_be_needed(assigned.variable.variable):
            yield from _in_expression(instances, assigned.assignment.value, assigned.instance, assigned)


def _in_expression(
    instances: Instances, expression: ex.Expression | None, within: Instance | None, assigned: Assigned | None
) -> Iterator[Fault]:
    value = value_type(expression) if expression else None
    pending = [expression]
    while pending:
        each = pending.pop()
        if isinstance(each, (*EQUALITY, *ORDERING)) and DOUBLE in {infer(each.left, value), infer(each.right, value)}:
            yield from _in_comparison(instances, each, within, assigned)
        elif isinstance(each, ex.BinaryExpression):
            pending += [each.right, each.left]
        elif isinstance(each, ex.UnaryExpression):
            pending.append(each.operand)


def _in_comparison(
    instances: Instances, comparison: ex.BinaryExpression, within: Instance | None, assigned: Assigned | None
) -> Iterator[Fault]:
    ranges: dict[object, int] = {}
    reads = list(accesses(comparison))
    for access in reads:
        variable = instances.variable(access, within)
        if variable is not None:
            ranges[variable] = _size(variable.variable.type)
        elif access.value and assigned is not None:
            path = tuple(each.property for each in access.segments if isinstance(each, rsc.PropertySegment))
            ranges[path] = _size(read_type(assigned, access))
    count = 1
    for size in ranges.values():
        count *= size
    if count > LARGEST_TABLE:
        yield Fault(
            comparison,
            Need(reads[0], within, assigned.variable if assigned else None),
            f"this comparison of doubles depends on {count} combinations of integer values, expected at most"
            f" {LARGEST_TABLE}",
            "compare integers, or give the integers smaller ranges",
        )


def _size(declared: rsc.DataType | None) -> int:
    """How many values there are; 1 where there is no range, which is reported as such."""
    if not isinstance(declared, rsc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
        return 1
    return max(declared.maximum - declared.minimum + 1, 1)
