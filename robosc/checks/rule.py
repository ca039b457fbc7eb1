"""What a rule is, and the register of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.diagnostics import Edit, Related, Repair, Severity, Span
from robosc.metamodel import expression as ex
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from robosc.diagnostics import Diagnostic
    from robosc.metamodel import robosc as rsc
    from robosc.ros_types import RosTypes


class Insertion(NamedTuple):
    """A hint, and the text that does what it says, to be written before an element, or `behind` it.

    With `is_choice` it is one way of several: a person chooses.
    """

    hint: str
    text: str
    element: ex.Located
    behind: bool = False
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        return (Edit(end_of(span) if self.behind else start_of(span), self.text),)


class Replacement(NamedTuple):
    """A hint, and the text that does what it says in place of an element, or of what is before `until` in it."""

    hint: str
    text: str
    element: ex.Located
    is_choice: bool = False
    until: ex.Located | None = None

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        if self.until is not None:
            end = place(self.until)[1]
            span = Span(span.line, span.column, end.line, end.column)
        return (Edit(span, self.text),)


class Wrapping(NamedTuple):
    """A hint, and the texts that do what it says, before an element and behind it."""

    hint: str
    before: str
    behind: str
    element: ex.Located
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """What does it, in the file of the element."""
        span = place(self.element)[1]
        return tuple(
            Edit(at, text) for at, text in ((start_of(span), self.before), (end_of(span), self.behind)) if text
        )


def start_of(span: Span) -> Span:
    """The place before a span."""
    return Span(span.line, span.column, span.line, span.column)


def end_of(span: Span) -> Span:
    """The place behind a span."""
    return Span(span.end_line, span.end_column, span.end_line, span.end_column)


#: How to mend what a rule found: words, the text that takes the place of the element, or what does it elsewhere.
Hint: TypeAlias = "str | Repair | Insertion | Replacement | Wrapping"


@dataclass(frozen=True)
class Finding:
    """What a rule found at an element of the model; the text of a `Repair` takes the element's place.

    `relies_on` is an element that must be free of syntax errors for the finding to be true: what is concluded from
    something being absent. `relies_on_names` are the classes whose own names must be resolved within it, too.
    `related` is another element that the message speaks of.
    """

    element: ex.Located
    message: str
    hint: Hint
    relies_on: ex.Located | None = None
    relies_on_names: tuple[type[ex.Located], ...] = ()
    related: ex.Located | None = None

    def said(self) -> tuple[str, tuple[Edit, ...], bool]:
        """The hint, the edits that do what it says in the file of the element, and whether a person is to choose."""
        match self.hint:
            case Repair(said, None) | str(said):
                return said, (), False
            case Repair(said, text):
                return said, (Edit(place(self.element)[1], str(text)),), False
            case Insertion() | Replacement() | Wrapping() as change:
                if place(change.element)[0] != place(self.element)[0]:
                    return change.hint, (), False
                return change.hint, change.edits(), change.is_choice
        raise TypeError(self.hint)

    def places(self) -> tuple[Related, ...]:
        """Where the other element that it speaks of stands."""
        if self.related is None or self.related.source is None:
            return ()
        return (Related(*place(self.related), "this is what the finding speaks of"),)

    def can_be_false(self, findings: Sequence[Diagnostic]) -> bool:
        """Whether what reading the text found makes it doubtful."""
        if isinstance(self.element, ex.Expression):
            expression = place(self.element)[1]
            if any(finding.rule == "syntax" and _goes_on(expression, finding.span) for finding in findings):
                return True
        if self.relies_on is None:
            return False
        span = place(self.relies_on)[1]
        within = [finding for finding in findings if span.contains(finding.span)]
        return any(
            finding.rule == "syntax" or isinstance(_innermost(self.relies_on, finding.span), self.relies_on_names)
            for finding in within
        )


def on_line(element: ex.Located) -> str:
    """` (line 12)`, or nothing where the element comes from no text."""
    return f" (line {element.source.span.line})" if element.source else ""


def _goes_on(expression: Span, skipped: Span) -> bool:
    """Whether text that can't be read may belong to an expression, as the point of `1.` does and the `3` of `2 3`."""
    behind = expression.end_line == skipped.line and 0 <= skipped.column - expression.end_column <= 1
    return behind or expression.contains(skipped)


def _innermost(element: ex.Located, span: Span) -> ex.Located:
    """The smallest part of an element that holds a place in the text."""
    *_, found = (part for _, part in tree(element) if place(part)[1].contains(span))
    assert isinstance(found, ex.Located)
    return found


Check: TypeAlias = "Callable[[rsc.Base], Iterator[Finding]]"
InterfaceCheck: TypeAlias = "Callable[[rsc.Base, RosTypes], Iterator[Finding]]"


@dataclass(frozen=True)
class Rule:
    """A rule: its identifier, its severity, and what looks for breaches of it in one robot or library."""

    id: str
    severity: Severity
    check: InterfaceCheck


#: All rules by identifier, once their modules are imported.
RULES: dict[str, Rule] = {}


def rule(identifier: str, severity: Severity = Severity.ERROR) -> Callable[[Check], Check]:
    """Registers a function as the check of a rule; the rule's page is `docs/rules/<identifier>.md`.

    The function is called with a robot or a library, partly linked perhaps, and yields the findings in it; libraries
    that it imports are checked by themselves.
    """

    def register(check: Check) -> Check:
        interface_rule(identifier, severity)(lambda base, _: check(base))
        return check

    return register


def interface_rule(identifier: str, severity: Severity = Severity.ERROR) -> Callable[[InterfaceCheck], InterfaceCheck]:
    """As `rule`, for a function that is also called with what ROS knows of its types."""

    def register(check: InterfaceCheck) -> InterfaceCheck:
        assert identifier not in RULES, f"two checks for the rule {identifier}"
        RULES[identifier] = Rule(identifier, severity, check)
        return check

    return register
