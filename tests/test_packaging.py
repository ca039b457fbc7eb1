"""The wheel is complete: installed elsewhere, it generates the same bytes as the repository."""

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from robosc.tools.mcp.pages import pages

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
MODEL = ROOT / "examples" / "line_follower"
TARGETS = "cif,supervisor,ros1,ros2,xmi"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    # Another test, with the source distribution, checks that the build requirements are complete.
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder]
    run(sys.executable, "-m", "pip", "wheel", *options, ROOT, cwd=folder)
    (built,) = folder.glob("*.whl")
    return built


def run(*command: str | Path, cwd: Path) -> str:
    """Return the output of a command in a folder and an environment without access to the repository."""
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
    assert {f"robosc/{page.name}" for page in pages()} - inside == set()
    pages_and_examples = ("robosc/docs/", "robosc/examples/")
    entries = zipfile.ZipFile(wheel).infolist()
    assert sum(entry.compress_size for entry in entries if entry.filename.startswith(pages_and_examples)) < 500_000
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert version["requires-python"] == ">=3.11"
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in inside)
    assert not any(name.startswith(("tests/", "examples/")) for name in inside)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("build", reason="the packages of [release] are not installed")
    folder = tmp_path_factory.mktemp("source")
    run(sys.executable, "-m", "build", "--sdist", "--no-isolation", "--outdir", folder, ROOT, cwd=folder)
    (built,) = folder.glob("*.tar.gz")
    return built


def test_the_sdist_makes_the_same_wheel(source: Path, wheel: Path, tmp_path: Path) -> None:
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", tmp_path, source, cwd=tmp_path)
    (again,) = tmp_path.glob("*.whl")

    def contents(path: Path) -> dict[str, int]:
        return {entry.filename: entry.CRC for entry in zipfile.ZipFile(path).infolist()}

    assert contents(again) == contents(wheel)


def test_registries_take_what_is_built(source: Path, wheel: Path, tmp_path: Path) -> None:
    pytest.importorskip("twine", reason="the packages of [release] are not installed")
    run(sys.executable, "-m", "twine", "check", "--strict", source, wheel, cwd=tmp_path)


def test_the_dockerfiles_are_in_order() -> None:
    pytest.importorskip("build", reason="the packages of [release] are not installed")
    files = sorted((ROOT / "docker").glob("*.Dockerfile"))
    assert [path.stem for path in files] == ["humble", "jazzy"]
    run(Path(sys.executable).with_name("hadolint"), *files, cwd=ROOT)


def test_a_release_needs_its_section_in_the_changelog(tmp_path: Path) -> None:
    """Without `--trial`, a missing section or uncommitted changes end the script before it builds anything."""
    for name in ("scripts/release", "scripts/environment", "robosc/__init__.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "CHANGELOG.md").write_text("## 0.0.1, unreleased\n")
    for command in (["init", "--quiet"], ["add", "."]):
        run("git", *command, cwd=tmp_path)
    run("git", "-c", "user.name=A", "-c", "user.email=a@b.c", "commit", "--quiet", "-m", "Begin", cwd=tmp_path)
    done = subprocess.run([tmp_path / "scripts" / "release"], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "CHANGELOG.md has no section" in done.stderr
    (tmp_path / "CHANGELOG.md").write_text("## 0.1.0, 2026-11-25\n")
    done = subprocess.run([tmp_path / "scripts" / "release"], capture_output=True, text=True, check=False)
    assert "there are changes that are not committed" in done.stderr


def test_the_installed_wheel_generates_the_same(wheel: Path, tmp_path: Path) -> None:
    run(sys.executable, "-m", "venv", "--without-pip", "environment", cwd=tmp_path)
    programs = tmp_path / "environment" / "bin"
    install = [sys.executable, "-m", "pip", "--python", programs / "python", "install", "--quiet", "--no-compile"]
    run(*install, wheel, cwd=tmp_path)
    model = tmp_path / "elsewhere"
    model.mkdir()
    for path in MODEL.glob("*"):
        if path.suffix in (".rscd", ".json"):
            (model / path.name).write_bytes(path.read_bytes())
    where = run(programs / "python", "-c", "import robosc; print(robosc.__file__)", cwd=model)
    assert Path(where).is_relative_to(tmp_path)
    run(programs / "robosc", "transform", "line_follower.rscd", "--to", TARGETS, "-o", "out", cwd=model)
    run(programs / "robosc", "rule", "marked-state", cwd=model)
    listed = "from robosc.tools.mcp.pages import pages; print(*(page.name for page in pages()))"
    assert run(programs / "python", "-c", listed, cwd=model).split() == [page.name for page in pages()]
    if any((ROOT / "robosc" / "tools" / "view" / "built").glob("page.js")):
        run(*install, f"{wheel}[view]", cwd=model)
        assert "smoke test passed" in run(ROOT / "scripts" / "smoke", tmp_path / "environment", cwd=model)
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
