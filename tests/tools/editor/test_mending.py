"""A hint that states an edit offers it, and the edit removes the finding."""

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pygls.uris import to_fs_path

from robosc.language.checks.automatic_edits import Safety
from robosc.tools.editor import findings
from robosc.tools.editor.findings import code_actions
from robosc.tools.editor.project import Project, Snapshot
from tests.tools.editor.server import edited

URI = "file:///nowhere/model.rscd"
ROBOT = """robot R {
  interface flag use Bool from std_msgs
  datatype object Bool { data: boolean }
  component C {
    incoming message go with type: Bool links flag
    outgoing message told with type: double
    behaviour {
      variable x: double = 1.0
      initial marked state idle { on response from told if value > 0.0 do x := value goto busy }
      state busy { on response from told goto idle }
    }
  }
  requirement go needs C.idle
  provide go with { data: C.x > 0.0 }
}
"""
CASES = [
    ("goto busy", "goto buzy", "unresolved-reference"),
    ("C.idle", "idle", "unresolved-reference"),
    ("= 1.0", "= 1", "type"),
    (" links flag", "", "interface-link"),
    ("initial marked state", "initial state", "marked-state"),
    ("initial marked state", "marked state", "initial-state"),
    ("type: double", "type: float", "unresolved-reference"),
    ("value > 0.0", "value == 0.0", "syntax"),
    ("needs", "nees", "syntax"),
    ("R {", "R { ;", "syntax"),
]


def ask(text: str, place: types.Range, *only: str) -> tuple[Snapshot, list[types.CodeAction]]:
    project = Project()
    path = project.put(URI, 1, text)
    snapshot = project.snapshot()
    context = types.CodeActionContext([], only=list(only) or None)
    asked = types.CodeActionParams(types.TextDocumentIdentifier(URI), place, context)
    return snapshot, code_actions(snapshot, snapshot.analysis(path), asked)


WHOLE = types.Range(types.Position(0, 0), types.Position(100, 0))


def errors(text: str) -> list[str]:
    project = Project()
    path = project.put(URI, 1, text)
    return [finding.rule for finding in project.snapshot().analysis(path).findings]


def test_nothing_to_mend() -> None:
    assert errors(ROBOT) == []
    assert ask(ROBOT, WHOLE)[1] == []


@pytest.mark.parametrize(("right", "wrong", "rule"), CASES)
def test_a_hint_mends(right: str, wrong: str, rule: str) -> None:
    text = ROBOT.replace(right, wrong, 1)
    assert text != ROBOT
    _, actions = ask(text, WHOLE)
    action = next(action for action in actions if action.diagnostics[0].code == rule)
    assert action.diagnostics[0].code == rule
    # A guess is only offered: a name in another component, a keyword, an interface.
    assert action.is_preferred is (wrong not in {"idle", "nees", ""} and action.title in action.diagnostics[0].message)
    after = edited(text, action.edit.changes[URI])
    assert rule not in errors(after), after
    nowhere = types.Range(types.Position(0, 0), types.Position(0, 0))
    assert action.title not in {other.title for other in ask(text, nowhere)[1]} or "R { ;" in text


def test_each_way_is_a_fix() -> None:
    """Each of several alternatives is offered, but applying all hints at once applies none of them."""
    text = ROBOT.replace("initial marked state", "marked state", 1)
    _, actions = ask(text, WHOLE)
    assert [(action.title, action.is_preferred) for action in actions] == [
        (f"write `initial` before `state {name}`", False) for name in ("idle", "busy")
    ]
    after = [edited(text, action.edit.changes[URI]) for action in actions]
    assert ["initial state busy" in other for other in after] == [False, True]
    assert ["initial-state" in errors(other) for other in after] == [False, False]
    assert ask(text, WHOLE, "source.fixAll")[1] == []


