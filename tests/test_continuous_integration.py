"""The steps of `action.yml`, each run by bash as on GitHub, and the hooks for pre-commit."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from tests.tools.cli.conftest import DOOR, LAMPS

ROOT = Path(__file__).parent.parent
ACTION: dict[str, Any] = YAML(typ="safe").load(ROOT / "action.yml")
HOOKS: list[dict[str, Any]] = YAML(typ="safe").load(ROOT / ".pre-commit-hooks.yaml")
STEPS = {step["name"]: step for step in ACTION["runs"]["steps"]}

pytestmark = pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")


class Job:
    """A checked-out repository with models, and the steps of the action in it."""

    def __init__(self, folder: Path) -> None:
        self.workspace, self.temporary, self.programs = (folder / name for name in ("work", "temp", "bin"))
        for made in (self.workspace, self.temporary, self.programs):
            made.mkdir()
        robosc = self.programs / "robosc"
        robosc.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m robosc "$@"\n')
        robosc.chmod(0o755)
        self.git("init", "--quiet")
        self.add("door.rscd", DOOR)
        self.add("parts/lamps.rscd", LAMPS)

    def git(self, *arguments: str) -> None:
        subprocess.run(["git", *arguments], cwd=self.workspace, check=True)

    def add(self, name: str, text: str) -> None:
        path = self.workspace / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text)
        self.git("add", "--", name)

    def run(self, name: str, **inputs: str) -> subprocess.CompletedProcess[str]:
        """Run a step like `shell: bash`; the inputs are those of the action."""
        step = STEPS[name]
        given = {key: declared["default"] for key, declared in ACTION["inputs"].items()} | inputs
        expression = re.compile(r"\$\{\{ inputs\.([a-z-]+) \}\}")
        environment = {
            "PATH": f"{self.programs}:{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "RUNNER_TEMP": str(self.temporary),
            "GITHUB_OUTPUT": str(self.temporary / "output"),
            **{key: expression.sub(lambda found: given[found[1]], text) for key, text in step.get("env", {}).items()},
        }
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
        return subprocess.run(command, cwd=self.workspace, env=environment, capture_output=True, text=True, check=False)

    def found(self) -> dict[str, list[str]]:
        return {name: (self.temporary / f"robosc-{name}").read_text().splitlines() for name in ("models", "robots")}

    def outputs(self) -> dict[str, str]:
        return dict(line.split("=", 1) for line in (self.temporary / "output").read_text().splitlines())


@pytest.fixture
def job(tmp_path: Path) -> Job:
    return Job(tmp_path)


def test_models_are_those_that_git_knows(job: Job) -> None:
    (job.workspace / "scratch.rscd").write_text("robot Scratch {}")
    job.add("with spaces/ünder.rscd", DOOR)
    job.add("plant.cif", "plant p: location: initial; marked; end")
    assert job.run("Find models").returncode == 0
    models = ["door.rscd", "parts/lamps.rscd", "plant.cif", "with spaces/ünder.rscd"]
    assert job.found() == {"models": models, "robots": [name for name in models if "lamps" not in name]}


def test_models_that_are_named(job: Job) -> None:
    assert job.run("Find models", models="  parts/lamps.rscd\n\n door.rscd ", robots="door.rscd").returncode == 0
    assert job.found() == {"models": ["parts/lamps.rscd", "door.rscd"], "robots": ["door.rscd"]}


def test_inputs_are_no_commands(job: Job) -> None:
    job.run("Find models", models="$(touch hacked)`touch hacked`\n; touch hacked", robots="door.rscd")
    assert not (job.workspace / "hacked").exists()
    assert all("${{" not in step.get("run", "") for step in STEPS.values())


def test_without_models_it_fails(job: Job) -> None:
    job.git("rm", "--quiet", "--force", "-r", ".")
    done = job.run("Find models")
    assert (done.returncode, done.stdout) == (1, "::error::there are no models: no .rscd or .cif file\n")


@pytest.mark.slow
def test_findings_become_sarif(job: Job) -> None:
    job.run("Find models")
    assert job.run("Check").returncode == 0
    job.add("parts/broken.rscd", DOOR.replace("Leaf.closed", "Leaf.x"))
    job.run("Find models")
    done = job.run("Check")
    assert done.returncode == 1
    assert "parts/broken.rscd:17:" in done.stdout
    log = json.loads(Path(job.outputs()["sarif"]).read_text())
    (result,) = log["runs"][0]["results"]
    (place,) = result["locations"]
    assert place["physicalLocation"]["artifactLocation"]["uri"] == "parts/broken.rscd"


def test_the_layout(job: Job) -> None:
    job.run("Find models")
    assert job.run("Look at the layout").returncode == 0
    job.add("door.rscd", DOOR.replace("  component", " component"))
    done = job.run("Look at the layout")
    assert done.returncode == 1
    assert "+  component Leaf {" in done.stdout
    job.add("-x.rscd", DOOR)
    job.run("Find models", models="-x.rscd")
    assert job.run("Look at the layout").returncode == 0
    job.add("plant.cif", "plant p: location: initial; marked; end")
    job.run("Find models", models="plant.cif")
    assert job.run("Look at the layout").returncode == 0


@pytest.mark.slow
def test_each_robot_is_verified(job: Job) -> None:
    job.add("stuck.rscd", DOOR.replace("initial marked", "initial").replace("needs Leaf.closed", "needs Leaf.opened"))
    job.run("Find models", robots="door.rscd\nstuck.rscd\ndoor.rscd")
    done = job.run("Verify")
    assert done.returncode == 3
    assert done.stdout.count("Door: ") == 2
    folder = Path(job.outputs()["junit"])
    assert sorted(path.name for path in folder.iterdir()) == ["1.xml", "3.xml"]


def test_the_action_is_whole() -> None:
    """The action meets GitHub's rules for composite actions, and its expressions name existing inputs and steps."""
    assert ACTION["runs"]["using"] == "composite"
    for step in STEPS.values():
        assert ("run" in step) != ("uses" in step)
        assert "run" not in step or step["shell"] == "bash"
    text = (ROOT / "action.yml").read_text()
    # File names come after `--`, so that a name with a leading dash is no option.
    assert all(
        " -- " in line
        for line in text.split("\n")
        if re.search(r"\b(robosc|grep) .*(models\[@\]|model\"|robot\")", line)
    )
    assert set(re.findall(r"inputs\.([a-z-]+)", text)) == set(ACTION["inputs"])
    steps = {step["id"] for step in STEPS.values() if "id" in step}
    assert set(re.findall(r"steps\.(\w+)\.", text)) == steps
    for identifier, name in re.findall(r"steps\.(\w+)\.outputs\.(\w+)", text):
        (run,) = [step["run"] for step in STEPS.values() if step.get("id") == identifier]
        assert f'echo "{name}=' in run


