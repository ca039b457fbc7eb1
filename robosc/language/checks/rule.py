"""Rules, their findings, and the register of all rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from robosc.base.diagnostics import Alternative, Edit, Related, Repair, Severity, Span
from robosc.language.checks.edits import Choice, Replacement, changed_file
from robosc.model import expression as ex
from robosc.model.places import place
from robosc.model.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosTypes
    from robosc.language.checks.edits import Hint, Way
    from robosc.model import robosc as rsc


@dataclass(frozen=True)
class Finding:
    """Violation of a rule at an element of the model; the text of a `Repair` replaces the element.

    `relies_on` is an element that must be free of syntax errors for the finding to be true, because the finding reports
    an absence. `relies_on_names` are the classes whose own names must be resolved within it, too. `related` is another
    element that the message refers to.
    """

    element: ex.Located
    message: str
    hint: Hint
    relies_on: ex.Located | None = None
    relies_on_names: tuple[type[ex.Located], ...] = ()
    related: ex.Located | None = None

    def fixes(self) -> tuple[str, tuple[Edit, ...], tuple[Alternative, ...]]:
        """Return the hint, and its edits in the file of the element or the alternatives to choose from."""
        match self.hint:
            case Repair(text_of_hint, None) | str(text_of_hint):
                return text_of_hint, (), ()
            case Repair(text_of_hint, text):
                return text_of_hint, Replacement(text_of_hint, str(text), self.element).edits(), ()
            case Choice(text_of_hint, ways):
                return text_of_hint, (), self._alternatives(ways)
        if self.hint.is_choice:
            return self.hint.hint, (), self._alternatives((self.hint,))
        return self.hint.hint, self._edits(self.hint), ()

    def _alternatives(self, ways: Iterable[Way]) -> tuple[Alternative, ...]:
        alternatives = (Alternative(way.hint, self._edits(way)) for way in ways)
        return tuple(way for way in alternatives if way.edits)

    def _edits(self, way: Way) -> tuple[Edit, ...]:
        """Return the edits of a way in the file of the element; none if it changes another file."""
        return way.edits() if changed_file(way) == place(self.element)[0] else ()

    def places(self) -> tuple[Related, ...]:
        """Return the place of the related element, if any."""
        if self.related is None or self.related.source is None:
            return ()
        return (Related(*place(self.related), "the finding is about this element"),)

    def can_be_false(self, findings: Sequence[Diagnostic]) -> bool:
        """Return whether an unreadable or unresolved part of the text may have caused the finding."""
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
    """Return ` (line 12)`, or an empty text if the element comes from no text."""
    return f" (line {element.source.span.line})" if element.source else ""


def _goes_on(expression: Span, skipped: Span) -> bool:
    """Return whether unreadable text may belong to an expression, such as the point of `1.` or the `3` of `2 3`."""
    behind = expression.end_line == skipped.line and 0 <= skipped.column - expression.end_column <= 1
    return behind or expression.contains(skipped)


def _innermost(element: ex.Located, span: Span) -> ex.Located:
    """Return the smallest part of an element that contains a place in the text."""
    *_, innermost = (part for _, part in tree(element) if place(part)[1].contains(span))
    assert isinstance(innermost, ex.Located)
    return innermost


Check: TypeAlias = "Callable[[rsc.Base], Iterator[Finding]]"
InterfaceCheck: TypeAlias = "Callable[[rsc.Base, RosTypes], Iterator[Finding]]"


@dataclass(frozen=True)
class CheckRule:
    """A rule: its identifier, its severity, and a function that yields its violations in one robot or library."""

    id: str
    severity: Severity
    check: InterfaceCheck


#: All rules by identifier, once their modules are imported.
RULES: dict[str, CheckRule] = {}


def rule(identifier: str, severity: Severity = Severity.ERROR) -> Callable[[Check], Check]:
    """Register a function as the check of a rule; the rule's page is `docs/rules/<identifier>.md`.

    The function takes a robot or a library, which may have unresolved names, and yields the findings in it. Imported
    libraries are checked separately.
    """

    def register(check: Check) -> Check:
        interface_rule(identifier, severity)(lambda base, _: check(base))
        return check

    return register


def interface_rule(identifier: str, severity: Severity = Severity.ERROR) -> Callable[[InterfaceCheck], InterfaceCheck]:
    """Register a function as `rule` does; the function also takes the known ROS types."""

    def register(check: InterfaceCheck) -> InterfaceCheck:
        assert identifier not in RULES, f"two checks for the rule {identifier}"
        RULES[identifier] = CheckRule(identifier, severity, check)
        return check

    return register