def test_an_edit_that_would_break_the_text_is_not_offered() -> None:
    """In this place, `requirement never` would be an error just as `never` is."""
    text = ROBOT.replace("state busy { ", "state busy { never C.idle ")
    _, actions = ask(text, WHOLE)
    assert "syntax" in errors(text)
    assert [action.title for action in actions if "requirement never" in action.title] == []


def test_an_edit_after_which_a_rule_finds_something_else_is_not_preferred() -> None:
    text = ROBOT.replace("value > 0.0", "mode(value, value) > 0.0")
    _, actions = ask(text, WHOLE)
    (action,) = [action for action in actions if action.title == "write `mod`"]
    assert action.is_preferred is False
    after = errors(edited(text, action.edit.changes[URI]))
    assert after
    assert "unresolved-reference" not in after


def test_a_large_selection_tries_few_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = 0
    judge = findings._safety

    def counted(*arguments: Any) -> Safety:
        nonlocal tried
        tried += 1
        return judge(*arguments)

    monkeypatch.setattr(findings, "_safety", counted)
    text = ROBOT.replace("  provide go with", "  requirement go needs C.idel\n" * 40 + "  provide go with")
    assert errors(text) == ["unresolved-reference"] * 40
    assert len(ask(text, WHOLE)[1]) == tried == findings._MOST_WAYS


TWICE = ROBOT.replace("state busy", "state /* state idle of old */ idle").replace("goto busy", "goto idle")


def test_a_duplicate_is_renamed() -> None:
    """The edit changes the name, not the word in the comment before it. References to the first state stay."""
    _, actions = ask(TWICE, WHOLE)
    (action,) = [action for action in actions if action.title == "rename one of the two, such as `idle_2`"]
    after = edited(TWICE, action.edit.changes[URI])
    assert after == TWICE.replace("*/ idle", "*/ idle_2")


def test_a_rename_that_would_change_the_meaning_is_not_offered() -> None:
    """In the unreadable part the name may refer to the state that would be renamed."""
    _, actions = ask(TWICE.replace("goto idle }", "got idle }", 1), WHOLE)
    assert [action for action in actions if action.title.startswith("rename")] == []


def test_a_duplicate_in_a_library_is_renamed_in_the_robots_too(tmp_path: Path) -> None:
    library = """library L {
  component C {
    incoming message go with type: none
    outgoing message told with type: none
  }
  component D { incoming message go with identifier: "/d", type: none }
}
"""
    robot = """robot R {
  component A from L import D
  requirement A.go needs B.ready
  component B { behaviour { initial marked state ready { } } }
}
"""
    project = Project()
    project.folders = (tmp_path,)
    for name, text in (("l", library), ("r", robot)):
        (tmp_path / f"{name}.rscd").write_text(text)
        project.put((tmp_path / f"{name}.rscd").as_uri(), 1, text)
    snapshot = project.snapshot()
    uri = (tmp_path / "l.rscd").as_uri()
    asked = types.CodeActionParams(types.TextDocumentIdentifier(uri), WHOLE, types.CodeActionContext([]))
    actions = code_actions(snapshot, snapshot.analysis(tmp_path / "l.rscd"), asked)
    (action,) = [action for action in actions if action.title.startswith("rename it in `D`, such as `go_d`")]
    changes = {Path(to_fs_path(name)).stem: edits for name, edits in action.edit.changes.items()}
    assert edited(library, changes["l"]) == library.replace(
        "message go with identifier", "message go_d with identifier"
    )
    assert edited(robot, changes["r"]) == robot.replace("A.go", "A.go_d")


def test_all_at_once() -> None:
    """A name is offered and never replaced without a choice."""
    buzy = ROBOT.replace("goto busy", "goto buzy")
    text = buzy.replace("= 1.0", "= 1").replace("double links", "float links")
    _, (action,) = ask(text, WHOLE, "source.fixAll")
    assert edited(text, action.edit.changes[URI]) == buzy
    assert ask(text, WHOLE, "refactor")[1] == []
