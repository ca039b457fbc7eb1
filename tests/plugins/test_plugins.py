"""The example packages add a target and a synthesizer when a user installs them; broken packages are reported."""

import json
import os
import subprocess
import sys
from pathlib import Path
from random import Random

import pytest
from click import Context
from click.testing import CliRunner

import robosc
from robosc.base import extensions
from robosc.engine import Engine
from robosc.language.configuration import Configuration
from robosc.m2t.models import Models
from robosc.model.semantics.roles import event_name
from robosc.tools.cli import main
from tests.examples.conftest import MODELS, models_of
from tests.m2t.supervisor import corners
from tests.m2t.supervisor.test_supervisor import dock
from tests.tools.cli.conftest import not_longer_than
from tests.tools.debugger.client import Program

from .structured_text import Block

ROOT = Path(__file__).parents[2]
PLUGINS = ROOT / "examples" / "plugins"
LINE_FOLLOWER = MODELS["line_follower"]


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder into which pip has installed both packages without a network."""
    folder = tmp_path_factory.mktemp("installed")
    source = tmp_path_factory.mktemp("source")
    for name in ("robosc-structured-text", "robosc-faudes"):
        subprocess.run(["cp", "-r", PLUGINS / name, source / name], check=True)
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
        subprocess.run([*command, "--target", folder, source / name], check=True)
    return folder


def tool(installed: Path, *arguments: object, status: int = 0) -> str:
    """Run the tool with the packages installed; return its standard output."""
    done = subprocess.run(
        [sys.executable, "-m", "robosc", *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": f"{ROOT}:{installed}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout if status == 0 else done.stdout + done.stderr


@pytest.mark.slow
def test_a_target_of_another_package_is_listed_and_generates(installed: Path, tmp_path: Path) -> None:
    assert "structured-text the supervisor as a function block" in tool(installed, "transform", "--help")
    out = tmp_path / "out"
    tool(installed, "transform", MODELS["line_stepper"], "--to", "structured-text,cif", "-o", out)
    text = (out / "structured-text" / "LineStepper.st").read_text()
    assert "FUNCTION_BLOCK FB_LineStepper\n" in text
    assert (out / "LineStepper.cif").exists()
    assert "a time has no form in the function block [structured-text]" in tool(
        installed, "transform", ROOT / "tests/analysis/verify/patrol.rscd", "--to", "structured-text", status=1
    )


def test_the_example_is_short() -> None:
    text = (PLUGINS / "robosc-structured-text" / "robosc_structured_text" / "__init__.py").read_text()
    assert len(text.splitlines()) <= 300


@pytest.mark.slow
def test_another_synthesizer_is_verified(installed: Path) -> None:
    pytest.importorskip("faudes")
    said = json.loads(tool(installed, "verify", LINE_FOLLOWER, "--synthesizer", "faudes", "--json"))
    outcomes = {verdict["property"]: verdict["outcome"] for verdict in said["properties"]}
    assert said["proved"]
    assert outcomes["maximal permissiveness"] == "proved"


@pytest.mark.slow
def test_another_synthesizer_finds_as_many_states(installed: Path) -> None:
    pytest.importorskip("faudes")
    both = [
        json.loads(tool(installed, "synthesize", LINE_FOLLOWER, "--json", *other))
        for other in ((), ("--synthesizer", "faudes"))
    ]
    assert both[0]["controlled_states"] == both[1]["controlled_states"] == 96
    enabled = [{event["name"]: event["ever_enabled"] for event in answer["events"]} for answer in both]
    assert enabled[0] == enabled[1]


def test_a_synthesizer_that_is_not_installed() -> None:
    done = CliRunner().invoke(main, ["synthesize", str(LINE_FOLLOWER), "--synthesizer", "none_such"])
    assert done.exit_code == 2
    assert "'none_such' is not an installed synthesizer" in done.stderr


@pytest.fixture
def broken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Install a package with one module that violates the interface."""

    def install(group: str, text: str) -> Path:
        site = tmp_path / "site"
        info = site / "robosc_broken-1.0.dist-info"
        info.mkdir(parents=True)
        (site / "robosc_broken.py").write_text(text)
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: robosc-broken\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text(f"[{group}]\n\nbroken = robosc_broken\n")
        (info / "RECORD").write_text("robosc_broken-1.0.dist-info/entry_points.txt,,\nrobosc_broken.py,,\n")
        monkeypatch.syspath_prepend(str(site))
        monkeypatch.delitem(sys.modules, "robosc_broken", raising=False)
        extensions.extensions.cache_clear()
        return info / "entry_points.txt"

    yield install
    extensions.extensions.cache_clear()
    sys.modules.pop("robosc_broken", None)


