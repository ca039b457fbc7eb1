"""Rules that a model must follow beyond its syntax (thesis 4.5), one module of `rules` for each family.

A new rule is a function decorated by `rule` in `rules`, a page in `docs/rules`, and models in `tests/language/checks`.
Code that rules share is beside this file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.cache import cache_results
from robosc.base.diagnostics import Diagnostic, in_order
from robosc.base.interruption import checkpoint
from robosc.base.ros_types import RosTypes
from robosc.language.checks import rules as _rules  # noqa: F401 - registers them
from robosc.language.checks.fleets import FleetFaults
from robosc.language.checks.libraries import instances, reachable
from robosc.language.checks.rule import RULES
from robosc.model.places import place

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.model import robosc as rsc


def check(
    base: rsc.Base | None, known: Iterable[Diagnostic] = (), interfaces: RosTypes | None = None
) -> list[Diagnostic]:
    """Return the violations of all rules in a robot or library and in every library that it imports.

    The violations are sorted by file, position and rule. Indirectly imported libraries are checked, too. `known`: the
    findings from reading the texts. They are not returned again, and no rule reports a possible consequence of them,
    such as the absence of an element that may be in an unreadable or unresolved part of the text. `interfaces`: the
    known ROS types; None: `RosTypes()`. A base of None gives [].
    """
    if base is None:
        return []
    skipped: dict[str, list[Diagnostic]] = {}
    for finding in known:
        skipped.setdefault(finding.file, []).append(finding)
    findings: list[Diagnostic] = []
    interfaces = interfaces or RosTypes()
    with cache_results():
        for checked in [base, *reachable(base)]:
            findings += _findings(checked, skipped.get(place(checked)[0], []), interfaces)
    return in_order(findings)


def _findings(base: rsc.Base, skipped: Sequence[Diagnostic], interfaces: RosTypes) -> Iterator[Diagnostic]:
    faults = FleetFaults(instances(base))
    for rule in RULES.values():
        checkpoint()
        for finding in rule.check(base, interfaces):
            if faults.is_new(rule.id, finding) and not finding.can_be_false(skipped):
                file, span = place(finding.element)
                hint, edits, ways = finding.fixes()
                yield Diagnostic(
                    file, span, rule.severity, rule.id, finding.message, hint, edits, finding.places(), ways
                )
