"""No broken text makes an answer fail, and edited texts equal those of a fresh server."""

from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.language.text import Text
from robosc.tools.editor.findings import findings_by_path
from robosc.tools.editor.project import Project
from robosc.tools.editor.reading import hover
from robosc.tools.editor.server import ANSWERS
from robosc.tools.editor.synthesis import communication_at, question
from tests.tools.editor.server import ROOT

URI = "file:///nowhere/model.rscd"
LIBRARY_URI = "file:///nowhere/wheels.rscd"
SMALL = """robot R { // 🤖
  library_ constant a: double = 0.5 component C from Wheels import Motors with { drive: "/x" }
  component T(n: integer(1..3)) { outgoing message m with type: A(0.1) behaviour { variable v: A
    initial marked state s { on response from m if v = near do v := value goto s after 1 s goto s } } }
  component I is T(n: 2) datatype enum A(l: double) from std_msgs/Bool to { value.data -> near default -> far }
  requirement Q "t": drive needs I.v = near and (all T: T.s) => !false provide drive with { x: [1.0], y: abs(a) }
}
"""
TINY = """robot R { component C { outgoing message m with type: double behaviour {
  initial state s { on response from m if value > 1.0 goto s } } } requirement go needs C.s }
"""
WHEELS = """library Wheels { component Motors { incoming message drive with type: double
  behaviour { initial marked state idle { on request to drive goto idle } } } }"""
#: The guards hold no construct that the other examples lack.
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*.rscd") if "guards" not in path.parts)


def project(text: str) -> Project:
    made = Project()
    made.put(LIBRARY_URI, 1, WHEELS)
    made.put(URI, 1, text)
    return made


def parameters(method: str, text: Text, offset: int, uri: str = URI) -> object:
    """Return the parameters of an editor's request at an offset."""
    position = types.Position(*text.to_utf16(offset))
    place = types.Range(position, types.Position(*text.to_utf16(offset + 40)))
    made = types.METHOD_TO_TYPES[method][2]
    known = {
        "text_document": types.TextDocumentIdentifier(uri),
        "position": position,
        "positions": [position],
        "range": place,
        "new_name": "renamed",
        "options": types.FormattingOptions(2, insert_spaces=True),
        "query": "",
    }
    if method == types.TEXT_DOCUMENT_REFERENCES:
        known["context"] = types.ReferenceContext(include_declaration=True)
    elif method in {types.CALL_HIERARCHY_INCOMING_CALLS, types.CALL_HIERARCHY_OUTGOING_CALLS}:
        known["item"] = types.CallHierarchyItem("s", types.SymbolKind.EnumMember, uri, place, place)
    elif method == types.TEXT_DOCUMENT_CODE_ACTION:
        known["context"] = types.CodeActionContext([])
    names = {attribute.name for attribute in made.__attrs_attrs__}
    return made(**{name: value for name, value in known.items() if name in names})


def ask_everything(made: Project, text: str, offset: int) -> None:
    made.put(URI, 2, text)
    snapshot = made.snapshot()
    analysis = snapshot.analysis(made.path(URI))
    findings_by_path(snapshot, [analysis])
    hover(snapshot, analysis, parameters(types.TEXT_DOCUMENT_HOVER, analysis.text, offset))
    question(snapshot, analysis)
    communication_at(analysis, offset)
    for method, job in ANSWERS.items():
        if method == types.TEXT_DOCUMENT_RENAME:
            continue  # An invalid rename is an error: tests/tools/editor/test_renaming.py checks this.
        # Directly after the last letter, and sometimes before it.
        for where in {offset, max(0, offset - (offset % 7 == 0))}:
            # An error is a valid answer: a name of a library cannot be changed here.
            with suppress(*[JsonRpcException] if method == types.TEXT_DOCUMENT_PREPARE_RENAME else []):
                job(snapshot, analysis, parameters(method, analysis.text, where))


@pytest.mark.slow
def test_a_small_text_cut_off_anywhere() -> None:
    made = project(TINY)
    for end in range(len(TINY) + 1):
        ask_everything(made, TINY[:end], end)


def test_a_first_line_with_a_fault_anywhere() -> None:
    made = project(TINY)
    for at in range(TINY.index("{") + 1):
        for piece in ("{", " "):
            ask_everything(made, TINY[:at] + piece + TINY[at:], at)


