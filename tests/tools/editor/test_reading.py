"""The server reports the content and the faults of a text: over the protocol, in a separate process."""

import asyncio
from itertools import pairwise
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.tools.editor.colours import LEGEND
from robosc.tools.editor.findings import ADD_LIBRARY_FOLDER
from tests.tools.editor.server import (
    CONFIG,
    LIBRARY,
    ROBOT,
    Editor,
    at,
    close,
    findings,
    initialize,
    of,
    open_text,
    position,
    replace,
)

pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("robots")
    (made / "wheels.rscd").write_text(LIBRARY)
    return made


@pytest_lsp.fixture(config=CONFIG, scope="module")
async def client(lsp_client: Editor, folder: Path):
    await initialize(lsp_client, folder)
    yield
    await lsp_client.shutdown_session()


async def opened(client: Editor, path: Path, text: str) -> tuple[str, list[types.Diagnostic]]:
    uri = open_text(client, path, text)
    return uri, await findings(client, uri, 1)


async def test_findings_come_and_go_with_the_text(client: Editor, folder: Path) -> None:
    uri, found = await opened(client, folder / "findings.rscd", ROBOT.replace("Door.open", "Door.opem"))
    (finding,) = found
    assert finding.code == "unresolved-reference"
    assert finding.message == "component `Door` has no variable or state `opem`\nhint: did you mean `open`?"
    assert finding.severity is types.DiagnosticSeverity.Error
    assert finding.code_description.href.endswith("/docs/rules/unresolved-reference.md")
    start = position(ROBOT, "Door.open", 5)
    assert finding.range == types.Range(start, types.Position(start.line, start.character + 4))
    replace(client, uri, 2, (finding.range, "open"))
    assert await findings(client, uri, 2) == []
    close(client, uri)


