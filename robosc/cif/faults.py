"""Faults of a specification, with their places."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robosc.diagnostics import Severity

if TYPE_CHECKING:
    from robosc.diagnostics import Diagnostic, Repair
    from robosc.language.text import Text
    from robosc.metamodel.places import Place


class CifFaultError(Exception):
    """That something of a text is wrong: an object of the grammar, the rule, what is wrong and how to mend it."""

    def __init__(self, read: Any, rule: str, message: str, repair: Repair | str | None = None) -> None:
        super().__init__(message)
        self.read = read
        self.rule = rule
        self.message = message
        self.repair = repair

    def finding(self) -> Diagnostic:
        """The fault as a finding in its text."""
        return text_of(self.read).error(self.rule, *span(self.read), self.message, self.repair)

    def warning(self) -> Diagnostic:
        """The fault as a finding that leaves the model usable."""
        return replace(self.finding(), severity=Severity.WARNING)


#: How to mend what a transformation of CIF's `cif2cif` takes out, by its name there.
CHANNELS = "CIF's `cif2cif -t linearize-product` makes events without data of them"
CONDITIONAL_UPDATES = "CIF's `cif2cif -t elim-if-updates` takes them out"
SUPERVISORS = "CIF's `cif2cif -t relabel-supervisors-as-plants` makes plants of them"
TAU = "CIF's `cif2cif -t elim-tau-event` gives it one: declare that as `uncontrollable`"


def text_of(read: Any) -> Text:
    """The text that an object of the grammar stands in; the specification around it keeps it."""
    while hasattr(read, "parent"):
        read = read.parent
    text: Text = read.whole_text
    return text


def span(read: Any) -> tuple[int, int]:
    """The offsets of an object of the grammar in its text."""
    return read._tx_position, read._tx_position_end  # noqa: SLF001 - textX's own way to tell it


def located(read: Any) -> Place:
    """The place of an object of the grammar."""
    return text_of(read).source(*span(read))


def construct(read: Any, what: str, hint: str) -> CifFaultError:
    """That synthesis does not take a construct, and what removes it."""
    return CifFaultError(read, "cif-construct", f"synthesis does not take {what}", hint)
