"""Data of a robot or library that the supervisor needs but does not support, and where to report it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.base.cache import cached
from robosc.language.checks.definitions import unit_of
from robosc.language.checks.libraries import instances, reachable
from robosc.language.checks.rule import Finding
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.cone_of_influence import (
    LARGEST_TABLE,
    ConeOfInfluence,
    NeedReason,
    accesses,
    conditions,
    cone_of_influence,
)
from robosc.model.semantics.inputs import ComputedValue, Data
from robosc.model.semantics.operators import COMPARISONS, FUNCTIONS, TypeRule
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    STRING,
    UNKNOWN,
    EnumType,
    Types,
    declared_type,
    type_of,
    value_type,
)
from robosc.model.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from robosc.language.checks.edits import Hint
    from robosc.model.semantics.cone_of_influence import AssignmentPlace, InputRead
    from robosc.model.semantics.inputs import InputSource
    from robosc.model.semantics.instances import Instance, Instances, InstanceVariable
    from robosc.model.semantics.typing import Type


@dataclass(frozen=True)
class Fault:
    """Unsupported element in the cone of influence, and the first reason why the supervisor needs it."""

    element: ex.Located
    reason: NeedReason
    message: str
    hint: Hint


#: Maximum size of an expression after `abs`, `min` and `max` are expanded into cases for C and CIF.
_LARGEST_CHOICE = 1 << 12
#: Yields the faults of one kind in a cone of influence.
Search: TypeAlias = "Callable[[Instances, ConeOfInfluence], Iterator[Fault]]"


def supervised_faults(base: rsc.Base, search: Search) -> Iterator[Finding]:
    """Yield a finding for each fault of a base that is not a fault of one of its libraries.

    The finding is at the element if it is in the base's text. Otherwise, it is at the reference in this text that makes
    the supervisor need the element.
    """
    reported = set()
    result = _cone(base)
    of_libraries: set[ex.Located] | None = None
    for fault in search(instances(base), result):
        if of_libraries is None:
            of_libraries = {fault.element for library in reachable(base) for fault in _faults(library, search)}
        if fault.element in of_libraries:
            continue
        unit = _unit(fault, base)
        place = fault.element if unit is base else _reference(base, fault.reason, result)
        if (place, fault.element) not in reported:
            reported.add((place, fault.element))
            hint_text = fault.hint if isinstance(fault.hint, str) else fault.hint.hint
            hint = fault.hint if unit is base else f"in library `{unit.name}`, {hint_text}"
            yield Finding(place, fault.message, hint)


def _unit(fault: Fault, base: rsc.Base) -> rsc.Base:
    """Return the robot or library whose text contains the element.

    An expanded element has the place of its original.
    """
    unit = unit_of(fault.element)
    if isinstance(unit, rsc.Base):
        return unit
    return base if fault.reason.within is None else fault.reason.within.unit


def can_be_needed(variable: rsc.Variable) -> bool:
    """Return whether the supervisor can hold values of the variable's type, or the type is unknown."""
    kind = declared_type(variable.type)
    return kind in {BOOLEAN, INTEGER, UNKNOWN} or isinstance(kind, EnumType)


def readings(result: ConeOfInfluence) -> Iterator[InputRead]:
    """Return every reading of an event's data that the supervisor computes with.

    Readings of unsupported variables and assignments of a wrong type are left out: these have findings of their own.
    """
    unfit = {
        assigned.value
        for assigned in result.computations
        if assigned.variable is not None and not (can_be_needed(assigned.variable.variable) and _fits(assigned))
    }
    return (reading for reading in result.readings if reading.whole not in unfit)


def _fits(assigned: AssignmentPlace) -> bool:
    assert assigned.variable is not None
    expected = declared_type(assigned.variable.type)
    value = assigned.assignment.value
    actual = UNKNOWN if value is None else type_of(value)
    return UNKNOWN in {expected, actual} or actual == expected


def _faults(base: rsc.Base, search: Search) -> Iterator[Fault]:
    return search(instances(base), _cone(base))


def _cone(base: rsc.Base) -> ConeOfInfluence:
    return cached((cone_of_influence, base), lambda: cone_of_influence(instances(base)))


def _reference(base: rsc.Base, reason: NeedReason, result: ConeOfInfluence) -> rsc.Access | rsc.ErrorReason:
    while reason.within is not None and reason.within.unit is not base and reason.variable is not None:
        reason = result.variables[reason.variable]
    return reason.access


class _Limit(NamedTuple):
    """Maximum number of value combinations of a computation, with the repair for a larger one."""

    what: str
    most: int
    repair: str


_COMPARISON = _Limit(
    "this comparison of doubles or strings", LARGEST_TABLE, "compare integers, or give the integers smaller ranges"
)
#: Synthesis takes seconds up to this limit. The decision diagram of a product has a node for many combinations.
_PRODUCT = _Limit("this product", 1 << 22, "give the integers smaller ranges, or use an enum for their relevant values")


class _Where(NamedTuple):
    """Context of an expression: its instance, the variable that it is assigned to, and its inputs."""

    within: Instance | None
    variable: InstanceVariable | None
    inputs: Mapping[ex.Expression, InputSource | None]


class _Known:
    """Facts about the parts of several expressions. The copies of a text with `each` have expanded parts in common."""

    def __init__(self) -> None:
        self._types: dict[Type | None, Types] = {}
        self._visited: set[tuple[ex.Expression, Instance | None]] = set()
        self.cases: dict[ex.Expression | None, int] = {}
        self.reads: dict[ex.Expression | None, bool] = {}

    def types(self, expression: ex.Expression) -> Types:
        """Return the types of an expression and its parts."""
        value = value_type(expression)
        return self._types.setdefault(value, Types(value))

    def is_new(self, part: ex.Expression, where: _Where) -> bool:
        """Return whether a part has not been visited in this context."""
        key = (part, where.within)
        is_new = bool(where.inputs) or key not in self._visited
        if not where.inputs:
            self._visited.add(key)
        return is_new


