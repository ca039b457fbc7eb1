"""`interface-link` (thesis 4.5.4)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.declarations import communications
from robosc.checks.libraries import imports
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc
from robosc.semantics.communication import carried
from robosc.semantics.naming import written
from robosc.semantics.typing import NONE, UNKNOWN, EnumType, ObjectType, Type, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator


@rule("interface-link")
def interface_link(base: rsc.Base) -> Iterator[Finding]:
    """What has no wire type of its own links an interface: objects, actions, services that carry data."""
    for _, communication in communications(base):
        if communication.interface is None:
            types = [_wire_type(declared) for _, declared in carried(communication)]
            reason = _reason(communication, types)
            if reason:
                yield Finding(
                    communication,
                    f"`{communication.name}` links no interface, expected one: {reason}",
                    _repair(communication, base, types),
                    relies_on=communication,
                    relies_on_names=(rsc.CommunicationType,),
                )


def _wire_type(declared: rsc.DataType) -> Type:
    """An enum has the wire type of its base; one over an enum is the matter of `data-type`."""
    found = declared_type(declared)
    return declared_type(found.definition.type) if isinstance(found, EnumType) else found


def _reason(communication: rsc.CommunicationType, types: list[Type]) -> str | None:
    named = next((kind for kind in types if isinstance(kind, ObjectType)), None)
    if named is not None:
        return f"its data is {named}, and only an interface says which ROS type that is"
    if isinstance(communication, rsc.Action):
        return "no ROS action type is meant by itself"
    if isinstance(communication, rsc.Service) and any(kind not in {NONE, UNKNOWN} for kind in types):
        return "only a service whose request and response are `none` has a ROS type of its own, `std_srvs/Empty`"
    return None


def _repair(communication: rsc.CommunicationType, base: rsc.Base, types: list[Type]) -> str:
    """An interface that exists where there is one that fits by name, or is at least the only one."""
    units = dict.fromkeys([base, *(library for _, library in imports(base))])
    known = [definition for unit in units for definition in unit.definitions if isinstance(definition, rsc.Interface)]
    objects = [kind.definition.name for kind in types if isinstance(kind, ObjectType)]
    fitting = [
        interface for interface in known if any(name.startswith(interface.type or interface.name) for name in objects)
    ]
    if fitting:
        return f"add `links {written(fitting[0].name)}` after its types"
    name = communication.name
    return (
        f"declare `interface {name} use … from …` with the ROS type and its package, and add `links {written(name)}`"
        " after its types"
    )