async def test_the_other_place_of_a_finding_is_told(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("state open {", "state closed {")
    uri, found = await opened(client, folder / "related.rscd", text)
    (again,) = [finding for finding in found if finding.code == "unique-state"]
    assert again.range.start == position(text, "state closed", nth=1)
    (other,) = again.related_information
    assert (other.location.uri, other.location.range.start) == (uri, position(text, "initial marked state closed"))
    close(client, uri)


async def test_an_unsaved_library_counts(client: Editor, folder: Path) -> None:
    uri, found = await opened(client, folder / "user.rscd", ROBOT)
    assert found == []
    library = open_text(client, folder / "wheels.rscd", LIBRARY.replace("Motors", "Engines"))
    (finding,) = await findings(client, uri, 1)
    assert finding.message.startswith("library `Wheels` has no component `Motors`")
    replace(client, library, 2, LIBRARY.replace("double", "number"))
    assert [finding.code for finding in await findings(client, library, 2)] == ["unresolved-reference"] * 2
    close(client, library)
    assert await findings(client, library, None) == []
    close(client, uri)


async def test_findings_of_a_library_that_is_not_open(client: Editor, folder: Path) -> None:
    (folder / "broken.rscd").write_text(LIBRARY.replace("Wheels", "Broken").replace("goto still", "goto stil"))
    uri = open_text(client, folder / "of_broken.rscd", ROBOT.replace("Wheels", "Broken"))
    (finding,) = await findings(client, (folder / "broken.rscd").as_uri(), None)
    assert finding.message.endswith("did you mean `still`?")
    (folder / "broken.rscd").write_text(LIBRARY.replace("Wheels", "Broken"))
    client.text_document_did_save(types.DidSaveTextDocumentParams(types.TextDocumentIdentifier(uri)))
    assert await findings(client, (folder / "broken.rscd").as_uri(), None) == []
    close(client, uri)


async def test_positions_count_units_of_utf16(client: Editor, folder: Path) -> None:
    text = (
        'robot Cart {\n  /* 🤖🚪é */ component Door { outgoing message open with identifier: "🚪", type: bolean }\n}\n'
    )
    uri, (finding,) = await opened(client, folder / "units.rscd", text)
    assert finding.range == types.Range(position(text, "bolean"), position(text, "bolean", 6))
    at_robot = types.Range(position(text, "🤖"), position(text, "🤖", 2))
    replace(client, uri, 2, (at_robot, "🛒🛒🛒"), (finding.range, "none"))
    changed = text.replace("🤖🚪", "🛒🛒🛒").replace("bolean", "none")
    # The second range is relative to the text after the first change, which made the line two units longer.
    (finding, *_) = await findings(client, uri, 2)
    assert finding.code == "syntax"
    replace(client, uri, 3, changed)
    assert await findings(client, uri, 3) == []
    (door,) = (await client.text_document_document_symbol_async(_about(uri, types.DocumentSymbolParams)))[0].children
    assert of(changed, door.selection_range) == "Door"
    close(client, uri)


def _about(uri: str, made: type, **more: object):
    return made(text_document=types.TextDocumentIdentifier(uri), **more)


async def test_symbols(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "symbols.rscd", ROBOT)
    (robot,) = await client.text_document_document_symbol_async(_about(uri, types.DocumentSymbolParams))
    assert (robot.name, robot.kind) == ("Cart", types.SymbolKind.Module)
    assert [child.name for child in robot.children] == ["Base", "Door", "R1", "provide drive with 0.5"]
    behaviour = robot.children[1].children[1]
    assert [(state.name, of(ROBOT, state.selection_range)) for state in behaviour.children] == [
        ("closed", "closed"),
        ("open", "open"),
    ]
    assert of(ROBOT, behaviour.children[1].range).startswith("state open {")
    close(client, uri)


async def test_symbols_of_a_broken_text(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "half.rscd", ROBOT.replace("Door.open", ""))
    (robot,) = await client.text_document_document_symbol_async(_about(uri, types.DocumentSymbolParams))
    assert [child.name for child in robot.children] == ["Base", "Door", "provide drive with 0.5"]
    close(client, uri)


async def test_the_editor_is_asked_to_watch_files(client: Editor) -> None:
    (asked,) = client.watched
    assert asked.method == types.WORKSPACE_DID_CHANGE_WATCHED_FILES


async def test_workspace_symbols(client: Editor) -> None:
    found = await client.workspace_symbol_async(types.WorkspaceSymbolParams("rolng"))
    assert ("rolling", "behaviour") in {(symbol.name, symbol.container_name) for symbol in found}


async def test_folding(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("  // Where", "  // Doors.\n  // Where")
    uri, _ = await opened(client, folder / "folding.rscd", text)
    found = await client.text_document_folding_range_async(_about(uri, types.FoldingRangeParams))
    lines = text.split("\n")
    assert {lines[fold.start_line].strip() for fold in found} == {
        "robot Cart {",
        "// Doors.",
        "component Door {",
        "behaviour {",
        "initial marked state closed {",
        "state open {",
    }
    assert all(lines[fold.end_line + 1].strip() == "}" for fold in found if fold.kind != types.FoldingRangeKind.Comment)
    close(client, uri)


async def test_selection_grows(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "selection.rscd", ROBOT)
    where = [position(ROBOT, "Door.open", 7)]
    (selection,) = await client.text_document_selection_range_async(
        _about(uri, types.SelectionRangeParams, positions=where)
    )
    texts = []
    while selection is not None:
        texts.append(of(ROBOT, selection.range))
        selection = selection.parent
    assert texts[:3] == ["open", "Door.open", 'requirement R1 "only through an open door": drive needs Door.open']
    assert texts[-1] == ROBOT
    assert all(inner in outer for inner, outer in pairwise(texts))
    close(client, uri)


@pytest.mark.parametrize(
    ("marker", "into", "said"),
    [
        ("goto open", 6, "State of `Door`."),
        ("goto open", 6, "- response from opened → `closed`"),
        ("goto closed", 6, "Initial and marked state of `Door`"),
        ("goto closed", 6, "- response from opened, from `open`"),
        ("Door.open", 1, "Where the cart may go."),
        ("drive needs", 1, "Message to the robot's nodes"),
        ("drive needs", 1, "From library `Wheels`."),
        ("drive needs", 1, '- `requirement R1 "only through an open door": drive needs Door.open`, line 15'),
        ("R1", 1, "The supervisor lets `drive` start only while `Door.open` holds."),
        ("Motors", 1, "component Motors {"),
    ],
)
async def test_hover(client: Editor, folder: Path, marker: str, into: int, said: str) -> None:
    uri, _ = await opened(client, folder / "hover.rscd", ROBOT)
    hover = await client.text_document_hover_async(types.HoverParams(**at(uri, position(ROBOT, marker, into))))
    assert said in hover.contents.value
    assert of(ROBOT, hover.range) in marker
    close(client, uri)


async def test_hover_shows_what_ros_defines(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("type: boolean", "type: std_msgs/Bool").replace("value", "value.data")
    uri, _ = await opened(client, folder / "ros.rscd", text)
    hover = await client.text_document_hover_async(types.HoverParams(**at(uri, position(text, "std_msgs", 2))))
    assert "bool data" in hover.contents.value
    hover = await client.text_document_hover_async(types.HoverParams(**at(uri, position(text, ".data", 2))))
    assert hover.contents.value.startswith("```robosc\ndata: boolean\n```")
    close(client, uri)


async def test_definition_leads_into_libraries(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "definition.rscd", ROBOT)
    for marker, name in [("drive needs", "drive"), ("Motors", "Motors"), ("Wheels", "Wheels")]:
        where = position(ROBOT, marker, 1)
        (link,) = await client.text_document_definition_async(types.DefinitionParams(**at(uri, where)))
        assert link.target_uri == (folder / "wheels.rscd").as_uri()
        assert of(LIBRARY, link.target_selection_range) == name
    where = position(ROBOT, "goto open", 6)
    (link,) = await client.text_document_definition_async(types.DefinitionParams(**at(uri, where)))
    assert (link.target_uri, link.target_selection_range.start) == (uri, position(ROBOT, "open {"))
    nothing = types.DefinitionParams(**at(uri, position(ROBOT, "needs", 1)))
    assert await client.text_document_definition_async(nothing) == []
    close(client, uri)


async def test_references_are_found_in_all_files(client: Editor, folder: Path) -> None:
    (folder / "unopened.rscd").write_text(ROBOT.replace("Cart", "Other"))
    uri, _ = await opened(client, folder / "references.rscd", ROBOT)
    context = types.ReferenceContext(include_declaration=True)
    found = await client.text_document_references_async(
        types.ReferenceParams(**at(uri, position(ROBOT, "drive needs")), context=context)
    )
    by_file: dict[str, int] = {}
    for place in found:
        by_file[place.uri] = by_file.get(place.uri, 0) + 1
    assert by_file == {
        uri: 2,
        (folder / "unopened.rscd").as_uri(): 2,
        (folder / "wheels.rscd").as_uri(): 1,
    }
    here = await client.text_document_document_highlight_async(
        types.DocumentHighlightParams(**at(uri, position(ROBOT, "goto open", 6)))
    )
    assert [(of(ROBOT, other.range), other.kind) for other in here] == [
        ("open", types.DocumentHighlightKind.Read),
        ("open", types.DocumentHighlightKind.Write),
        ("open", types.DocumentHighlightKind.Read),
    ]
    close(client, uri)
    (folder / "unopened.rscd").unlink()


MESSY = ROBOT.replace("  component Door {", "component   Door{ // 🚪").replace("needs Door.open", "needs\n  Door.open")


def applied(text: str, edits: list[types.TextEdit]) -> str:
    lines = text.split("\n")
    starts = [sum(len(line) + 1 for line in lines[:index]) for index in range(len(lines))]
    for edit in reversed(edits):
        start, end = (starts[at.line] + at.character for at in (edit.range.start, edit.range.end))
        text = text[:start] + edit.new_text + text[end:]
    return text


async def test_formatting(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "formatting.rscd", MESSY)
    options = types.FormattingOptions(tab_size=8, insert_spaces=True)
    edits = await client.text_document_formatting_async(_about(uri, types.DocumentFormattingParams, options=options))
    assert applied(MESSY, edits) == format_text(Text("", MESSY))[0]
    assert all("Door.open" not in edit.new_text for edit in edits), "only what is between words changes"
    place = types.Range(position(MESSY, "requirement"), position(MESSY, "Door.open", 9))
    edits = await client.text_document_range_formatting_async(
        _about(uri, types.DocumentRangeFormattingParams, range=place, options=options)
    )
    assert applied(MESSY, edits) == MESSY.replace("needs\n  Door", "needs Door")
    replace(client, uri, 2, MESSY.replace("robot", "robt"))
    edits = await client.text_document_formatting_async(_about(uri, types.DocumentFormattingParams, options=options))
    assert not edits
    close(client, uri)


async def test_what_is_no_file_is_read_too(client: Editor) -> None:
    uri = "untitled:Untitled-1"
    told = types.TextDocumentItem(uri, "robosc", 1, ROBOT)
    client.text_document_did_open(types.DidOpenTextDocumentParams(told))
    assert await findings(client, uri, 1) == []
    close(client, uri)


async def test_no_text_no_answer(client: Editor, folder: Path) -> None:
    uri = (folder / "nowhere.rscd").as_uri()
    assert await client.text_document_hover_async(types.HoverParams(**at(uri, types.Position(0, 0)))) is None


async def test_semantic_tokens(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("// Where the cart may go.", "/* 🚪\n  two lines */")
    uri, _ = await opened(client, folder / "tokens.rscd", text)
    told = await client.text_document_semantic_tokens_full_async(_about(uri, types.SemanticTokensParams))
    legend = LEGEND.token_types
    words, line, unit = [], 0, 0
    for index in range(0, len(told.data), 5):
        down, right, length, kind, modifiers = told.data[index : index + 5]
        line, unit = line + down, right + (0 if down else unit)
        place = types.Range(types.Position(line, unit), types.Position(line, unit + length))
        words.append((of(text, place), legend[kind], modifiers))
    assert words[:8] == [
        ("robot", "keyword", 0),
        ("Cart", "namespace", 1),
        ("component", "keyword", 0),
        ("Base", "class", 1),
        ("from", "keyword", 0),
        ("Wheels", "namespace", 0),
        ("import", "keyword", 0),
        ("Motors", "class", 0),
    ]
    assert ("/* 🚪", "comment", 0) in words
    assert ("two lines */", "comment", 0) in [(word.strip(), kind, modifiers) for word, kind, modifiers in words]
    assert {word: kind for word, kind, _ in words if kind not in {"keyword", "comment"}} == {
        "Cart": "namespace",
        "Wheels": "namespace",
        "Base": "class",
        "Motors": "class",
        "Door": "class",
        "opened": "event",
        "drive": "event",
        "closed": "enumMember",
        "open": "enumMember",
        "R1": "property",
        '"/door"': "string",
        '"only through an open door"': "string",
        "0.5": "number",
        "boolean": "type",
        "!": "operator",
    }
    close(client, uri)


async def test_rename_over_the_protocol(client: Editor, folder: Path) -> None:
    uri, _ = await opened(client, folder / "rename.rscd", ROBOT)
    where = at(uri, position(ROBOT, "Door {"))
    ready = await client.text_document_prepare_rename_async(types.PrepareRenameParams(**where))
    assert ready.placeholder == "Door"
    answer = await client.text_document_rename_async(types.RenameParams(**where, new_name="Gate"))
    assert [edit.new_text for edit in answer.changes[uri]] == ["Gate", "Gate"]
    with pytest.raises(JsonRpcException, match="would change the meaning of rename"):
        await client.text_document_rename_async(types.RenameParams(**where, new_name="Base"))
    close(client, uri)


async def test_completion_over_the_protocol(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("drive needs Door.open", "drive needs Door.")
    uri, _ = await opened(client, folder / "completion.rscd", text)
    found = await client.text_document_completion_async(types.CompletionParams(**at(uri, position(text, "Door.", 5))))
    assert [item.label for item in found.items] == ["closed", "open"]
    close(client, uri)


async def test_a_request_that_is_overtaken_is_not_worked_on(client: Editor, folder: Path) -> None:
    """The change arrives before the request's turn: the answer would be about another text."""
    uri, _ = await opened(client, folder / "overtaken.rscd", ROBOT)
    asked = [
        asyncio.ensure_future(client.text_document_hover_async(types.HoverParams(**at(uri, position(ROBOT, "Door {")))))
        for _ in range(3)
    ]
    await asyncio.sleep(0)
    replace(client, uri, 2, ROBOT.replace("Door", "Gate"))
    answers = await asyncio.gather(*asked, return_exceptions=True)
    for answer in answers:
        said = answer.code if isinstance(answer, JsonRpcException) else answer.contents.value
        assert said == types.LSPErrorCodes.ContentModified or "component Door" in said
    later = await client.text_document_hover_async(types.HoverParams(**at(uri, position(ROBOT, "Door {"))))
    assert "component Gate" in later.contents.value
    close(client, uri)


async def test_inlay_hints(client: Editor, folder: Path) -> None:
    text = ROBOT.replace(
        "  requirement R1",
        """  function gain(d: double): double = d * 2.0
  component Lamp(ns: string) { incoming message lit with identifier: ns + "/lit", type: boolean }
  component Red is Lamp("/red")
  component Green is Lamp(ns: "/green")
  requirement R1""",
    ).replace("with 0.5", "with gain(0.5)")
    uri, found = await opened(client, folder / "hints.rscd", text)
    assert found == []
    whole = types.Range(types.Position(0, 0), types.Position(text.count("\n"), 0))
    hints = await client.text_document_inlay_hint_async(_about(uri, types.InlayHintParams, range=whole))
    assert [(hint.label, hint.position) for hint in hints] == [
        (": boolean", position(text, "value goto", 5)),
        (": boolean", position(text, "!value", 6)),
        ("ns:", position(text, '"/red"')),
        ("d:", position(text, "0.5")),
    ]
    close(client, uri)


async def test_units_of_what_ros_defines(client: Editor, folder: Path) -> None:
    text = """robot Rover {
  datatype object Battery { voltage: double percentage: double }
  datatype enum Power from Battery to { value.voltage > 11.0 -> full default -> low }
  interface battery use BatteryState from sensor_msgs
  component Sensors {
    outgoing message range with type: sensor_msgs/Range
    outgoing message power with type: Power links battery
    incoming message move with type: geometry_msgs/Twist
    behaviour {
      variable near: boolean = false
      initial marked state on { on response from range do near := value.range < 0.5 }
    }
  }
  provide move with { linear: if Sensors.near then { x: 0.2 } else { x: 0.3 }, angular: { z: -0.5 } }
}
"""
    uri, _ = await opened(client, folder / "units_of_ros.rscd", text)
    whole = types.Range(types.Position(0, 0), types.Position(text.count("\n"), 0))
    hints = await client.text_document_inlay_hint_async(_about(uri, types.InlayHintParams, range=whole))
    assert [(hint.label, hint.position) for hint in hints if hint.label.startswith(" ")] == [
        (" V", position(text, "value.voltage", 13)),
        (" m", position(text, "value.range", 11)),
        (" m/s", position(text, "0.2", 3)),
        (" m/s", position(text, "0.3", 3)),
        (" rad/s", position(text, "-0.5", 4)),
    ]
    close(client, uri)


async def test_signature_help_over_the_protocol(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("with 0.5", "with max(0.5, ")
    uri, _ = await opened(client, folder / "signature.rscd", text)
    asked = types.SignatureHelpParams(**at(uri, position(text, "max(0.5, ", 9)))
    found = await client.text_document_signature_help_async(asked)
    assert (found.signatures[0].label, found.active_parameter) == ("max(a, b)", 1)
    close(client, uri)


async def test_a_library_elsewhere_in_the_project_is_offered(client: Editor, folder: Path) -> None:
    (folder / "shared").mkdir()
    (folder / "shared" / "rims.rscd").write_text(LIBRARY.replace("Wheels", "Rims"))
    text = ROBOT.replace("Wheels", "Rims")
    uri, found = await opened(client, folder / "elsewhere.rscd", text)
    (finding,) = [finding for finding in found if "there is no library" in finding.message]
    (action,) = await client.text_document_code_action_async(
        _about(uri, types.CodeActionParams, range=finding.range, context=types.CodeActionContext([finding]))
    )
    assert action.title == f"also search libraries in {folder / 'shared'}"
    # The client mistakes a code action with a command for a command.
    command = types.ExecuteCommandParams(ADD_LIBRARY_FOLDER, [(folder / "shared").as_uri()])
    await client.workspace_execute_command_async(command)
    assert await findings(client, uri, 1) == []
    close(client, uri)


async def test_who_can_make_this_state_change(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("behaviour {", "behaviour {\n after 3.0 s without opened goto closed", 1)
    uri, _ = await opened(client, folder / "calls.rscd", text)
    (item,) = await client.text_document_prepare_call_hierarchy_async(
        types.CallHierarchyPrepareParams(**at(uri, position(text, "goto closed", 6)))
    )
    assert (item.name, of(text, item.selection_range)) == ("Door.closed", "closed")
    calls = await client.call_hierarchy_incoming_calls_async(types.CallHierarchyIncomingCallsParams(item))
    assert [(call.from_.name, call.from_.detail, of(text, call.from_ranges[0])) for call in calls] == [
        ("Door", "after 3.0 s without opened", "after 3.0 s without opened goto closed"),
        ("Door.open", "response from opened", "on response from opened if !value goto closed"),
    ]
    calls = await client.call_hierarchy_outgoing_calls_async(types.CallHierarchyOutgoingCallsParams(item))
    assert [(call.to.name, call.to.detail) for call in calls] == [("Door.open", "response from opened")]
    calls = await client.call_hierarchy_incoming_calls_async(types.CallHierarchyIncomingCallsParams(calls[0].to))
    assert [call.from_.name for call in calls] == ["Door.closed"]
    close(client, uri)


@pytest.mark.slow
async def test_quick_fix_over_the_protocol(client: Editor, folder: Path) -> None:
    text = ROBOT.replace("Door.open", "Door.opem")
    uri, (finding,) = await opened(client, folder / "fix.rscd", text)
    context = types.CodeActionContext([finding])
    (action,) = await client.text_document_code_action_async(
        _about(uri, types.CodeActionParams, range=finding.range, context=context)
    )
    assert (action.title, action.kind) == ("write `open`", types.CodeActionKind.QuickFix)
    (edit,) = action.edit.changes[uri]
    replace(client, uri, 2, (edit.range, edit.new_text))
    assert await findings(client, uri, 2) == []
    close(client, uri)