@pytest.mark.slow
def test_a_text_of_many_constructs_cut_off() -> None:
    made = project(SMALL)
    for end in range(0, len(SMALL) + 1, 19):
        ask_everything(made, SMALL[:end], end)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_cut_off(path: Path) -> None:
    text = path.read_text()
    for end in (len(text) // 3, len(text) * 7 // 10):
        ask_everything(project(text), text[:end], end)


@st.composite
def edits(draw: st.DrawFn) -> tuple[int, int, str]:
    start, length = draw(st.integers(0, 700)), draw(st.integers(0, 12))
    pieces = ["{", "}", "\r\n", "\r", "\n", "🤖", "state ", "A.", "1.", '"', "/*", "\u2028", "value", "\x0b", " ", ""]
    return start, length, draw(st.sampled_from(pieces))


@pytest.mark.slow
@settings(max_examples=15)
@given(st.lists(edits(), min_size=1, max_size=6))
def test_edits_one_by_one_are_the_text_as_a_whole(changes: list[tuple[int, int, str]]) -> None:
    """Positions follow the protocol: its line breaks, and columns in UTF-16 units."""
    text, edited = SMALL, project(SMALL)
    for version, (first, length, piece) in enumerate(changes, start=2):
        start, end = min(first, len(text)), min(first + length, len(text))
        # No position is between the two characters of a line break.
        start -= text[start - 1 : start + 1] == "\r\n"
        end += text[end - 1 : end + 1] == "\r\n"
        edited.change(URI, version, [((*place(text, start), *place(text, end)), piece)])
        text = text[:start] + piece + text[end:]
        edited.snapshot().analysis(edited.path(URI))
    fresh = project(text)
    now, then = (made.snapshot() for made in (edited, fresh))
    assert now.documents[edited.path(URI)].content == text
    seen, expected = (snapshot.analysis(edited.path(URI)) for snapshot in (now, then))
    assert seen.findings == expected.findings
    assert seen.text.content == expected.text.content
    assert names(seen) == names(expected)
    assert findings_by_path(now, [seen]) == findings_by_path(then, [expected])
    for method in (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, types.TEXT_DOCUMENT_DOCUMENT_SYMBOL):
        asked = parameters(method, seen.text, 0)
        assert ANSWERS[method](now, seen, asked) == ANSWERS[method](then, expected, asked)


def names(analysis: object) -> list[object]:
    return [(name.name, name.start, analysis.key(name.target)) for name in analysis.file.names]


def place(text: str, offset: int) -> tuple[int, int]:
    before = text[:offset].replace("\r\n", "\n").replace("\r", "\n")
    return before.count("\n"), len(before.rsplit("\n", 1)[-1].encode("utf-16-le")) // 2


def test_a_library_that_changes_is_read_again() -> None:
    made = project(SMALL.replace("library_ ", ""))
    path = made.path(URI)
    assert not [found for found in made.snapshot().analysis(path).findings if "Motors" in found.message]
    for text, message in [
        (WHEELS.replace("Motors", "M"), "library `Wheels` has no component `Motors`"),
        (WHEELS.replace("Wheels", "Rims"), "there is no library `Wheels`"),
    ]:
        made.change(LIBRARY_URI, 2, [(None, text)])
        assert message in [found.message for found in made.snapshot().analysis(path).findings]
    made.close(LIBRARY_URI)
    assert "there is no library `Wheels`" in [found.message for found in made.snapshot().analysis(path).findings]


def test_an_analysis_is_kept_until_what_it_read_changes() -> None:
    made = project(SMALL)
    path = made.path(URI)
    first = made.snapshot().analysis(path)
    other = made.put("file:///nowhere/other.rscd", 1, "robot Other {}")
    kept = made.snapshot().analysis(path)
    made.change("file:///nowhere/other.rscd", 2, [(None, "robot Another {}")])
    assert made.snapshot().analysis(path) is kept
    assert made.snapshot().analysis(other).reading.base.name == "Another"
    made.change(URI, 2, [((0, 6, 0, 7), "Robot")])
    assert made.snapshot().analysis(path) is not kept
    assert [found.message for found in first.findings] == [found.message for found in kept.findings]


@pytest.mark.parametrize("method", [types.CALL_HIERARCHY_INCOMING_CALLS, types.CALL_HIERARCHY_OUTGOING_CALLS])
def test_who_calls_a_state_is_asked_where_it_is_declared(method: str) -> None:
    """A text that only names the state of its library has no item: an item would be of an older text."""
    robot = "robot R { component C from Wheels import Motors requirement drive needs C.idle }"
    made = project(robot)
    for uri, text, calls in [(URI, robot, 0), (LIBRARY_URI, WHEELS, 1)]:
        snapshot = made.snapshot()
        analysis = snapshot.analysis(made.path(uri))
        at = text.index("C.idle") + 2 if uri == URI else text.index("idle {")
        assert analysis.file.name_at(at).target.name == "idle"
        incoming = method == types.CALL_HIERARCHY_INCOMING_CALLS
        assert len(ANSWERS[method](snapshot, analysis, parameters(method, analysis.text, at, uri))) == calls * incoming


def test_selections_lie_within_each_other() -> None:
    made = project(SMALL)
    snapshot = made.snapshot()
    analysis = snapshot.analysis(made.path(URI))
    method = types.TEXT_DOCUMENT_SELECTION_RANGE
    for offset in range(len(SMALL)):
        (selection,) = ANSWERS[method](snapshot, analysis, parameters(method, analysis.text, offset))
        ranges = []
        while selection is not None:
            ranges.append((selection.range.start, selection.range.end))
            selection = selection.parent
        assert all(outer[0] <= inner[0] <= inner[1] <= outer[1] for inner, outer in pairwise(ranges))
