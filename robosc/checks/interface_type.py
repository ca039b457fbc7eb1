"""`interface-type`, `interface-unused` and `interface-unknown`: the model's view of a ROS type, and ROS' own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.checks.libraries import reachable
from robosc.checks.rule import Finding, interface_rule
from robosc.checks.wire_data import Carried, UsedData, Uses, carried_data, carries
from robosc.checks.wire_faults import Fault, Unknown, faults
from robosc.diagnostics import Severity
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.metamodel.reflection import tree
from robosc.ros_types.unknown import OWN_OBJECT, other_kinds

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.ros_types import RosTypes


@interface_rule("interface-type")
def interface_type(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """What the model uses of data is in the ROS type, and fits it."""
    for element, message, hint, used in _faulty(base, interfaces):
        if used:
            yield Finding(element, message, hint)


@interface_rule("interface-unused", Severity.WARNING)
def interface_unused(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """What the model declares without using it is in the ROS type, too, and fits it."""
    for element, message, hint, used in _faulty(base, interfaces):
        if not used:
            # A use may stand in text that could not be read.
            yield Finding(element, message, hint, relies_on=base, relies_on_names=(ex.Located,))


@interface_rule("interface-unknown", Severity.WARNING)
def interface_unknown(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """The definitions of all ROS types that interfaces name are at hand."""
    reported: set[tuple[object, str]] = set()
    for data in carried_data(base):
        if isinstance(data.interface.eContainer(), rsc.InterfaceTypeReference):
            continue  # Whoever linked it has said that there is no such type.
        for fault in _unknown(data, interfaces):
            wanted: ex.Located | None = fault.property if isinstance(fault, Fault) else data.interface
            other = data.declared if isinstance(fault, Fault) else data.communication
            element = wanted if wanted is not None and _root(wanted) is base else other
            if (element, fault.message) not in reported:
                reported.add((element, fault.message))
                yield Finding(element, fault.message, fault.hint)
    for _, reference in tree(base):
        if isinstance(reference, rsc.InterfaceTypeReference) and isinstance(reference.eContainer(), rsc.EnumDataType):
            others = other_kinds(interfaces, reference.package, reference.rosType, "message")
            if others and reference.type is not None:
                what = f"{reference.package}/{reference.rosType}"
                yield Finding(
                    reference,
                    f"{what} is a type of kind message and one of kind {' and '.join(others)}, expected one meaning:"
                    " the message is taken",
                    OWN_OBJECT,
                )


def _unknown(data: Carried, interfaces: RosTypes) -> list[Fault] | list[Unknown]:
    found = faults(data, interfaces, {})
    return [found] if isinstance(found, Unknown) else [fault for fault in found if fault.unknown]


def _faulty(base: rsc.Base, interfaces: RosTypes) -> Iterator[tuple[ex.Located, str, str, bool]]:
    """Where the base's text must change, why, how, and whether the model uses what is faulty there."""
    found: dict[tuple[ex.Located, str, str], bool] = {}
    units = {unit: list(carried_data(unit)) for unit in [base, *reachable(base, carries)]}
    everything = UsedData([base, *reachable(base)] if any(units.values()) else ())
    for unit, communicated in units.items():
        itself = everything if unit is base else UsedData([unit, *reachable(unit)] if communicated else ())
        for data in communicated:
            uses, reported = everything.uses(data), {} if unit is base else itself.uses(data)
            answer = faults(data, interfaces, uses)
            for fault in () if isinstance(answer, Unknown) else answer:
                if fault.unknown or (unit is not base and (fault.property is None or fault.property in reported)):
                    continue  # the library's own matter
                element = _place(base, data, fault, uses)
                if element is not None:
                    key = (element, fault.message, fault.hint)
                    found[key] = found.get(key, False) or fault.is_used(uses)
    yield from ((*key, used) for key, used in found.items())


def _place(base: rsc.Base, data: Carried, fault: Fault, uses: Uses) -> ex.Located | None:
    """The property, else what uses it, else the data that it is a part of: the first that is in the base's text."""
    use = None if fault.property is None else uses.get(fault.property)
    candidates: list[ex.Located | None] = [fault.property, use, data.declared]
    return next((candidate for candidate in candidates if candidate is not None and _root(candidate) is base), None)


def _root(element: Any) -> Any:
    while element.eContainer() is not None:
        element = element.eContainer()
    return element
