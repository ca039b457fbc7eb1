"""Behavior of all commands: help that loads no packages, versions, wrong calls, faults of the tool itself."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
import robosc.tools.cli.check
from robosc.base.files import reading as files
from robosc.tools.cli import main

from .conftest import Run

COMMANDS = [
    "new",
    "check",
    "format",
    "rule",
    "diagram",
    "synthesize",
    "explain",
    "verify",
    "report",
    "sweep",
    "simulate",
    "view",
    "test",
    "audit",
    "transform",
    "run",
    "graph",
    "gate",
    "interfaces",
    "lsp",
    "dap",
    "mcp",
]


def loaded_by(*arguments: str) -> set[str]:
    """Return the modules that a call of the command line loads."""
    program = f"""
import sys
from robosc.base.files import reading as files
from robosc.tools.cli import main
try:
    main({arguments!r})
except SystemExit as end:
    assert end.code == 0
print("\\n" + " ".join(sys.modules))
"""
    done = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    return set(done.stdout.splitlines()[-1].split())


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_load_next_to_nothing(option: str) -> None:
    loaded = {name.partition(".")[0] for name in loaded_by(option)}
    assert loaded & {"arpeggio", "jinja2", "oxidd", "pydantic", "pyecore", "rich", "textx"} == set()


def test_check_loads_nothing_that_generates(door: Path) -> None:
    loaded = {name.partition(".")[0] for name in loaded_by("check", str(door))}
    assert loaded & {"jinja2", "oxidd", "pydantic", "rich"} == set()
    assert {"pyecore", "textx"} <= loaded


def test_help_names_all_commands(run: Run) -> None:
    answer = run("--help")
    assert answer.exit_code == 0
    groups, _, epilog = answer.stdout.partition("\nWrite models:\n")[2].partition("\n\n  `robosc COMMAND --help`")
    assert [line.split()[0] for line in groups.splitlines() if re.match(r"  \S", line)] == COMMANDS
    assert {"docs/index.md", "Shell completion:"} <= set(re.findall(r"docs/index\.md|Shell completion:", epilog))


def test_a_command_that_is_not_there_is_named_with_the_one_meant(run: Run) -> None:
    answer = run("chekc", "x.rscd")
    assert answer.exit_code == 2
    assert "No such command 'chekc'. Did you mean 'check'?" in answer.stderr


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_examples(run: Run, command: str) -> None:
    answer = run(command, "--help")
    assert answer.exit_code == 0
    assert f"  robosc {command} " in answer.stdout.partition("Examples:\n")[2]


def test_version(run: Run) -> None:
    assert run("--version").stdout == f"robosc, version {robosc.__version__}\n"


@pytest.mark.parametrize("call", [(), ("fly",), ("check",), ("check", "--colour", "x"), ("transform", "door.rscd")])
def test_a_wrong_call(run: Run, door: Path, call: tuple[str, ...]) -> None:  # noqa: ARG001
    assert run(*call).exit_code == 2


@pytest.mark.parametrize("command", [("check",), ("synthesize",), ("transform", "--to", "xmi")])
def test_a_file_that_is_not_there(run: Run, command: tuple[str, ...]) -> None:
    answer = run(*command, "missing.rscd")
    assert answer.exit_code == 2
    assert "'missing.rscd' does not exist" in answer.stderr
    assert run(*command, ".").exit_code == 2


def test_a_file_that_goes_while_it_is_read(run: Run, door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(path: Path, **_: object) -> bytes:
        raise FileNotFoundError(2, "No such file or directory", str(path))

    monkeypatch.setattr(files, "read", gone)
    answer = run("check", door)
    assert answer.exit_code == 2
    assert answer.stderr == f"Error: {door}: No such file or directory\n"


def raising(error: BaseException, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make `check` raise an error."""

    def command(models: object, **_: object) -> None:  # noqa: ARG001
        raise error

    monkeypatch.setattr(robosc.tools.cli.check.command, "callback", command)


def test_a_fault_of_the_tool_is_no_traceback(run: Run, door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    raising(KeyError("unforeseen"), monkeypatch)
    answer = run("check", door)
    assert answer.exit_code == 70
    assert "please report it: KeyError: 'unforeseen'" in answer.stderr
    assert "Traceback" not in answer.output
    assert "Traceback" in run("--traceback", "check", door).stderr
    monkeypatch.setenv("ROBOSC_TRACEBACK", "1")
    assert "Traceback" in run("check", door).stderr


def test_too_little_memory_is_no_fault(run: Run, door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    raising(MemoryError("no room"), monkeypatch)
    answer = run("check", door)
    assert answer.exit_code == 2
    assert "no room" in answer.stderr


def test_an_interruption(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    raising(KeyboardInterrupt(), monkeypatch)
    answer = CliRunner().invoke(main, ["check", str(door)])
    assert answer.exit_code == 130


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full on this system")
def test_an_output_that_can_not_be_written(door: Path) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "robosc", "synthesize", door],
            check=False,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert done.returncode == 2
    assert "No space left on device" in done.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="there is no sh")
@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
@pytest.mark.parametrize("command", ["check", "synthesize", "simulate", "simulate --script -"])
def test_closed_streams(door: Path, command: str, closed: str) -> None:
    name, *options = command.split()
    call = [sys.executable, "-m", "robosc", name, door, *options]
    done = subprocess.run(
        ["/bin/sh", "-c", f'exec "$@" {closed}', "sh", *call],
        check=False,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0
    assert "Traceback" not in done.stderr


def test_a_reader_that_has_read_enough(door: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "robosc", "synthesize", door], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == ""


@pytest.mark.parametrize(
    ("call", "hint"),
    [
        (("door.rscd",), "Did you mean 'robosc check door.rscd'?"),
        (("check", "dor.rscd"), "Did you mean 'door.rscd'?"),
        (("transform", "door.rscd", "--to", "ros2", "ros1"), "write `--to ros2,ros1`"),
        (("transform", "door.rscd", "--to=ros2", "cif", "ros1"), "write `--to ros2,cif,ros1`"),
        (("explain", "door.rscd", "--event", "open", "--state", "Leaf=closed;x=1"), "commas: `Leaf=closed,x=1`"),
    ],
)
def test_a_wrong_call_has_a_hint(run: Run, door: Path, call: tuple[str, ...], hint: str) -> None:  # noqa: ARG001
    answer = run(*call)
    assert answer.exit_code == 2
    assert hint in answer.stderr


def test_export_needs_no_server(door: Path) -> None:
    """Writing the page as files requires no server packages."""
    program = f"""
import sys
sys.modules["starlette"] = sys.modules["uvicorn"] = None
from robosc.tools.cli import main
main(["view", {str(door)!r}, "--export", "page"])
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=door.parent, capture_output=True, text=True, check=False)
    assert "starlette" not in done.stderr
    assert done.returncode == 0 or "the page has not been built" in done.stderr, done.stderr
