"""Rules on interfaces (`interface-link`, thesis 4.5.4; `-type`, `-unused`, `-unknown`, `-mix`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.diagnostics import Severity
from robosc.base.ros_types import OWN_OBJECT
from robosc.language.checks.definitions import communications, of_kind, unit_of
from robosc.language.checks.edits import Choice, Insertion, Removal, Renaming, Replacement
from robosc.language.checks.libraries import imports, instances, reachable
from robosc.language.checks.rule import Finding, interface_rule, rule
from robosc.language.checks.wire_data import CommunicationData, UsedData, Uses, carried_data, carries
from robosc.language.checks.wire_faults import Fault, Unknown, faults, misfits, wire_type
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.communication import carrying_events
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.typing import NONE, UNKNOWN, ObjectType, Type, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.ros_types import RosTypes
    from robosc.language.checks.edits import Hint


@rule("interface-link")
def interface_link(base: rsc.Base) -> Iterator[Finding]:
    """Objects, actions and services with data link an interface, because they have no ROS type of their own."""
    for communication in communications(base):
        if communication.interface is None:
            types = [declared_type(wire_type(declared)) for _, declared in carrying_events(communication)]
            reason = _reason(communication, types)
            if reason:
                yield Finding(
                    communication,
                    f"`{communication.name}` links no interface, expected one: {reason}",
                    _missing_link(communication, base, types),
                    relies_on=communication,
                    relies_on_names=(rsc.CommunicationType,),
                )


def _reason(communication: rsc.CommunicationType, types: list[Type]) -> str | None:
    named = next((kind for kind in types if isinstance(kind, ObjectType)), None)
    if named is not None:
        return f"its data is {named}, and only an interface names its ROS type"
    if isinstance(communication, rsc.Action | rsc.OutgoingAction):
        return "an action has no ROS type of its own"
    if isinstance(communication, rsc.Service | rsc.OutgoingService) and any(
        kind not in {NONE, UNKNOWN} for kind in types
    ):
        return "only a service whose request and response are `none` has a ROS type of its own, `std_srvs/Empty`"
    return None


def _missing_link(communication: rsc.CommunicationType, base: rsc.Base, types: list[Type]) -> Insertion | str:
    """Return a hint to link an existing interface with a fitting name, else to declare one."""
    units = dict.fromkeys([base, *(library for _, library in imports(base))])
    known = [interface for unit in units for interface in of_kind(rsc.Interface, unit.definitions)]
    objects = [kind.definition.name for kind in types if isinstance(kind, ObjectType)]
    fitting = [
        interface for interface in known if any(name.startswith(interface.type or interface.name) for name in objects)
    ]
    if fitting:
        link = f"links {escape_keyword(fitting[0].name)}"
        return Insertion(f"add `{link}` after its types", f" {link}", communication, behind=True, is_choice=True)
    name = communication.name
    return (
        f"declare `interface {name} use … from …` with the ROS type and its package, "
        f"and add `links {escape_keyword(name)}` after its types"
    )


@interface_rule("interface-type")
def interface_type(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """All data that the model uses exists in the ROS type and fits it."""
    for element, message, hint, used in _faulty(base, interfaces):
        if used:
            yield Finding(element, message, hint)


@interface_rule("interface-unused", Severity.WARNING)
def interface_unused(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """All data that the model declares but does not use exists in the ROS type and fits it."""
    for element, message, hint, used in _faulty(base, interfaces):
        if not used:
            # Unreadable text may contain a use.
            yield Finding(element, message, hint, relies_on=base, relies_on_names=(ex.Located,))


@interface_rule("interface-unknown", Severity.WARNING)
def interface_unknown(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """All ROS types of interfaces have known definitions."""
    reported: set[tuple[object, str]] = set()
    for data in carried_data(base):
        if isinstance(data.interface.eContainer(), rsc.InterfaceTypeReference):
            continue  # The data type that links the interface has the finding.
        for fault in _unknown(data, interfaces):
            candidate: ex.Located | None = fault.property if isinstance(fault, Fault) else data.interface
            other = data.declared if isinstance(fault, Fault) else data.communication
            element = candidate if candidate is not None and unit_of(candidate) is base else other
            if (element, fault.message) not in reported:
                reported.add((element, fault.message))
                yield Finding(element, fault.message, _suggestion(fault, element))
    for _, reference in tree(base):
        if isinstance(reference, rsc.InterfaceTypeReference) and isinstance(reference.eContainer(), rsc.EnumDataType):
            others = interfaces.other_kinds(reference.package, reference.rosType, "message")
            if others and reference.type is not None:
                what = f"{reference.package}/{reference.rosType}"
                yield Finding(
                    reference,
                    f"{what} is a type of kind message and one of kind {' and '.join(others)}, expected one kind:"
                    " the message is used",
                    OWN_OBJECT,
                )


def _suggestion(fault: Fault | Unknown, element: ex.Located | None) -> Hint:
    """Return the hint, with the intended type as an edit if it is known."""
    if isinstance(fault, Unknown) and fault.meant is not None and isinstance(element, rsc.Interface):
        package, name = fault.meant
        text = f"interface {escape_keyword(element.name)} use {escape_keyword(name)} from {escape_keyword(package)}"
        return Replacement(fault.hint, text, element, is_choice=True)
    return fault.hint


def _unknown(data: CommunicationData, interfaces: RosTypes) -> list[Fault] | list[Unknown]:
    mismatches = faults(data, interfaces, {})
    return [mismatches] if isinstance(mismatches, Unknown) else [fault for fault in mismatches if fault.unknown]


def _faulty(base: rsc.Base, interfaces: RosTypes) -> Iterator[tuple[ex.Located, str, Hint, bool]]:
    """Yield the places to change in the base's text, with message, hint, and whether the model uses the data."""
    places: dict[tuple[ex.Located, str, Hint], bool] = {}
    units = {unit: list(carried_data(unit)) for unit in [base, *reachable(base, carries)]}
    everything = UsedData([base, *reachable(base)] if any(units.values()) else ())
    for unit, communicated in units.items():
        itself = everything if unit is base else UsedData([unit, *reachable(unit)] if communicated else ())
        for data in communicated:
            uses, reported = everything.uses(data), {} if unit is base else itself.uses(data)
            answer = faults(data, interfaces, uses)
            for fault in () if isinstance(answer, Unknown) else answer:
                if fault.unknown or (unit is not base and (fault.property is None or fault.property in reported)):
                    continue  # The library has this finding.
                element = _place(base, data, fault, uses)
                if element is not None:
                    hint: Hint = fault.hint
                    if fault.property is element and fault.property is not None:
                        hint = _of_property(fault, fault.property)
                    elif fault.text is not None and fault.property is None and element is data.declared:
                        hint = Replacement(fault.hint, fault.text, element, is_choice=fault.is_guess)
                    key = (element, fault.message, hint)
                    places[key] = places.get(key, False) or fault.is_used(uses)
    yield from ((*key, used) for key, used in places.items())


