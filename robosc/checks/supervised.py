"""What the supervisor needs of a robot or library, and where in its text to say that it can't have it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from robosc.checks.definitions import unit_of
from robosc.checks.libraries import fact, instances, reachable
from robosc.checks.rule import Finding
from robosc.metamodel import robosc as rsc
from robosc.semantics.cone_of_influence import ConeOfInfluence, Reason, accesses, cone_of_influence
from robosc.semantics.typing import BOOLEAN, INTEGER, UNKNOWN, EnumType, declared_type, type_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robosc.metamodel import expression as ex
    from robosc.semantics.cone_of_influence import Assigned
    from robosc.semantics.instances import Instances


@dataclass(frozen=True)
class Fault:
    """An element that the supervisor needs and that has to change, and what it is needed for."""

    element: ex.Located
    reason: Reason
    message: str
    hint: str


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
            for access in accesses(assigned.assignment.value):
                if access.value and isinstance(assigned.transition, rsc.ResultTransition):
                    yield assigned, access


def _fits(assigned: Assigned) -> bool:
    assert assigned.variable is not None
    wanted = declared_type(assigned.variable.variable.type)
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
