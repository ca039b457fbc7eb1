"""Rule `parameter-scope`: the supervisor is proven for every value of a parameter, so it must read none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.rule import Finding, rule
from robosc.language.checks.supervisor_limits import Fault, supervised_accesses, supervised_faults
from robosc.model import robosc as rsc
from robosc.model.semantics.cone_of_influence import NeedReason

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model.semantics.cone_of_influence import ConeOfInfluence
    from robosc.model.semantics.instances import Instances


@rule("parameter-scope")
def parameter_scope(base: rsc.Base) -> Iterator[Finding]:
    """No expression that the supervisor evaluates reads a parameter."""
    yield from supervised_faults(base, _read)


def _read(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    for access, where in supervised_accesses(instances, result):
        if isinstance(access.item, rsc.Parameter):
            yield Fault(
                access,
                NeedReason(access, where.within, where.variable),
                f"parameter `{access.item.name}` is set on the robot, and the supervisor is proven for each of its"
                " values, expected no parameter in expressions of the supervisor",
                "compare it with `value` when data arrives, or declare a `constant`",
            )
