"""Conditions that scenarios expect, parsed by the language as properties at the end of the robot's text."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, Span
from robosc.run.scenario_tests.reading import RULE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.model import expression as ex
    from robosc.model import sct
    from robosc.run.scenario_tests.reading import Holds

_NAME = re.compile(r"(?<![\w.\"])[A-Za-z_]\w*")
_NAMED = re.compile(r"`([\w.]+)`")


@dataclass(frozen=True)
class ExtendedText:
    """Text of a robot with a property for each condition, one per line from line `first` on."""

    text: str
    first: int
    conditions: Sequence[Holds]

    def move_to_scenario(self, finding: Diagnostic) -> Diagnostic:
        """Return a finding with its place in the scenario file: at the condition that it is about."""
        number = finding.span.line - self.first
        if not 0 <= number < len(self.conditions):
            # The robot has no faults of its own: a condition needs something that cannot be had.
            names = _NAMED.findall(finding.message)
            reading = (condition for condition in self.conditions if any(name in condition.text for name in names))
            condition = next(reading, self.conditions[0])
            return condition.fault(finding.message, "read a state, or a variable of the supervisor")
        condition = self.conditions[number]
        shift = condition.span.column - len(_before(number)) - 1
        line = condition.span.line
        end = min(finding.span.end_column + shift, condition.span.end_column)
        span = Span(line, min(finding.span.column + shift, end - 1), line, end)
        return replace(finding, file=condition.file, span=span, edits=(), hint=finding.hint, rule=RULE)

    def expressions(self, model: sct.SupervisoryControlModel) -> list[ex.Expression]:
        """Remove the properties of the conditions from the model made of the text; return their expressions."""
        named = {declared.name: declared for declared in model.properties}
        properties = [named[_name(number)] for number in range(len(self.conditions))]
        for declared in properties:
            model.properties.remove(declared)
        return [declared.condition for declared in properties]


def add_conditions(text: str, end: int, conditions: Sequence[Holds], instances: Mapping[str, str]) -> ExtendedText:
    """Return the text of a robot that ends at an offset, with the conditions added before its closing brace.

    `instances` maps the names of the instances of fleets to their texts in a model: `Cell2` to `Cell[2]`.
    """
    brace = text.rindex("}", 0, end)
    texts = (
        _NAME.sub(lambda match: instances.get(match[0], match[0]), condition.text) if instances else condition.text
        for condition in conditions
    )
    lines = "".join(f"{_before(number)}{condition})\n" for number, condition in enumerate(texts))
    return ExtendedText(f"{text[:brace]}\n{lines}{text[brace:]}", text.count("\n", 0, brace) + 2, conditions)


def _name(number: int) -> str:
    return f"expected_in_line_of_scenario_{number}"


def _before(number: int) -> str:
    return f"property {_name(number)}: always ("
