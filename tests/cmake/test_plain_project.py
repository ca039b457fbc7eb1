"""A CMake project without ROS generates its model when it is built, and only then."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from catkin_pkg.package import parse_package
from click.testing import CliRunner
from ruamel.yaml import YAML

import robosc
from robosc.tools.cli import main
from tests.cmake.building import blocks, built_again, no_work_is_done, touched_later

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CMAKE = ROOT / "cmake"


class Project:
    """A copy of `plain`, with functions that configure and build it."""

    def __init__(self, folder: Path) -> None:
        self.source, self.build = folder / "gate", folder / "build"
        shutil.copytree(HERE / "plain", self.source)

    def run(self, *command: str | Path) -> subprocess.CompletedProcess[str]:
        environment = os.environ | {"PYTHONPATH": str(ROOT)}
        return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)

    def configure(self, *options: str) -> subprocess.CompletedProcess[str]:
        python = f"-DROBOSC_PYTHON={sys.executable}"
        prefix = f"-DCMAKE_PREFIX_PATH={CMAKE}"
        return self.run("cmake", "-S", self.source, "-B", self.build, prefix, python, *options)

    def make(self) -> subprocess.CompletedProcess[str]:
        return self.run("cmake", "--build", self.build)


@pytest.fixture(scope="module")
def configured(tmp_path_factory: pytest.TempPathFactory) -> Project:
    project = Project(tmp_path_factory.mktemp("plain project"))
    done = project.configure()
    assert done.returncode == 0, done.stdout + done.stderr
    done = project.make()
    assert done.returncode == 0, done.stdout + done.stderr
    return project


@pytest.mark.build
def test_the_program_has_its_supervisor(configured: Project) -> None:
    assert configured.run(configured.build / "gate").stdout == "10\n"


@pytest.mark.build
def test_a_second_build_does_nothing(configured: Project) -> None:
    assert no_work_is_done(configured.make().stdout)


@pytest.mark.build
@pytest.mark.parametrize("name", ["gate.rscd", "libraries/sensors.rscd"])
def test_a_comment_is_read_and_compiles_nothing(configured: Project, name: str) -> None:
    text = configured.source / name
    with touched_later(text, text.read_text(encoding="utf-8") + "// seen, and gone\n"):
        done = configured.make()
        assert done.returncode == 0, done.stderr
        assert "robosc: " in done.stdout
        assert built_again(done.stdout) == []
    assert configured.make().returncode == 0


@pytest.mark.build
def test_what_the_model_means_is_compiled(configured: Project) -> None:
    model = configured.source / "gate.rscd"
    text = model.read_text(encoding="utf-8")
    with touched_later(model, text.replace("Sensor.clear", "Sensor.blocked")):
        assert built_again(configured.make().stdout) == ["gate_supervisor.c.o", "main.c.o"]
        assert configured.run(configured.build / "gate").stdout == "01\n"
    assert built_again(configured.make().stdout) == ["gate_supervisor.c.o", "main.c.o"]
    assert configured.run(configured.build / "gate").stdout == "10\n"


@pytest.mark.build
def test_a_fault_stops_the_build_until_it_is_mended(configured: Project) -> None:
    model = configured.source / "gate.rscd"
    text = model.read_text(encoding="utf-8")
    with touched_later(model, text.replace("Sensor.clear", "Sensor.cleer")):
        for _ in range(2):
            done = configured.make()
            assert done.returncode != 0
            assert f"{model}:12:33: error: " in done.stderr
            assert "    requirement lift needs Sensor.cleer\n" + " " * 36 + "^^^^^\n" in done.stderr
            assert "did you mean `clear`?" in done.stderr
            # CMake wraps the lines of an error. This error is short enough to stay on one line.
            assert "robosc generates nothing from gate.rscd: see above.\n" in done.stderr
    assert configured.make().returncode == 0


@pytest.mark.build
def test_without_the_program_it_is_said_how_to_get_it(tmp_path: Path) -> None:
    done = Project(tmp_path).configure("-DROBOSC_PYTHON=", "-DROBOSC_EXECUTABLE=/nowhere/robosc")
    assert done.returncode != 0
    assert "pip install robosc" in " ".join(done.stderr.split())


@pytest.mark.build
@pytest.mark.parametrize(
    ("arguments", "said"), [("gate.rscd NOTHING", "NOTHING"), ("gate.rscd CONFIG", "CONFIG"), ("", "robosc_generate")]
)
def test_a_wrong_call_is_told(tmp_path: Path, arguments: str, said: str) -> None:
    project = Project(tmp_path)
    script = project.source / "CMakeLists.txt"
    text = script.read_text(encoding="utf-8")
    script.write_text(text.replace("gate.rscd LIBRARY_PATH libraries", arguments), encoding="utf-8")
    done = project.configure()
    assert done.returncode != 0
    assert said in done.stderr


@pytest.mark.build
def test_the_page_can_be_followed(tmp_path: Path) -> None:
    shutil.copytree(HERE / "plain", tmp_path / "tests" / "cmake" / "plain")
    assert blocks("Without ROS", "cmake") == [(HERE / "plain" / "CMakeLists.txt").read_text(encoding="utf-8")]
    programs = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-e", "-c", "".join(blocks("Without ROS", "sh"))],
        cwd=tmp_path,
        env=os.environ | {"PATH": programs, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.endswith("\n10\n")


def test_their_version_is_that_of_the_tool() -> None:
    version = (CMAKE / "robosc" / "robosc-config-version.cmake").read_text(encoding="utf-8")
    assert f'set(PACKAGE_VERSION "{robosc.__version__}")' in version
    for name in ("ament_cmake_robosc", "catkin_robosc"):
        package = parse_package(CMAKE / name)
        package.validate()
        assert (package.name, package.version) == (name, robosc.__version__)


def test_rosdep_is_told_of_the_program() -> None:
    keys = YAML(typ="safe").load((CMAKE / "rosdep.yaml").read_text(encoding="utf-8"))
    for name in ("ament_cmake_robosc", "catkin_robosc"):
        assert [needed.name for needed in parse_package(CMAKE / name).exec_depends] == list(keys)
    assert {system["pip"]["packages"][0] for key in keys.values() for system in key.values()} == {"robosc"}


def test_the_tool_says_where_they_are() -> None:
    done = CliRunner().invoke(main, ["--cmake-dir"])
    assert (done.exit_code, done.output) == (0, f"{CMAKE}\n")


@pytest.mark.build
@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ("guard.rscd LAYER", "// The supervisory layer of Guard"),
        ("gate.rscd LIBRARY_PATH libraries TESTS", "// The controller of Gate"),
    ],
)
def test_what_a_node_is_generated_with_reaches_the_program(tmp_path: Path, arguments: str, told: str) -> None:
    """The function behind `robosc_generate_controller` of both ROS versions passes all its arguments to the program."""
    project = Project(tmp_path)
    shutil.copy(HERE.parent / "run" / "runtime" / "guard.rscd", project.source)
    settings = project.source / "settings" / "own.json"
    settings.parent.mkdir()
    settings.write_text('{"package": {"name": "steward"}}', encoding="utf-8")
    (project.source / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.15)\nproject(own C)\nfind_package(robosc REQUIRED)\n"
        f"robosc_generate(fragment ros2 own {arguments} CONFIG settings/own.json)\n"
        "message(NOTICE made=${fragment})\n",
        encoding="utf-8",
    )
    done = project.configure()
    assert done.returncode == 0, done.stderr
    made = Path(done.stderr.rpartition("made=")[2].strip()).parent
    assert told in (made / "src" / "steward_node.cpp").read_text(encoding="utf-8")
    assert (made / "test" / "traces").is_dir() == arguments.endswith("TESTS")
    assert str(settings.resolve()) in (made / "inputs.txt").read_text(encoding="utf-8").splitlines()
