"""The rules that a model must follow beyond its syntax (thesis 4.5): a module of `rules` a family.

A new rule is a function decorated by `rule` in `rules`, a page in `docs/rules`, and models in `tests/checks`. What
rules have in common stands beside this file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks import rules as _rules  # noqa: F401 - registers them
from robosc.checks.libraries import reachable, remembering
from robosc.checks.rule import RULES
from robosc.diagnostics import Diagnostic, in_order
from robosc.interruption import checkpoint
from robosc.metamodel.places import place
from robosc.ros_types import RosTypes

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.metamodel import robosc as rsc


def check(
    base: rsc.Base | None, known: Iterable[Diagnostic] = (), interfaces: RosTypes | None = None
) -> list[Diagnostic]:
    """The violations of all rules in a robot or library and in every library that it imports, directly or not.

    They are sorted by file, position and rule. `known`: the findings from reading the texts; they are not returned
    again, and no rule reports what they may have caused, such as the absence of something that may stand in a part of
    the text that could not be read or resolved. `interfaces`: the known ROS types; None: `RosTypes()`. A base of None
    gives [].
    """
    if base is None:
        return []
    skipped: dict[str, list[Diagnostic]] = {}
    for finding in known:
        skipped.setdefault(finding.file, []).append(finding)
    findings: list[Diagnostic] = []
    interfaces = interfaces or RosTypes()
    with remembering():
        for checked in [base, *reachable(base)]:
            findings += _findings(checked, skipped.get(place(checked)[0], []), interfaces)
    return in_order(findings)


def _findings(base: rsc.Base, skipped: Sequence[Diagnostic], interfaces: RosTypes) -> Iterator[Diagnostic]:
    for rule in RULES.values():
        checkpoint()
        for finding in rule.check(base, interfaces):
            if not finding.can_be_false(skipped):
                file, span = place(finding.element)
                hint, edits, ways = finding.said()
                yield Diagnostic(
                    file, span, rule.severity, rule.id, finding.message, hint, edits, finding.places(), ways
                )
