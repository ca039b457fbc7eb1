"""Rendering of results as JUnit XML, the test results that continuous integration reads."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from robosc.base.diagnostics.visible import visible, visible_lines

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


@dataclass(frozen=True)
class Failure:
    """Failure of a test case: a sentence, its kind, and the details as lines."""

    message: str
    kind: str
    details: str


@dataclass(frozen=True)
class TestCase:
    """Test case of a suite in a file, maybe at a line. `skipped` is the reason, None if the case was examined."""

    suite: str
    name: str
    file: str
    seconds: float
    line: int | None = None
    failure: Failure | None = None
    skipped: str | None = None
    output: str | None = None
    properties: Sequence[tuple[str, str]] = ()


def render(tool: str, cases: Sequence[TestCase]) -> str:
    """Return JUnit XML with the results of a tool. The cases of a suite follow each other.

    The attributes and elements are those that Jenkins, GitLab and GitHub's test reporters share
    (https://github.com/testmoapp/junitxml).
    """
    root = Element("testsuites", {"name": tool, **_numbers(cases)})
    for name, several in groupby(cases, attrgetter("suite")):
        group = list(several)
        suite = SubElement(root, "testsuite", {"name": visible(name), **_numbers(group)})
        for case in group:
            _add(suite, case)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _numbers(cases: Sequence[TestCase]) -> Mapping[str, str]:
    return {
        "tests": str(len(cases)),
        "failures": str(sum(case.failure is not None for case in cases)),
        "errors": "0",
        "skipped": str(sum(case.skipped is not None for case in cases)),
        "time": _seconds(sum(case.seconds for case in cases)),
    }


def _add(suite: Element, case: TestCase) -> None:
    attributes = {"name": visible(case.name), "classname": visible(case.suite), "file": visible(case.file)}
    attributes |= {} if case.line is None else {"line": str(case.line)}
    element = SubElement(suite, "testcase", {**attributes, "time": _seconds(case.seconds)})
    if case.properties:
        properties = SubElement(element, "properties")
        for key, value in case.properties:
            SubElement(properties, "property", {"name": key, "value": visible(value)})
    if case.failure is not None:
        attributes = {"message": visible(case.failure.message), "type": case.failure.kind}
        SubElement(element, "failure", attributes).text = visible_lines(case.failure.details)
    elif case.skipped is not None:
        SubElement(element, "skipped", {"message": visible(case.skipped)})
    if case.output is not None:
        SubElement(element, "system-out").text = visible(case.output)


def _seconds(seconds: float) -> str:
    return f"{seconds:.3f}"
