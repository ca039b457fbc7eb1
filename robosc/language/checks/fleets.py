"""Fleets in the rules `integer-range`, `argument` and `unique-component`, and references to their instances."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robosc.language.checks.definitions import of_kind
from robosc.language.checks.edits import Replacement, Together
from robosc.language.checks.expression_types import CONSTANT, ExpressionCheck
from robosc.language.checks.rule import Finding, on_line
from robosc.model import robosc as rsc
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import LARGEST_FLEET, fleet_numbers, instance_text
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.typing import INTEGER

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.libraries import Meaning
    from robosc.model import expression as ex
    from robosc.model.semantics.instances import Instances


#: Parts of a message: a line of the text; text without spaces; names and numbers in it, unless it is a topic or a type.
_LINE = re.compile(r"(\bline \d+)")
_RUN = re.compile(r"[^\s`]+")
_WORD = re.compile(r"[^\W\d]\w*|\d+")


class FleetFaults:
    """Faults of the instances of fleets: the same fault of several instances is one, since they have one text."""

    def __init__(self, known: Instances) -> None:
        self._members = {instance.name: instance.component for instance in known if instance.member is not None}
        self._reported: set[tuple[object, ...]] = set()

    def is_new(self, rule: str, finding: Finding) -> bool:
        """Return whether a finding is the first one about its fault. A finding about no fleet always is."""
        element = finding.element
        is_fleet = isinstance(element, rsc.Component) and element.first is not None
        runs = (run for run in _RUN.findall(finding.message) if "/" not in run)
        if not is_fleet and not any(word in self._members for run in runs for word in _WORD.findall(run)):
            return True
        parts = enumerate(_LINE.split(finding.message))
        message = "".join(part if is_line % 2 else _RUN.sub(self._generalized, part) for is_line, part in parts)
        # The written-out copies of a requirement with `each` have one place.
        key = (rule, place(element), finding.places(), message)
        is_new = key not in self._reported
        self._reported.add(key)
        return is_new

    def _generalized(self, part: re.Match[str]) -> str:
        """Return a part of a message without the number of an instance."""
        text = part[0]
        return re.sub(r"\d+", "#", text) if "/" in text else _WORD.sub(self._general_word, text)

    def _general_word(self, word: re.Match[str]) -> str:
        text = word[0]
        return self._members[text].name if text in self._members else "#" if text.isdecimal() else text


def reference_key(reference: rsc.CommunicationReference) -> tuple[Any, ...]:
    """Return a key that is equal for two references to one communication of one instance in one text."""
    index = reference.index
    number = constant_value(index)
    shown = RoboscPrinter()(index) if index is not None and number is None else number
    return (reference.component, shown), reference.communicationType


def bounds(base: rsc.Base) -> Iterator[Finding]:
    """Report bounds of fleets that are no numbers from 0 on in order, and fleets that are too large."""
    for fleet in _fleets(base):
        first, last = (constant_value(bound) for bound in (fleet.first, fleet.last))
        if type(first) is not int or type(last) is not int:
            for bound in (fleet.first, fleet.last):
                yield from _not_constant(bound, "a bound of a fleet")
        elif first < 0:
            message = f"the instances of `{fleet.name}` begin at {first}, expected a number from 0 on"
            yield Finding(
                fleet.first or fleet, message, Replacement("write `0`", "0", fleet.first or fleet, is_choice=True)
            )
        elif last < first:
            message = f"the range {first}..{last} of `{fleet.name}` is empty, expected the lower bound first"
            swapped = (
                Replacement("", str(last), fleet.first or fleet),
                Replacement("", str(first), fleet.last or fleet),
            )
            hint = Together(f"write `{last}..{first}`", swapped, is_choice=True)
            yield Finding(fleet.last or fleet, message, hint)
        elif last - first >= LARGEST_FLEET:
            message = f"`{fleet.name}` has {last - first + 1:,} instances, expected at most {LARGEST_FLEET:,}"
            most = str(first + LARGEST_FLEET - 1)
            way = Replacement(f"write a smaller one, such as `{most}`", most, fleet.last or fleet, is_choice=True)
            yield Finding(fleet.last or fleet, message, way)


def indices(meaning: Meaning, known: Instances) -> Iterator[Finding]:
    """Report numbers of instances that are not constant, or that the fleet does not have."""
    for definition in meaning.definitions:
        for _, part in tree(definition):
            index = part.index if isinstance(part, rsc.Access | rsc.CommunicationReference) else None
            fleet = (part.component or getattr(part, "item", None)) if index is not None else None
            if not isinstance(fleet, rsc.Component) or fleet.first is None or index is None:
                continue
            if meaning.instance is None:
                yield from _not_constant(index, "the number of an instance")
            (number,) = meaning.values(index)
            numbers = known.fleet(fleet)
            if type(number) is int and numbers and number not in numbers:
                named = f"`{instance_text(fleet, number)}`"
                message = f"there is no {named}: `{fleet.name}` has the numbers {min(numbers)} to {max(numbers)}"
                nearest = str(min(numbers) if number < min(numbers) else max(numbers))
                way = Replacement(f"write one of these, such as `{nearest}`", nearest, index, is_choice=True)
                yield meaning.finding(index, message, way)


def member_names(base: rsc.Base) -> Iterator[Finding]:
    """Report instances of fleets whose name, such as `Cell2` for `Cell[2]`, something else has."""
    kinds = (rsc.Component, rsc.NamedExpression, rsc.StatedDefinition)
    others: list[Any] = of_kind(kinds, base.definitions)
    taken = {other.name: other for other in others if other.name}
    for fleet in _fleets(base):
        for number in fleet_numbers(fleet):
            name = f"{fleet.name}{number}"
            other = taken.setdefault(name, fleet)
            if other is not fleet:
                message = f"`{instance_text(fleet, number)}` is named `{name}` in all output, as another element is"
                hint = f"rename the fleet, or the other element{on_line(other)}"
                yield Finding(fleet, message, hint, related=other)


def _fleets(base: rsc.Base) -> list[rsc.Component]:
    return [component for component in of_kind(rsc.Component, base.definitions) if component.first is not None]


def _not_constant(expression: ex.Expression | None, what: str) -> Iterator[Finding]:
    check = ExpressionCheck(replace(CONSTANT, what=what, instead=""))
    check.expect(expression, INTEGER, what)
    yield from check.findings
