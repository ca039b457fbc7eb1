"""`--interface-path`, which several commands have."""

from pathlib import Path

import pytest

from .conftest import Run

MODEL = """
robot Crane {
  interface level use Level from hoist_msgs
  component Hoist { incoming message lift with type: integer links level }
  provide lift with 3
}
"""


@pytest.fixture
def crane(tmp_path: Path) -> Path:
    messages = tmp_path / "workspace" / "src" / "hoist_msgs" / "msg"
    messages.mkdir(parents=True)
    (messages / "Level.msg").write_text("int32 level\n")
    model = tmp_path / "crane.rscd"
    model.write_text(MODEL)
    return model


def test_unknown_without(run: Run, crane: Path) -> None:
    answer = run("check", crane)
    assert answer.exit_code == 0
    assert "warning: the package `hoist_msgs` is unknown [interface-unknown]" in answer.stdout
    assert "--interface-path" in answer.stdout


@pytest.mark.parametrize("command", ["check", "synthesize", "diagram"])
def test_known_with(run: Run, crane: Path, command: str) -> None:
    answer = run(command, crane, "--interface-path", crane.parent / "workspace")
    assert answer.exit_code == 0
    assert "interface-" not in answer.output


def test_from_the_environment(run: Run, crane: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOSC_INTERFACE_PATH", str(crane.parent / "workspace"))
    assert run("check", crane).output == ""


def test_of_several_the_first_counts(run: Run, crane: Path) -> None:
    other = crane.parent / "other" / "hoist_msgs" / "msg"
    other.mkdir(parents=True)
    (other / "Level.msg").write_text("float64 level\n")
    folders = ["--interface-path", crane.parent / "other", "--interface-path", crane.parent / "workspace"]
    answer = run("check", crane, *folders)
    assert answer.exit_code == 1
    assert "the data is integer here, and float64 in `level` of hoist_msgs/Level [interface-type]" in answer.stdout
    assert run("check", crane, *folders[2:], *folders[:2]).output == ""


def test_the_graph_knows_the_field(run: Run, crane: Path) -> None:
    for known, field in (["--interface-path", crane.parent / "workspace"], "level"), ([], "data"):
        answer = run("transform", crane, "--to", "xmi", "-o", crane.parent / "out", *known)
        assert answer.exit_code == 0, answer.output
        graph = (crane.parent / "out" / "Crane.rosgraph.xmi").read_text()
        assert f'path="{field}"' in graph or f"<path>{field}</path>" in graph


def test_a_folder_that_is_missing(run: Run, crane: Path) -> None:
    answer = run("check", crane, "--interface-path", crane.parent / "nowhere")
    assert answer.exit_code == 2
    assert "nowhere" in answer.stderr
