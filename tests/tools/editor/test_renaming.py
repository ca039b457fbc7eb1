"""A rename changes all texts that name the element, and nothing else."""

from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.tools.editor.project import Project, Snapshot
from robosc.tools.editor.renaming import prepare_rename, rename
from tests.tools.editor.server import LIBRARY, ROBOT, edited, position

OTHER = ROBOT.replace("Cart", "Van")


@pytest.fixture
def project(tmp_path: Path) -> Project:
    (tmp_path / "wheels.rscd").write_text(LIBRARY)
    (tmp_path / "van.rscd").write_text(OTHER.replace("\n", "\r\n"))
    made = Project()
    made.folders = (tmp_path,)
    made.put((tmp_path / "cart.rscd").as_uri(), 1, ROBOT)
    return made


def renamed(project: Project, text: str, marker: str, new: str, into: int = 0) -> dict[str, str]:
    """Return the texts after a rename, by the stems of their names."""
    (path,) = [path for path, document in project.snapshot().documents.items() if document.content == text]
    snapshot = project.snapshot()
    analysis = snapshot.analysis(path)
    asked = types.RenameParams(types.TextDocumentIdentifier(path.as_uri()), position(text, marker, into), new_name=new)
    answer = rename(snapshot, analysis, asked)
    return {
        Path(uri).stem: _after(snapshot, Path(uri.removeprefix("file://")), found)
        for uri, found in answer.changes.items()
    }


def _after(snapshot: Snapshot, path: Path, edits: list[types.TextEdit]) -> str:
    return edited(snapshot.texts.read(path).decode(), edits)


def test_over_all_files(project: Project) -> None:
    assert renamed(project, ROBOT, "drive needs", "go") == {
        "cart": ROBOT.replace("drive needs", "go needs").replace("provide drive", "provide go"),
        "van": OTHER.replace("drive needs", "go needs").replace("provide drive", "provide go").replace("\n", "\r\n"),
        "wheels": LIBRARY.replace("message drive", "message go"),
    }


def test_a_keyword_gets_its_mark(project: Project) -> None:
    after = renamed(project, ROBOT, "open {", "state")
    assert after == {
        "cart": ROBOT.replace("goto open", "goto ^state")
        .replace("state open", "state ^state")
        .replace("Door.open", "Door.^state")
    }


@pytest.mark.parametrize(
    ("marker", "new", "why"),
    [
        ("open {", "closed", "this would change the meaning of cart.rscd"),
        ("Door {", "Base", "this would change the meaning of cart.rscd"),
        ("open {", "2nd", "`2nd` is not a name"),
        ("open {", "on foot", "`on foot` is not a name"),
    ],
)
def test_what_would_break_the_model_is_refused(project: Project, marker: str, new: str, why: str) -> None:
    with pytest.raises(JsonRpcException, match=why):
        renamed(project, ROBOT, marker, new)


def test_a_name_that_another_one_would_take_is_refused(project: Project, tmp_path: Path) -> None:
    """No finding would show this: the variable would hide the value of the enum."""
    text = """robot R {
  datatype enum View from boolean to { value -> near default -> far }
  component C {
    outgoing message m with type: View
    behaviour { variable seen: View = far initial marked state s { on response from m do seen := value
      transition if seen = near goto t } state t { transition goto s } }
  }
}
"""
    project.put((tmp_path / "view.rscd").as_uri(), 1, text)
    assert renamed(project, text, "near", "close")["view"] == text.replace("near", "close")
    with pytest.raises(JsonRpcException, match="change the meaning of view"):
        renamed(project, text, "near", "seen")


def test_a_property_is_renamed_in_each_branch(project: Project, tmp_path: Path) -> None:
    text = """robot R {
  interface speed use Speed from cart_msgs
  datatype object Speed { forward: double turn: double }
  component C {
    incoming message move with type: Speed links speed
    behaviour { initial marked state s { transition goto t } state t { transition goto s } }
  }
  provide move with if C.s then { forward: 1.0 } else if C.t then { turn: 1.0, forward: 0.5 } else {}
}
"""
    project.put((tmp_path / "speed.rscd").as_uri(), 1, text)
    assert renamed(project, text, "forward: double", "ahead")["speed"] == text.replace("forward", "ahead")


def test_what_can_not_be_read_is_no_basis(project: Project, tmp_path: Path) -> None:
    text = ROBOT.replace("drive with 0.5", "drive wth Door.open")
    project.put((tmp_path / "cart.rscd").as_uri(), 2, text)
    with pytest.raises(JsonRpcException, match=r"correct .*cart\.rscd first: `drive` is in an unreadable part"):
        renamed(project, text, "drive needs", "go")


def test_names_of_others_stay(project: Project, tmp_path: Path) -> None:
    text = """robot R {
  component Stop from EmergencyStopLibrary import EmergencyStop
  component C { outgoing message m with type: std_msgs/Bool behaviour { initial marked state s {
    on response from m if value.data goto s } } }
}
"""
    path = project.put((tmp_path / "stop.rscd").as_uri(), 1, text)
    snapshot = project.snapshot()
    analysis = snapshot.analysis(path)
    for marker, into, why in [
        ("import EmergencyStop", 8, "not in the editor's folders"),
        (".data", 1, "a name of ROS"),
    ]:
        asked = types.PrepareRenameParams(types.TextDocumentIdentifier(path.as_uri()), position(text, marker, into))
        with pytest.raises(JsonRpcException, match=why):
            prepare_rename(snapshot, analysis, asked)
    asked = types.PrepareRenameParams(types.TextDocumentIdentifier(path.as_uri()), position(text, "Stop from"))
    assert prepare_rename(snapshot, analysis, asked).placeholder == "Stop"


def test_a_finding_in_a_text_that_imports_the_element_is_refused(project: Project, tmp_path: Path) -> None:
    """The text of the robot does not contain the old name."""
    library = """library Arms {
          datatype enum Hold from integer(0..3) to { value > 2 -> tight default -> loose }
          component Arm { outgoing message grip with type: Hold }
        }"""
    project.put((tmp_path / "arms.rscd").as_uri(), 1, library)
    (tmp_path / "hand.rscd").write_text(
        """robot Hand {
          component A from Arms import Arm
          component Lamp { incoming message light with type: none behaviour { initial marked state dark {} } }
        }"""
    )
    with pytest.raises(JsonRpcException, match=r"hand\.rscd"):
        renamed(project, library, "loose", "dark")
