"""Faults of a specification, with their places."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Severity

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic, Repair
    from robosc.language.text import Text
    from robosc.model.places import Place


class CifFaultError(Exception):
    """A fault in a text: the object of the grammar, the rule, the message, and the repair or hint."""

    def __init__(self, node: Any, rule: str, message: str, repair: Repair | str | None = None) -> None:
        super().__init__(message)
        self.node = node
        self.rule = rule
        self.message = message
        self.repair = repair

    def finding(self) -> Diagnostic:
        """Return the fault as a finding in its text."""
        return text_of(self.node).error(self.rule, *span(self.node), self.message, self.repair)

    def warning(self) -> Diagnostic:
        """Return the fault as a finding that leaves the model usable."""
        return replace(self.finding(), severity=Severity.WARNING)


#: Hints for constructs that a transformation of CIF's `cif2cif` eliminates.
CONDITIONAL_UPDATES = "CIF's `cif2cif -t elim-if-updates` removes them"
TAU = "CIF's `cif2cif -t elim-tau-event` adds an event: declare it as `uncontrollable`"


def text_of(node: Any) -> Text:
    """Return the text of an object of the grammar; the specification around it stores the text."""
    while hasattr(node, "parent"):
        node = node.parent
    text: Text = node.whole_text
    return text


def span(node: Any) -> tuple[int, int]:
    """Return the offsets of an object of the grammar in its text."""
    return node._tx_position, node._tx_position_end  # noqa: SLF001 - textX has no public attribute for them


def place_of(node: Any) -> Place:
    """Return the place of an object of the grammar."""
    return text_of(node).source(*span(node))


def construct(node: Any, what: str, hint: str) -> CifFaultError:
    """Return the fault of a construct that synthesis does not support, with the hint that removes it."""
    return CifFaultError(node, "cif-construct", f"synthesis does not take {what}", hint)