def test_the_page_speaks_of_all_inputs_and_hooks() -> None:
    page = (ROOT / "docs" / "continuous-integration.md").read_text()
    assert re.findall(r"^\| `([a-z-]+)` \|", page, re.MULTILINE) == list(ACTION["inputs"])
    assert [hook["id"] for hook in HOOKS] == re.findall(r"- id: (robosc-\w+)", page)


@pytest.mark.slow
@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: hook["id"])
def test_a_hook_runs_and_can_fail(job: Job, hook: dict[str, Any]) -> None:
    """pre-commit runs the entry, then `args`, then the matching staged files."""
    assert hook["language"] == "python"
    program, *words = hook["entry"].split()
    assert program == "robosc"
    staged = [name for name in ("door.rscd", "parts/lamps.rscd", "README.md") if re.search(hook["files"], name)]
    assert staged == ["door.rscd", "parts/lamps.rscd"]
    names = staged if hook.get("pass_filenames", True) else ["door.rscd"]
    door = job.workspace / "door.rscd"
    command = [job.programs / "robosc", *words, *names]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}

    def run() -> tuple[int, bool]:
        before = door.read_text()
        done = subprocess.run(command, cwd=job.workspace, env=environment, capture_output=True, check=False)
        return done.returncode, door.read_text() != before

    assert run() == (0, False)
    door.write_text(DOOR.replace("open needs Leaf.closed", "open  needs Leaf.x"))
    status, changed = run()
    assert bool(status) != changed


def test_the_tests_of_a_file_run_in_one_process(request: pytest.FixtureRequest) -> None:
    """The tests of a file share results; xdist reads the groups before any hook that comes later."""
    if not getattr(request.config.option, "loadgroup", False):
        pytest.skip("only processes of xdist have groups")
    assert request.node.nodeid.endswith(f"@{Path(__file__).name}")
