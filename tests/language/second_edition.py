"""Robots of the language's second edition, from their text to the events that the supervisor permits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import robosc
from robosc.base.diagnostics import ModelError, Severity
from robosc.engine import Engine

if TYPE_CHECKING:
    from robosc.model import sct


def errors(text: str) -> list[tuple[str, int]]:
    """Return the errors in a robot's text: rule and line, in order."""
    try:
        found = robosc.check(robosc.load(text=text))
    except ModelError as error:
        found = list(error.diagnostics)
    return [(finding.rule, finding.span.line) for finding in found if finding.severity is Severity.ERROR]


def supervised(text: str) -> sct.SupervisoryControlModel:
    """Return the sct model of a robot without errors, with its supervisor."""
    assert errors(text) == []
    model = robosc.to_sct(robosc.load(text=text))
    robosc.synthesize(model)
    return model


def running(text: str) -> Engine:
    """Return a robot without errors in its initial state."""
    return Engine(supervised(text))


def requirements(text: str) -> list[str | None]:
    """Return the text of its requirements for readers."""
    return [requirement.text for requirement in supervised(text).requirements]
