"""Models that the first edition saved still load with the same meaning: `first_edition` has its courier."""

from pathlib import Path
from shutil import copyfile

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

HERE = Path(__file__).parent
SAVED = HERE / "first_edition"
ROBOT = HERE / "cpp" / "courier.rscd"
INTERFACES = HERE.parent / "ros" / "interfaces" / "ros2"


def transformed(folder: Path, source: Path, target: str) -> dict[str, bytes]:
    """Return the generated files of a copy of the source, with the courier's configuration beside it."""
    folder.mkdir()
    copyfile(ROBOT.parent / "controller-config.json", folder / "controller-config.json")
    copyfile(source, folder / source.name)
    out = folder / "out"
    answer = CliRunner().invoke(
        main,
        ["transform", "--to", target, "-o", str(out), "--interface-path", str(INTERFACES), f"{folder / source.name}"],
    )
    assert answer.exit_code == 0, answer.output
    return {str(file.relative_to(out)): file.read_bytes() for file in sorted(out.rglob("*")) if file.is_file()}


@pytest.mark.parametrize("target", ["cif", "supervisor", "ros1", "ros2"])
def test_a_saved_robot_gives_what_its_text_gives(tmp_path: Path, target: str) -> None:
    wanted = transformed(tmp_path / "text", ROBOT, target)
    assert wanted
    assert transformed(tmp_path / "saved", SAVED / "Courier.robosc.xmi", target) == wanted


def test_a_saved_graph_gives_a_node(tmp_path: Path) -> None:
    """The plants are in the same folder."""
    (tmp_path / "saved").mkdir()
    for file in SAVED.glob("*.xmi"):
        copyfile(file, tmp_path / "saved" / file.name)
    copyfile(ROBOT.parent / "controller-config.json", tmp_path / "saved" / "controller-config.json")
    out = tmp_path / "out"
    answer = CliRunner().invoke(
        main, ["transform", "--to", "ros1", "-o", str(out), str(tmp_path / "saved" / "Courier.rosgraph.xmi")]
    )
    assert answer.exit_code == 0, answer.output
    assert (out / "ros1" / "courier_controller" / "package.xml").is_file()


def test_saved_plants_have_the_states_of_the_text() -> None:
    def counts(source: Path) -> list[str]:
        answer = CliRunner().invoke(main, ["synthesize", "--interface-path", str(INTERFACES), str(source)])
        assert answer.exit_code == 0, answer.output
        return [line for line in answer.stdout.splitlines() if "states" in line]

    assert counts(ROBOT)
    assert counts(SAVED / "Courier.sct.xmi") == counts(ROBOT)
