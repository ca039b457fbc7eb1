"""In a large text, the definition being edited is checked first, and the whole text when typing pauses."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types

from benchmarks.editor import model
from robosc.base.diagnostics import Diagnostic
from robosc.tools.editor import project as projects
from robosc.tools.editor.findings import quickly
from robosc.tools.editor.project import Project
from tests.searching import examples
from tests.tools.editor.server import COMMAND, Editor, findings, initialize, of, open_text, position, replace
from tests.tools.editor.test_robustness import EXAMPLES, URI

TEXTS = [path.read_text() for path in EXAMPLES]
#: Rules of reading. Other rules may infer a fault from elements that a slice lacks.
READ = {"syntax", "unresolved-reference"}


@pytest.fixture(scope="module", autouse=True)
def _all_texts_are_large() -> object:
    known, projects.LARGE = projects.LARGE, 0
    yield
    projects.LARGE = known


def both(before: str, after: str) -> tuple[list[Diagnostic] | None, list[Diagnostic]]:
    """Return the quick findings after a change, if available, and the findings in the whole text."""
    made = Project()
    path = made.put(URI, 1, before)
    made.snapshot().analysis(path)
    made.put(URI, 2, after)
    quick = made.snapshot().quick_findings(path)
    return (None if quick is None else quick[2]), made.snapshot().analysis(path).findings


def read(found: list[Diagnostic]) -> list[object]:
    return [(finding.span, finding.rule, finding.message) for finding in found if finding.rule in READ]


@st.composite
def changes(draw: st.DrawFn) -> tuple[str, str]:
    text = draw(st.sampled_from(TEXTS))
    start = draw(st.integers(0, len(text)))
    pieces = ["x", " and ", "goto ", "0", "1.0", "value", ".", "\n", " ", "; ", "not ", "", "🤖", "// c\n"]
    return text, text[:start] + draw(st.sampled_from(pieces)) + text[start + draw(st.integers(0, 4)) :]


@pytest.mark.slow
@settings(max_examples=examples(20))
@given(changes())
def test_what_is_found_quickly_is_what_is_found(change: tuple[str, str]) -> None:
    quick, whole = both(*change)
    if quick is not None:
        assert read(quick) == read(whole)


@pytest.mark.parametrize(
    ("nth", "old", "new"),
    [
        (3, "seen := true", "sen := true"),
        (5, "goto open", "goto opn"),
        (0, "value > 0.5", "value > 1"),
        (2, "\n", "\n\n"),
    ],
)
def test_within_a_definition(nth: int, old: str, new: str) -> None:
    text = model(120)
    at = position(text, old, nth=nth)
    offset = sum(len(line) + 1 for line in text.split("\n")[: at.line]) + at.character
    quick, whole = both(text, text[:offset] + new + text[offset + len(old) :])
    assert quick == whole


def test_findings_elsewhere_move_with_their_lines() -> None:
    text = model(120).replace("Door7.open and", "Door7.opn and")
    quick, whole = both(text, text.replace("seen := true", "seen := true\n\n", 1))
    assert quick == whole
    assert [finding.rule for finding in whole] == ["unresolved-reference"]


def test_names_that_others_use_are_missed_at_once() -> None:
    text = model(120)
    quick, whole = both(text, text.replace("component Door3 {", "component Dor3 {"))
    assert quick == whole
    assert {finding.message for finding in whole} == {"there is no component or variable `Door3`"}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("component Door3 {", "component Door3"),  # the rest then belongs to another component
        ("robot Doors", "robot Dors"),
        ("  component Door3 {", "  /* component Door3 {"),
    ],
)
def test_what_is_not_of_one_definition_is_read_in_whole(old: str, new: str) -> None:
    quick, whole = both(model(120), model(120).replace(old, new))
    assert quick is None or read(quick) == read(whole)


def test_only_large_texts() -> None:
    projects.LARGE = 400
    made = Project()
    path = made.put(URI, 1, model(120))
    made.snapshot().analysis(path)
    made.put(URI, 2, model(120).replace("Door3.open", "Door3.opn"))
    assert quickly(made.snapshot(), path) is None
    projects.LARGE = 0
    assert [found.code for found in quickly(made.snapshot(), path)] == ["unresolved-reference"]


@pytest.mark.slow
@pytest.mark.asyncio
async def test_over_the_protocol(tmp_path: Path) -> None:
    text = model(480)
    client = Editor()
    await client.start_io(*COMMAND)
    await initialize(client, tmp_path)
    uri = open_text(client, tmp_path / "doors.rscd", text)
    assert await findings(client, uri, 1) == []
    at = position(text, "state open", 6, nth=8)
    replace(client, uri, 2, (types.Range(at, types.Position(at.line, at.character + 4)), "ajar"))
    # In the component itself and in the requirements that name it.
    first = await findings(client, uri, 2)
    assert len(first) == 2
    assert {(found.code, of(text, found.range)) for found in first} == {("unresolved-reference", "open")}
    replace(client, uri, 3, (types.Range(at, types.Position(at.line, at.character + 4)), "open"))
    assert await findings(client, uri, 3) == []
    await client.shutdown_session()
    await client.stop()
