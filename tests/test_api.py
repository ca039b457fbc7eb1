"""The public functions behave like the command line."""

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.m2t.targets import TARGETS
from robosc.model import expression as ex
from robosc.tools.cli import main
from tests.tools.cli.conftest import COURIER, DOOR, LAMPS


@pytest.fixture
def door(tmp_path: Path) -> Path:
    file = tmp_path / "door.rscd"
    file.write_text(DOOR)
    return file


def models_of(robot: "robosc.Robot") -> robosc.Models:
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot)


def test_importing_robosc_loads_nothing_else() -> None:
    program = "import sys; before = set(sys.modules); import robosc; print(*set(sys.modules) - before)"
    done = subprocess.run([sys.executable, "-I", "-c", program], check=True, capture_output=True, text=True)
    assert {name.partition(".")[0] for name in done.stdout.split()} - sys.stdlib_module_names == {"robosc"}


def test_every_public_name_is_there() -> None:
    for name in robosc.__all__:
        assert getattr(robosc, name).__name__ == name
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = robosc.nothing


@pytest.mark.parametrize("target", TARGETS)
def test_the_same_files_as_from_the_command_line(door: Path, tmp_path: Path, target: str) -> None:
    robot = robosc.load(door)
    assert robosc.check(robot) == []
    models = models_of(robot)
    files = robosc.generate(target, models)
    answer = CliRunner().invoke(main, ["transform", str(door), "--to", target, "-o", str(tmp_path / "out")])
    assert answer.exit_code == 0
    folder = tmp_path / "out" / TARGETS[target].folder(models, robosc.Configuration())
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert written == files.keys()
    assert {name: (folder / name).read_text() for name in files} == files


def test_both_models_of_a_robot_are_about_the_same_plants(door: Path) -> None:
    robot = robosc.load(door)
    assert robosc.to_sct(robot) is robosc.to_sct(robot)
    assert robosc.to_rosgraph(robot).model is robosc.to_sct(robot)
    assert robosc.to_sct(robosc.load(door)) is not robosc.to_sct(robot)


def test_loading_what_was_saved(door: Path, tmp_path: Path) -> None:
    for name, text in robosc.generate("xmi", models_of(robosc.load(door))).items():
        (tmp_path / name).write_text(text)
    loaded = models_of(robosc.load(tmp_path / "Door.robosc.xmi"))
    assert robosc.generate("cif", loaded) == robosc.generate("cif", models_of(robosc.load(door)))
    with pytest.raises(ValueError, match="has a RosGraph, not a Robot"):
        robosc.load(tmp_path / "Door.rosgraph.xmi")


def test_loading_what_is_broken(door: Path, tmp_path: Path) -> None:
    door.write_text(DOOR.replace("Leaf.closed", "Leaf.x"))
    with pytest.raises(robosc.ModelError) as raised:
        robosc.load(door)
    assert [diagnostic.rule for diagnostic in raised.value.diagnostics] == ["unresolved-reference"]
    with pytest.raises(FileNotFoundError):
        robosc.load(tmp_path / "missing.rscd")


def test_libraries_are_looked_for_in_given_folders(door: Path, tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "parts.rscd").write_text("library Parts { component Leaf {} }")
    door.write_text("robot Door { component Front from Parts import Leaf }")
    assert robosc.load(door, [tmp_path / "parts"]).name == "Door"
    with pytest.raises(ValueError, match="has a Library, not a Robot"):
        robosc.load(tmp_path / "parts" / "parts.rscd")


def test_only_what_is_public_is_offered() -> None:
    assert {*dir(robosc)} == {*robosc.__all__, "__version__"}


def test_no_supervisor(door: Path) -> None:
    door.write_text(DOOR.replace("initial marked", "initial").replace("needs Leaf.closed", "needs Leaf.opened"))
    model = robosc.to_sct(robosc.load(door))
    with pytest.raises(robosc.EmptySupervisorError) as raised:
        robosc.synthesize(model)
    assert [diagnostic.rule for diagnostic in raised.value.diagnostics] == ["empty-supervisor"]
    assert "request to `Leaf.open`" in str(raised.value)
    assert raised.value.synthesis.reason is not None
    assert model.supervisor is None


def test_what_can_not_be_generated(door: Path) -> None:
    robot = robosc.load(door)
    bare = robosc.Models(robosc.to_sct(robot))
    with pytest.raises(ValueError, match="no supervisor yet"):
        robosc.generate("cif", bare)
    robosc.synthesize(bare.sct)
    with pytest.raises(ValueError, match="unknown target 'ros3'"):
        robosc.generate("ros3", bare)
    with pytest.raises(ValueError, match="ros1 needs the ROS graph"):
        robosc.generate("ros1", bare)


def test_an_action_that_cancels_itself(tmp_path: Path) -> None:
    (tmp_path / "lamps.rscd").write_text(LAMPS)
    (tmp_path / "courier.rscd").write_text(COURIER.format(needs="resting"))
    model = robosc.to_sct(robosc.load(tmp_path / "courier.rscd"))
    with pytest.raises(robosc.ModelError) as raised:
        robosc.synthesize(model)
    assert [diagnostic.rule for diagnostic in raised.value.diagnostics] == ["self-cancelling", "shared-topic-conflict"]
    assert model.supervisor is None


def test_what_is_generated_is_of_the_model_as_it_is_now(door: Path) -> None:
    models = models_of(robosc.load(door))
    before = robosc.generate("supervisor", models)
    for guard in models.sct.supervisor.guards:
        guard.requirement = ex.BooleanLiteral(value=False)
    assert robosc.generate("supervisor", models) != before
