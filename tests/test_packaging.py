"""The wheel has all that the tool needs: installed elsewhere it generates the same bytes as the repository does."""

import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
MODEL = ROOT / "examples" / "line_follower"
TARGETS = "cif,supervisor,ros1,ros2,xmi"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, ROOT, cwd=folder)
    (built,) = folder.glob("*.whl")
    return built


def run(*command: str | Path, cwd: Path) -> str:
    """What a command says, in a folder and an environment that know nothing of the repository."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ROBOSC", "VIRTUAL"))}
    done = subprocess.run(command, cwd=cwd, env=kept, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_what_is_in_the_wheel(wheel: Path) -> None:
    inside = set(zipfile.ZipFile(wheel).namelist())
    shipped = {
        "cmake": ("*", "robosc/cmake"),
        "grammar": ("*.tx", "robosc/grammar"),
        "metamodel": ("*.ecore", "robosc/metamodel"),
        "docs/rules": ("*.md", "robosc/docs/rules"),
        "robosc": ("*", "robosc"),
    }
    for folder, (pattern, place) in shipped.items():
        here = [
            path.relative_to(ROOT / folder).as_posix()
            for path in (ROOT / folder).rglob(pattern)
            if path.is_file() and "__pycache__" not in path.parts
        ]
        assert here
        assert {f"{place}/{name}" for name in here} - inside == set()
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert version["requires-python"] == ">=3.11"
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in inside)
    assert not any(name.startswith(("tests/", "examples/")) for name in inside)


def test_the_installed_wheel_generates_the_same(wheel: Path, tmp_path: Path) -> None:
    run(sys.executable, "-m", "venv", "--without-pip", "environment", cwd=tmp_path)
    programs = tmp_path / "environment" / "bin"
    run(sys.executable, "-m", "pip", "--python", programs / "python", "install", "--quiet", wheel, cwd=tmp_path)
    model = tmp_path / "elsewhere"
    model.mkdir()
    for path in MODEL.glob("*"):
        if path.suffix in (".rscd", ".json"):
            (model / path.name).write_bytes(path.read_bytes())
    where = run(programs / "python", "-c", "import robosc; print(robosc.__file__)", cwd=model)
    assert Path(where).is_relative_to(tmp_path)
    run(programs / "robosc", "transform", "line_follower.rscd", "--to", TARGETS, "-o", "out", cwd=model)
    run(programs / "robosc", "rule", "marked-state", cwd=model)
    packages = Path(run(programs / "robosc", "--cmake-dir", cwd=model).strip())
    assert packages.is_relative_to(tmp_path)
    assert (packages / "robosc" / "robosc-config.cmake").exists()
    here = tmp_path / "here"
    run(
        sys.executable, "-m", "robosc", "transform", MODEL / "line_follower.rscd", "--to", TARGETS, "-o", here, cwd=ROOT
    )
    installed, editable = files(model / "out"), files(here)
    assert list(installed) != []
    assert installed.keys() == editable.keys()
    assert [name for name in editable if installed[name] != editable[name]] == []
