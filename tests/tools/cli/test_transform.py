"""`robosc transform`: its output files, and that a fault leaves no output."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from robosc.m2t.targets import TARGETS

from .conftest import Run

ALL = ",".join(TARGETS)


def tree(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_all_targets_have_their_place(run: Run, door: Path) -> None:
    door.with_name("controller-config.json").write_text('{"onShutdown": []}')
    answer = run("transform", door, "--to", ALL)
    assert answer.exit_code == 0, answer.output
    written = tree(Path("build/Door"))
    assert answer.stderr == f"build/Door: {len(written)} files, {len(written)} written\n"
    assert answer.stdout == ""
    places = {"/".join(name.split("/")[:2]) if name.startswith("ros") else name for name in written}
    assert places == {
        "Door.cif",
        "Door.supervised.cif",
        "Door.robosc.xmi",
        "Door.engine.xmi",
        "Door.rosgraph.xmi",
        "Door.sct.xmi",
        "ros1/door_controller",
        "ros2/door_controller",
        "ros2/door_layer",
        "supervisor/CMakeLists.txt",
        "supervisor/door_supervisor.c",
        "supervisor/door_supervisor.h",
    }


@pytest.mark.slow
def test_the_same_from_any_folder(door: Path, tmp_path: Path) -> None:
    (tmp_path / "far" / "away").mkdir(parents=True)
    calls = [
        (tmp_path, door.name, "one", "0"),
        (tmp_path / "far" / "away", f"../../{door.name}", "../../two", "1"),
        (Path("/"), str(door), str(tmp_path / "three"), "2"),
    ]
    for folder, model, output, seed in calls:
        call = [sys.executable, "-m", "robosc", "transform", model, "--to", ALL, "-o", output]
        subprocess.run(call, cwd=folder, env=os.environ | {"PYTHONHASHSEED": seed}, check=True, capture_output=True)
    first = tree(tmp_path / "one")
    assert first
    assert tree(tmp_path / "two") == first
    assert tree(tmp_path / "three") == first


def test_only_what_changed_is_written(run: Run, door: Path) -> None:
    run("transform", door, "--to", "xmi,cif", "-o", "out")
    again = run("transform", door, "--to", "cif,xmi", "-o", "out")
    assert again.stderr == "out: 6 files, 0 written\n"


@pytest.mark.parametrize("start", ["robosc", "sct", "rosgraph"])
def test_saved_models_give_the_same(run: Run, door: Path, start: str) -> None:
    targets = [target.name for target in TARGETS.values() if start != "sct" or not target.needs_graph]
    assert run("transform", door, "--to", ALL, "-o", "out").exit_code == 0
    answer = run("transform", f"out/Door.{start}.xmi", "--to", ",".join(targets), "-o", "again")
    assert answer.exit_code == 0, answer.output
    again, out = tree(Path("again")), tree(Path("out"))
    assert len(again) > 5
    assert again.items() <= out.items()


def test_what_an_sct_model_can_not_give(run: Run, door: Path) -> None:
    run("transform", door, "--to", "xmi", "-o", "out")
    answer = run("transform", "out/Door.sct.xmi", "--to", "cif,ros2", "-o", "again")
    assert answer.exit_code == 2
    assert "has no ROS graph, which ros2 needs" in answer.stderr
    assert not Path("again").exists()


@pytest.mark.parametrize(("model", "status"), [("broken", 1), ("stuck", 3), ("library", 2), ("damaged", 1)], ids=str)
def test_nothing_is_written_where_something_is_wrong(
    run: Run, door: Path, model: str, status: int, request: pytest.FixtureRequest
) -> None:
    run("transform", door, "--to", ALL, "-o", "out")
    before = {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in Path("out").rglob("*") if path.is_file()}
    if model == "damaged":
        file = Path("damaged.xmi")
        file.write_text(Path("out/Door.sct.xmi").read_text()[:-30])
    else:
        file = request.getfixturevalue(model)
        file.write_text(file.read_text().replace("robot Door", "robot Other"))
    answer = run("transform", file, "--to", ALL, "-o", "out")
    assert answer.exit_code == status, answer.output
    assert "Error: " in answer.stderr if status == 2 else ": error: " in answer.stdout
    after = {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in Path("out").rglob("*") if path.is_file()}
    assert after == before
    assert run("transform", file, "--to", ALL).exit_code == status
    assert not Path("build").exists()


@pytest.mark.parametrize("targets", ["", "cif,", "ros3", "cif,ros3"])
def test_unknown_targets(run: Run, door: Path, targets: str) -> None:
    answer = run("transform", door, "--to", targets)
    assert answer.exit_code == 2
    assert "expected one of cif, supervisor, ros1, ros2, ros2-layer, xmi" in answer.stderr


def test_targets_one_by_one(run: Run, door: Path) -> None:
    run("transform", door, "--to", "cif, xmi", "-o", "one")
    run("transform", door, "--to", "xmi", "--to", "cif", "-o", "two")
    assert len(tree(Path("one"))) == 6
    assert tree(Path("one")) == tree(Path("two"))


def test_targets_together_and_each_alone(run: Run, door: Path) -> None:
    targets = "supervisor", "ros1", "ros2"
    run("transform", door, "--to", ",".join(targets), "-o", "together")
    for target in targets:
        run("transform", door, "--to", target, "-o", "alone")
    assert tree(Path("together")) == tree(Path("alone"))


def test_a_name_for_a_controller_and_its_layer(run: Run, door: Path) -> None:
    Path("named.json").write_text('{"package": {"name": "gate"}}')
    answer = run("transform", door, "--to", "ros2,ros2-layer", "--config", "named.json")
    assert answer.exit_code == 2
    assert 'ros2 and ros2-layer would both be ros2/gate: "package.name" names both' in answer.stderr
    assert run("transform", door, "--to", "ros1,ros2-layer", "--config", "named.json").exit_code == 0


def test_a_folder_that_can_not_be_written(run: Run, door: Path) -> None:
    Path("out").write_text("a file")
    assert run("transform", door, "--to", "xmi", "-o", "out").exit_code == 2
    Path("taken/Door.sct.xmi").mkdir(parents=True)
    answer = run("transform", door, "--to", "xmi", "-o", "taken")
    assert answer.exit_code == 2
    assert "Door.sct.xmi is a folder" in answer.stderr
    assert tree(Path("taken")) == {}


def test_the_configuration_near_the_model(run: Run, door: Path) -> None:
    (door.parent / "settings").mkdir()
    (door.parent / "settings" / "controller-config.json").write_text('{"package": {"name": "my_door"}}')
    run("transform", door, "--to", "ros1", "-o", "out")
    assert Path("out/ros1/my_door/package.xml").exists()
    Path("other.json").write_text('{"package": {"name": "your_door"}}')
    run("transform", door, "--to", "ros1", "-o", "out", "--config", "other.json")
    assert Path("out/ros1/your_door/package.xml").exists()


def test_a_configuration_with_errors(run: Run, door: Path) -> None:
    Path("controller-config.json").write_text('{\n  "controlLoop": {"periodMS": 3}\n}\n')
    answer = run("transform", door.name, "--to", "cif")
    assert answer.exit_code == 1
    assert answer.stdout.startswith('controller-config.json:2:19: error: unknown key "controlLoop.periodMS"')
    assert '\n      "controlLoop": {"periodMS": 3}\n                      ^^^^^^^^^^\n' in answer.stdout
    assert 'hint: did you mean "periodMs"?' in answer.stdout
    assert run("transform", door, "--to", "cif", "--config", "missing.json").exit_code == 2


def test_a_setting_for_a_topic_that_the_robot_does_not_have(run: Run, door: Path) -> None:
    Path("controller-config.json").write_text('{"qos": {"opne": {"depth": 3}, "open": {"depth": 3}}}')
    answer = run("transform", door, "--to", "ros1,ros2", "-o", "out")
    assert answer.exit_code == 0, answer.output
    assert answer.stdout.count("controller-config.json:1:10: warning: ") == 1
    assert 'did you mean "open"?' in answer.stdout
    assert run("transform", door, "--to", "cif", "-o", "out").stdout == ""


def test_copies_of_the_packages(run: Run, door: Path) -> None:
    (door.parent / "controller-config.json").write_text(
        '{"output": {"ros1ControllerNodeLocation": "workspace/src/door", "ros2ControllerNodeLocation": "two"}}'
    )
    answer = run("transform", door, "--to", "ros1,cif", "-o", "out")
    assert answer.exit_code == 0, answer.output
    package = tree(Path("out/ros1/door_controller"))
    assert "package.xml" in package
    assert tree(Path("workspace/src/door")) == package
    assert not Path("two").exists()


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_warnings_of_synthesis(run: Run, courier: Path, form: str) -> None:
    answer = run("transform", courier.name, "-I", "parts", "--to", "cif,supervisor", "-o", "out", "--format", form)
    assert answer.exit_code == 0, answer.output
    said = json.loads(answer.stdout)
    if form == "json":
        [finding] = [finding for finding in said if finding["rule"] == "shared-topic-conflict"]
        assert finding["severity"] == "warning"
        assert (finding["file"], finding["line"], finding["column"]) == ("parts/lamps.rscd", 4, 5)
        assert finding["hint"]
    else:
        rules = {finding["id"]: finding for finding in said["runs"][0]["tool"]["driver"]["rules"]}
        summary = rules["shared-topic-conflict"]["shortDescription"]["text"]
        assert summary == "The controller can send two messages on one topic at the same time."
    assert Path("out/Courier.cif").exists()


def test_nothing_is_generated_for_an_action_that_cancels_itself(run: Run, self_cancelling: Path) -> None:
    answer = run("transform", self_cancelling.name, "-I", "parts", "--to", ALL, "-o", "out")
    assert answer.exit_code == 1
    assert "courier.rscd:20:3: error: " in answer.stdout
    assert "[self-cancelling]" in answer.stdout
    assert "[shared-topic-conflict]" in answer.stdout
    assert not Path("out").exists()


def test_with_tests(run: Run, door: Path) -> None:
    assert run("transform", door, "--to", ALL, "-o", "out").exit_code == 0
    answer = run("transform", door, "--to", ALL, "-o", "tested", "--with-tests")
    assert answer.exit_code == 0, answer.output
    plain, tested = tree(Path("out")), tree(Path("tested"))
    differ = {path for path in tested if plain.get(path) != tested[path]}
    assert set(plain) < set(tested)
    assert all(path.startswith(("ros1/door_controller/", "ros2/door_controller/")) for path in differ)
    for ros in ("ros1", "ros2"):
        folder = Path("tested") / ros / "door_controller" / "test"
        assert os.access(folder / "play_trace.py", os.X_OK)
        assert not os.access(folder / "trace_player.py", os.X_OK)
        assert (folder / "traces" / "tour_1.jsonl").read_text().count("c_trigger") == 2


def test_tests_for_what_has_none(run: Run, door: Path) -> None:
    answer = run("transform", door, "--to", "cif,ros2-layer", "--with-tests")
    assert answer.exit_code == 2
    assert "--with-tests is for ros1 and ros2" in answer.output
    assert not Path("build").exists()


@pytest.mark.parametrize("start", ["rosgraph", "robosc"])
def test_saved_models_give_the_same_tests(run: Run, door: Path, start: str) -> None:
    assert run("transform", door, "--to", "xmi,ros1", "-o", "out", "--with-tests").exit_code == 0
    answer = run("transform", f"out/Door.{start}.xmi", "--to", "ros1", "-o", "again", "--with-tests")
    assert answer.exit_code == 0, answer.output
    assert tree(Path("again")).items() <= tree(Path("out")).items()


def test_what_a_package_is_made_of_is_listed(run: Run, tmp_path: Path) -> None:
    """The list has the model, its libraries, ROS type definitions and the configuration.

    Files that were only searched are not in it.
    """
    library, types = tmp_path / "libraries", tmp_path / "types" / "door_msgs" / "msg"
    library.mkdir()
    types.mkdir(parents=True)
    (library / "other.rscd").write_text("library Other { }")
    (library / "bells.rscd").write_text(
        'library Bells { component Bell { incoming message ring with identifier: "/ring", type: none } }'
    )
    (types / "Angle.msg").write_text("float64 degrees\n")
    (types / "Unused.msg").write_text("float64 degrees\n")
    (types.parent / "package.xml").write_text("<package><name>door_msgs</name></package>")
    model = tmp_path / "robot.rscd"
    model.write_text(
        "robot R { interface angle use Angle from door_msgs component Bell from Bells import Bell"
        ' component Door { outgoing message opened with identifier: "/opened", type: door_msgs/Angle'
        " behaviour { initial marked state only { on response from opened if value.degrees > 1.0 } } } }"
    )
    (tmp_path / "controller-config.json").write_text('{"onShutdown": []}')
    options = ["-I", library, "--interface-path", tmp_path / "types"]
    answer = run("transform", model, "--to", "ros2", "--list-inputs", *options)
    assert answer.exit_code == 0, answer.output
    listed = [Path(line).relative_to(tmp_path.resolve()).as_posix() for line in answer.stdout.splitlines()]
    own = [name for name in listed if not name.startswith("../")]
    assert {"robot.rscd", "libraries/bells.rscd", "controller-config.json"} <= set(own)
    assert any(name.endswith("Angle.msg") for name in own)
    assert not any("Unused" in name for name in own)
    assert not Path("build").exists()


def test_inputs_of_a_model_with_errors_are_not_listed(run: Run, door: Path) -> None:
    door.write_text("robot Door {")
    answer = run("transform", door, "--to", "ros2", "--list-inputs")
    assert (answer.exit_code, answer.stdout) == (1, "")


def test_what_a_package_includes(run: Run, door: Path, tmp_path: Path) -> None:
    """The package contains the code without a folder of its own and names its source. There is no second copy."""
    (tmp_path / "controller-config.json").write_text(
        '{"onShutdown": [], "output": {"ros2ControllerNodeLocation": "copy"}}'
    )
    answer = run("transform", door, "--to", "ros2", "--into", "my_robot", "-o", "out")
    assert answer.exit_code == 0, answer.output
    made = tree(tmp_path / "out")
    assert {"fragment.cmake", "src/door_controller_node.cpp", "launch/door_controller.launch.py"} <= made.keys()
    assert not {"package.xml", "CMakeLists.txt"} & made.keys()
    listed = run("transform", door, "--to", "ros2", "--list-inputs").stdout
    assert (tmp_path / "out" / "inputs.txt").read_text() == listed
    assert str(tmp_path.resolve() / "controller-config.json") in listed.splitlines()
    assert not (tmp_path / "copy").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--to", "cif", "--into", "x"], "--into is for one of supervisor, ros1, ros2"),
        (["--to", "ros1,ros2", "--into", "x"], "--into is for one of supervisor, ros1, ros2"),
        (["--to", "ros1", "--into", "x)"], "is not a name of a package or a target"),
    ],
)
def test_what_nothing_can_include(run: Run, door: Path, arguments: list[str], said: str) -> None:
    answer = run("transform", door, *arguments)
    assert answer.exit_code == 2
    assert said in " ".join(answer.output.split())
    assert not Path("build").exists()