TARGET = "def preconditions(models, configuration):\n    return []\n\n\ndef generate(models, configuration):\n    "
TARGETS = {
    "import none_such_module\n": "ModuleNotFoundError: No module named 'none_such_module'",
    "x = (": "SyntaxError",
    "def generate(models, configuration):\n    return {}\n": "`robosc_broken` has no function `preconditions`",
    f"{TARGET}return {{}}['x']\n": "KeyError: 'x'",
    f"{TARGET}return {{'../out': ''}}\n": "it returns '../out', which is not a relative path with a text",
    f"{TARGET}return {{'file': b''}}\n": "it returns 'file', which is not a relative path with a text",
}


@pytest.mark.parametrize("text", TARGETS)
def test_a_broken_target_is_a_finding(broken, text: str, tmp_path: Path) -> None:
    file = broken("robosc.targets", text)
    arguments = ["transform", str(LINE_FOLLOWER), "--to", "broken", "--format", "json", "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 1, done.output
    [finding] = [found for found in json.loads(done.stdout) if found["severity"] == "error"]
    assert (finding["rule"], finding["file"], finding["line"]) == ("extension", str(file), 3)
    assert f"`broken` of robosc-broken 1.0 does not work: {TARGETS[text]}" in finding["message"]
    assert not (tmp_path / "out").exists()


SYNTHESIZER = "from robosc.model import sct\n\n\ndef synthesize(model):\n    "
SYNTHESIZERS = {
    f"{SYNTHESIZER}return None\n": ("empty-supervisor", "the supervisor is empty: `broken` finds no supervisor"),
    f"{SYNTHESIZER}return 3\n": ("extension", "it returns a int, not a supervisor"),
    f"{SYNTHESIZER}return sct.Supervisor()\n": ("extension", "and it has none for `"),
    f"{SYNTHESIZER}raise ValueError('too large')\n": ("extension", "ValueError: too large"),
}


@pytest.mark.parametrize("text", SYNTHESIZERS)
def test_a_broken_synthesizer_is_a_finding(broken, text: str) -> None:
    broken("robosc.synthesizers", text)
    done = CliRunner().invoke(main, ["synthesize", str(LINE_FOLLOWER), "--synthesizer", "broken"])
    rule, message = SYNTHESIZERS[text]
    assert done.exit_code == (3 if rule == "empty-supervisor" else 1), done.output
    assert f"[{rule}]" in done.stderr
    assert message in done.stderr


@pytest.mark.build
def test_verify_refutes_a_supervisor_that_allows_too_much(broken) -> None:
    all_allowed = (
        f"{SYNTHESIZER}events = [event for plant in model.plants for event in plant.events if event.controllable]\n"
        "    return sct.Supervisor(guards=[sct.EventGuard(event=event) for event in events])\n"
    )
    broken("robosc.synthesizers", all_allowed)
    done = CliRunner().invoke(main, ["verify", str(LINE_FOLLOWER), "--synthesizer", "broken", "--json"])
    assert done.exit_code == 1, done.output
    verdicts = json.loads(done.stdout)["properties"]
    refuted = [verdict["property"] for verdict in verdicts if verdict["outcome"] == "refuted"]
    assert any(name.startswith("requirement move needs") for name in refuted)


#: Synthesizer whose robot never moves, although it could.
SHY = (
    f"{SYNTHESIZER}from robosc.model import expression\n"
    "    from robosc.model.semantics.roles import event_name\n"
    "    from robosc.synthesis import synthesize\n"
    "    found = synthesize(model).supervisor\n"
    "    for guard in found.guards:\n"
    "        if event_name(guard.event) == 'message_move.c_trigger':\n"
    "            guard.synthesis = expression.BooleanLiteral(value=False)\n"
    "    return found\n"
)
STATE = "LineDetector=following,Lidar=free,EmergencyStop=in_service"


def test_the_supervisor_of_another_tool_is_explained(broken) -> None:
    broken("robosc.synthesizers", SHY)
    asked = ["explain", str(LINE_FOLLOWER), "--event", "move", "--state", STATE]
    ours, other = (CliRunner().invoke(main, [*asked, *more]).stdout for more in ((), ("--synthesizer", "broken")))
    assert ours.startswith("The request to `Platform.move` can happen here.")
    assert other.startswith(
        "The request to `Platform.move` cannot happen here: only this supervisor forbids it; the robot, the"
        " requirements and synthesis allow it."
    )
    assert "From here, the robot reaches no state where it can happen." in other
    done = CliRunner().invoke(main, ["explain", str(LINE_FOLLOWER), "--why-never", "move", "--synthesizer", "broken"])
    assert done.stdout.startswith("The request to `Platform.move` can never happen.\n\nThe nearest state where only")
    assert "leave out" not in done.stdout


def test_an_empty_supervisor_of_another_tool_is_told(broken) -> None:
    broken("robosc.synthesizers", f"{SYNTHESIZER}return None\n")
    done = CliRunner().invoke(main, ["explain", str(LINE_FOLLOWER), "--why-empty", "--synthesizer", "broken"])
    assert done.exit_code == 3
    assert "`broken` finds no supervisor" in done.stderr


def test_the_debugger_takes_another_synthesizer(broken, tmp_path: Path) -> None:
    packages = broken("robosc.synthesizers", SHY).parents[1]
    with not_longer_than(120):
        program = Program(tmp_path, "--synthesizer", "broken", packages=packages)
        program.launch(LINE_FOLLOWER)
        for text in ("pressed false", "continue", "correction 0.1", 'scan "clear"', "component_Lidar.c_tau1"):
            program.console(text)
        move = program.scope("Cannot happen")["message_move.c_trigger"]
        assert program.children(move)["supervisor"]["value"].startswith("only this supervisor forbids it")
        program.do("disconnect")
        assert program.end() == (0, "")


#: Commands that need a supervisor.
SYNTHESIZING = (
    *("synthesize", "transform", "verify", "explain", "simulate", "test"),
    *("run", "gate", "audit", "view", "report", "dap"),
)


def test_every_command_that_synthesizes_takes_another_synthesizer() -> None:
    taking = {
        name
        for name in main.list_commands(Context(main))
        if any("--synthesizer" in option.opts for option in main.get_command(Context(main), name).params)
    }
    assert taking == set(SYNTHESIZING)
    told = [f"`{name}`" for name in SYNTHESIZING]
    sentence = f"{', '.join(told[:-1])} and {told[-1]} take `--synthesizer NAME`"
    assert [sentence in (ROOT / "docs" / page).read_text() for page in ("cli.md", "extending.md")] == [True, True]


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(corners.swap, marks=pytest.mark.slow),
        pytest.param(corners.names, marks=pytest.mark.slow),
        corners.data,
        corners.cancel_and_trigger,
        pytest.param(dock, marks=pytest.mark.slow),
    ],
)
def test_the_function_block_does_what_the_engine_does(make, monkeypatch: pytest.MonkeyPatch) -> None:
    follow(make(), monkeypatch)


