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

#: A name, or a text, whose words are no names.
_NAME = re.compile(r'"[^"]*"|(?<![\w.])[A-Za-z_]\w*')
_NAMED = re.compile(r"`([\w.]+)`")


@dataclass(frozen=True)
class ExtendedText:
    """Text of a robot with a property for each condition, one per line from line `first` on.

    `moves` lists, for each condition, the offsets behind the names that are longer in this text, and by how much.
    """

    text: str
    first: int
    conditions: Sequence[Holds]
    moves: Sequence[Sequence[tuple[int, int]]]

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
        line = condition.span.line
        end = min(self._column(number, finding.span.end_column), condition.span.end_column)
        span = Span(line, min(self._column(number, finding.span.column), end - 1), line, end)
        return replace(finding, file=condition.file, span=span, edits=(), hint=finding.hint, rule=RULE)

    def _column(self, number: int, column: int) -> int:
        """Return the column in the scenario file of a column in the line of a condition."""
        offset = column - len(_before(number)) - 1
        return self.conditions[number].span.column + offset - sum(by for at, by in self.moves[number] if at <= offset)

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
    lines, moves = [], []
    for number, condition in enumerate(conditions):
        written, grown = _with_instances(condition.text, instances)
        lines.append(f"{_before(number)}{written})\n")
        moves.append(grown)
    first = text.count("\n", 0, brace) + 2
    return ExtendedText(f"{text[:brace]}\n{''.join(lines)}{text[brace:]}", first, conditions, moves)


def _with_instances(text: str, instances: Mapping[str, str]) -> tuple[str, list[tuple[int, int]]]:
    """Return a condition with the instances of fleets as in a model, and each end of a longer name with its growth."""
    pieces, behind, moves, length = [], 0, [], 0
    for match in _NAME.finditer(text):
        name = instances.get(match[0], match[0])
        pieces += [text[behind : match.start()], name]
        length += match.start() - behind + len(name)
        behind = match.end()
        if name != match[0]:
            moves.append((length, len(name) - len(match[0])))
    return "".join([*pieces, text[behind:]]), moves


def _name(number: int) -> str:
    return f"expected_in_line_of_scenario_{number}"


def _before(number: int) -> str:
    return f"property {_name(number)}: always ("
