"""`interface-mix`: data that fits its ROS types, some of it in ROS 1 only and some in ROS 2 only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.libraries import imports, instances, reachable
from robosc.checks.rule import Finding, interface_rule
from robosc.checks.wire_data import UsedData, carried, carries
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
    communications = {occurrence.communication for occurrence in instances(base).occurrences()}
    homes = [base, *reachable(base, carries)]
    present = [(home, data) for home in homes for data in carried(home) if data.communication in communications]
    used = UsedData([base, *reachable(base)] if present else ())
    first: dict[str, tuple[rsc.Base, Carried]] = {}
    for home, data in present:
        reasons = misfits(data, interfaces, used.uses(data))
        if len(reasons) == len(interfaces.distributions):
            continue  # The matter of `interface-type`.
        for ros, reason in reasons.items():
            others = [each for each in first if each != ros]
            first.setdefault(ros, (home, data))
            if others:
                other_home, other = first[others[0]]
                if home is not base and home is other_home:
                    return  # the library's own matter
                yield Finding(
                    data.declared if home is base else _import_of(base, home),
                    f"`{data.communication.name}` fits {others[0]} only and `{other.communication.name}` {ros} only,"
                    " expected that one ROS fits both: a controller runs in one of them",
                    f"use what both have, or leave one of them out: in {ros}, {reason}",
                )
                return


def _import_of(base: rsc.Base, home: rsc.Base) -> rsc.Component:
    """The first imported component that brings the text of a library with it."""
    return next(component for component, library in imports(base) if library is home or home in reachable(library))
