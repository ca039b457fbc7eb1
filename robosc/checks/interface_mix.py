"""`interface-mix`: data that fits its ROS types, some of it in ROS 1 only and some in ROS 2 only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.libraries import imports, instances, reachable
from robosc.checks.rule import Finding, interface_rule
from robosc.checks.wire_data import UsedData, carried_data, carries
from robosc.checks.wire_faults import misfits
from robosc.diagnostics import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.checks.wire_data import Carried
    from robosc.metamodel import robosc as rsc
    from robosc.ros_types import RosTypes


@interface_rule("interface-mix", Severity.WARNING)
def interface_mix(base: rsc.Base, interfaces: RosTypes) -> Iterator[Finding]:
    """One of the two ROS fits all data of a model, as a controller runs in one of them."""
    communications = {port.communication for port in instances(base).ports()}
    units = [base, *reachable(base, carries)]
    present = [(unit, data) for unit in units for data in carried_data(unit) if data.communication in communications]
    used = UsedData([base, *reachable(base)] if present else ())
    first: dict[str, tuple[rsc.Base, Carried]] = {}
    for unit, data in present:
        reasons = misfits(data, interfaces, used.uses(data))
        if len(reasons) == len(interfaces.distributions):
            continue  # The matter of `interface-type`.
        for ros, reason in reasons.items():
            others = [other_ros for other_ros in first if other_ros != ros]
            first.setdefault(ros, (unit, data))
            if others:
                other_unit, other = first[others[0]]
                if unit is not base and unit is other_unit:
                    return  # the library's own matter
                yield Finding(
                    data.declared if unit is base else _import_of(base, unit),
                    f"`{data.communication.name}` fits {others[0]} only and `{other.communication.name}` {ros} only,"
                    " expected that one ROS fits both: a controller runs in one of them",
                    f"use what both have, or leave one of them out: in {ros}, {reason}",
                )
                return


def _import_of(base: rsc.Base, unit: rsc.Base) -> rsc.Component:
    """The first imported component that brings the text of a library with it."""
    return next(component for component, library in imports(base) if library is unit or unit in reachable(library))