@pytest.mark.slow
def test_the_function_block_of_an_example(monkeypatch: pytest.MonkeyPatch) -> None:
    follow(models_of("maze_solver").sct, monkeypatch)


def follow(model, monkeypatch: pytest.MonkeyPatch) -> None:
    """Check that both engines behave the same for 300 random events."""
    monkeypatch.syspath_prepend(str(PLUGINS / "robosc-structured-text"))
    import robosc_structured_text  # noqa: PLC0415  # it is found here only

    random = Random(7)  # noqa: S311
    [text] = robosc_structured_text.generate(Models(model), Configuration()).values()
    engine, executed, block = Engine(model), robosc.to_engine(model), Block(text)
    names = [event.name for event in executed.events]
    carried = robosc_structured_text._Names(executed)
    events = {event_name(event): event for event in engine.roles.events}
    block.call({"event": -1})
    for _ in range(300):
        assert [block.variables["enabled"][number] for number in range(len(names))] == [
            engine.enabled(name) for name in names
        ]
        number = random.randrange(len(names))
        given = {}
        for declared in executed.events[number].inputs:
            code = random.randint(declared.minimum, declared.maximum)
            given[declared] = code
        data = {declared.input.name: _shown(declared.input.type, code) for declared, code in given.items()}
        happened = engine.perform(names[number], data)
        assert events[names[number]]
        block.call({"event": number, **{carried[declared]: _raw(declared, code) for declared, code in given.items()}})
        assert block.variables["happened"] == happened
        cells = dict(zip(executed.variables, engine.state.cells, strict=True))
        assert {variable: int(block.variables[carried[variable]]) for variable in cells} == cells


def _shown(kind, code: int):
    if hasattr(kind, "enumeration"):
        return kind.enumeration.literals[code].name
    return code if hasattr(kind, "minimum") else bool(code)


def _raw(declared, code: int):
    return bool(code) if type(declared.type).__name__ == "BooleanType" else code