def table_faults(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    """Report comparisons of doubles or strings, and products, with too many value combinations."""
    known = _Known()
    for expression, where in _computed(instances, result):
        yield from _in_expression(instances, expression, where, known)


def _computed(instances: Instances, result: ConeOfInfluence) -> Iterator[tuple[ex.Expression, _Where]]:
    """Yield the expressions that the supervisor computes, each with its context."""
    inputs: dict[ex.Expression | None, dict[ex.Expression, InputSource | None]] = {}
    for reading in result.readings:
        inputs.setdefault(reading.whole, {})[reading.part] = reading.source
    for condition in conditions(instances):
        yield condition.expression, _Where(condition.within, None, inputs.get(condition.expression, {}))
    for assigned in result.computations:
        if assigned.variable is not None and can_be_needed(assigned.variable.variable) and assigned.value is not None:
            yield assigned.value, _Where(assigned.instance, assigned.variable, inputs.get(assigned.value, {}))


def function_faults(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    """Report functions of doubles or strings, and functions with too many cases, in the supervisor.

    An access to a double, a string or an array has a finding of its own.
    """
    known = _Known()
    for expression, where in _computed(instances, result):
        types, cases = known.types(expression), known.cases
        fold(_cases, expression, memo=cases)
        for part in _supervised_parts(expression, where, known):
            first_access = next(accesses(part), None) if isinstance(part, ex.FunctionCall) else None
            if (
                first_access is None
                or not isinstance(part, ex.FunctionCall)
                or FUNCTIONS[part.function].rule is TypeRule.INTEGER
            ):
                continue
            reason = NeedReason(first_access, where.within, where.variable)
            kinds = {types(access) for access in accesses(part)}
            if not kinds <= {BOOLEAN, INTEGER} and not any(isinstance(kind, EnumType) for kind in kinds):
                continue
            types_used = {types(part), *map(types, part.arguments)}
            foreign = "doubles" if DOUBLE in types_used else "strings" if STRING in types_used else ""
            if foreign:
                message = f"`{part.function}` of {foreign} cannot be computed by the supervisor, expected integers"
                yield Fault(part, reason, message, "compute it from `value` in a rule of an enum, and compare the enum")
            elif cases[part] > _LARGEST_CHOICE >= max(cases[argument] for argument in part.arguments):
                message = f"this has more than {_LARGEST_CHOICE} cases after `abs`, `min` and `max` are expanded"
                yield Fault(part, reason, message, "store a part of it in a variable")


def supervised_accesses(instances: Instances, result: ConeOfInfluence) -> Iterator[tuple[rsc.Access, _Where]]:
    """Yield the accesses in the expressions that the supervisor computes itself, each with its first context."""
    known = _Known()
    for expression, where in _computed(instances, result):
        for part in _supervised_parts(expression, where, known):
            if isinstance(part, rsc.Access):
                yield part, where


def _supervised_parts(expression: ex.Expression, where: _Where, known: _Known) -> Iterator[ex.Expression]:
    """Yield the new parts of an expression that the supervisor computes, not those that the node computes for it."""
    pending = [expression]
    while pending:
        part = pending.pop()
        if known.is_new(part, where) and not isinstance(where.inputs.get(part), ComputedValue):
            yield part
            pending += reversed(operands(part))


def _cases(expression: ex.Expression | None, inside: list[int]) -> int:
    """Return the size of an expression after its functions are expanded into cases."""
    size = 1 + sum(inside)
    return (
        3 * size if isinstance(expression, ex.FunctionCall) and expression.function in {"abs", "min", "max"} else size
    )


def _in_expression(instances: Instances, expression: ex.Expression, where: _Where, known: _Known) -> Iterator[Fault]:
    types, reads = known.types(expression), known.reads
    fold(lambda part, inside: isinstance(part, rsc.Access) or any(inside), expression, memo=reads)
    pending = [expression]
    while pending:
        part = pending.pop()
        if not known.is_new(part, where) or isinstance(where.inputs.get(part), ComputedValue):
            continue
        if isinstance(part, COMPARISONS) and {DOUBLE, STRING} & {types(part.left), types(part.right)}:
            yield from _too_many(instances, part, _COMPARISON, where)
        elif isinstance(part, ex.Multiplication) and reads[part.left] and reads[part.right]:
            yield from _too_many(instances, part, _PRODUCT, where)
        else:
            pending += reversed(operands(part))


def _too_many(instances: Instances, expression: ex.BinaryExpression, limit: _Limit, where: _Where) -> Iterator[Fault]:
    ranges: dict[object, int] = {}
    reads = list(accesses(expression))
    for access in reads:
        variable, data = instances.variable(access, where.within), where.inputs.get(access)
        if variable is not None:
            ranges[variable] = _size(variable.type)
        elif isinstance(data, Data):
            ranges[data] = _size(data.type)
    count = math.prod(ranges.values())
    if count > limit.most:
        yield Fault(
            expression,
            NeedReason(reads[0], where.within, where.variable),
            f"{limit.what} depends on {count} combinations of integer values, expected at most {limit.most}",
            limit.repair,
        )


def _size(declared: rsc.DataType | None) -> int:
    """Return the number of values; 1 for a type without a range, which has a finding of its own."""
    if not isinstance(declared, rsc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
        return 1
    return max(declared.maximum - declared.minimum + 1, 1)
