"""Models that the C engine rejects, with positions; the rule's page lists them correctly."""

import re
from pathlib import Path

import pytest

from robosc.base.diagnostics.rules import page
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_sct
from robosc.m2t.c.preconditions import preconditions
from robosc.synthesis import synthesize


@pytest.mark.parametrize(("heading", "lines"), [("Wrong", {14}), ("Right", set())])
def test_the_page_of_the_rule(heading: str, lines: set[int], tmp_path: Path) -> None:
    text = page("c-overflow")
    assert text is not None
    found = re.search(rf"^## {heading}\n\n```robosc\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert found
    (tmp_path / "model.rscd").write_text(found.group(1))
    robot = read(tmp_path / "model.rscd").base
    assert check(robot) == []
    model, _ = robosc_to_sct.transform(robot)
    model.supervisor = synthesize(model).supervisor
    assert {precondition.span.line for precondition in preconditions(model)} == lines