def _of_property(fault: Fault, declared: rsc.ObjectProperty) -> Hint:
    """Return the hint at the property with the edits that follow it."""
    if fault.text is not None:
        return Replacement(fault.hint, fault.text, declared, is_choice=fault.is_guess)
    if fault.new_name is not None:
        return Renaming(fault.hint, declared, fault.new_name, is_choice=fault.is_guess)
    if fault.others is None:
        return fault.hint
    fields = [f"{escape_keyword(name)}: {kind}" for name, kind in fault.others.items()]
    ways = [Replacement(f"write `{text}`", text, declared) for text in fields]
    return Choice(fault.hint, (*ways, Removal("leave it out", declared)))


def _place(base: rsc.Base, data: CommunicationData, fault: Fault, uses: Uses) -> ex.Located | None:
    """Return the first of these in the base's text: the property, its use, the data that contains it."""
    use = None if fault.property is None else uses.get(fault.property)
    candidates: list[ex.Located | None] = [fault.property, use, data.declared]
    return next((candidate for candidate in candidates if candidate is not None and unit_of(candidate) is base), None)


@interface_rule("interface-mix", Severity.WARNING)
def interface_mix(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """One of the two ROS versions fits all data of a model, because a controller runs in one of them."""
    communications = {port.communication for port in instances(base).ports()}
    units = [base, *reachable(base, carries)]
    present = [(unit, data) for unit in units for data in carried_data(unit) if data.communication in communications]
    used = UsedData([base, *reachable(base)] if present else ())
    first: dict[str, tuple[rsc.Base, CommunicationData]] = {}
    for unit, data in present:
        reasons = misfits(data, interfaces, used.uses(data))
        if len(reasons) == len(interfaces.distributions):
            continue  # `interface-type` reports this.
        for ros, reason in reasons.items():
            others = [other_ros for other_ros in first if other_ros != ros]
            first.setdefault(ros, (unit, data))
            if others:
                other_unit, other = first[others[0]]
                if unit is not base and unit is other_unit:
                    return  # The library has this finding.
                yield Finding(
                    data.declared if unit is base else _import_of(base, unit),
                    f"`{data.communication.name}` fits {others[0]} only and `{other.communication.name}` {ros} only,"
                    " expected that one ROS fits both: a controller runs in one of them",
                    f"use only features of both, or leave one of them out: in {ros}, {reason}",
                )
                return


def _import_of(base: rsc.Base, unit: rsc.Base) -> rsc.Component:
    """Return the first imported component that brings the text of a library."""
    return next(component for component, library in imports(base) if library is unit or unit in reachable(library))
