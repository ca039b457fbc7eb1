"""Verdicts as JUnit XML, the form of test results that continuous integration reads: a property is a test case.

The attributes and elements are those that Jenkins, GitLab and GitHub's test reporters have in common
(https://github.com/testmoapp/junitxml).
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from robosc.analysis.verification.as_text import details
from robosc.analysis.verification.verdict import Outcome
from robosc.diagnostics.visible import visible, visible_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.verification.verdict import Verdict
    from robosc.metamodel import sct


def render(model: sct.SupervisoryControlModel, verdicts: Sequence[Verdict], file: str) -> str:
    """A test suite for the robot, whose model stands in `file`; what is refuted failed, with its trace as the text."""
    numbers = {
        "tests": str(len(verdicts)),
        "failures": str(_count(verdicts, Outcome.REFUTED)),
        "errors": "0",
        "skipped": str(_count(verdicts, Outcome.SKIPPED)),
        "time": _seconds(sum(each.seconds for each in verdicts)),
    }
    root = Element("testsuites", {"name": "robosc verify", **numbers})
    suite = SubElement(root, "testsuite", {"name": model.name, **numbers})
    for verdict in verdicts:
        case = SubElement(
            suite,
            "testcase",
            {
                "name": verdict.property,
                "classname": model.name,
                "file": visible(file),
                "time": _seconds(verdict.seconds),
            },
        )
        if verdict.outcome is Outcome.REFUTED:
            failure = SubElement(
                case, "failure", {"message": visible(verdict.explanation), "type": verdict.outcome.value}
            )
            failure.text = visible_lines(details(verdict, model))
        elif verdict.outcome is Outcome.SKIPPED:
            SubElement(case, "skipped", {"message": visible(verdict.explanation)})
        SubElement(case, "system-out").text = visible(verdict.evidence)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _count(verdicts: Sequence[Verdict], outcome: Outcome) -> int:
    return sum(each.outcome is outcome for each in verdicts)


def _seconds(seconds: float) -> str:
    return f"{seconds:.3f}"
