"""`check --watch` and `test --watch` react to each change of their inputs once, until an interrupt; no test waits."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from robosc.tools.cli import file_watch

from .conftest import LAMPS, Run

Step = Callable[[], object]


@pytest.fixture
def meanwhile(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """`meanwhile(step, ...)` performs the next step whenever the watch would sleep; after the last, Ctrl-C."""

    def prepare(*steps: Step) -> None:
        left: Iterator[Step] = iter(steps)

        def sleep(_: float) -> None:
            step = next(left, None)
            if step is None:
                raise KeyboardInterrupt
            step()

        monkeypatch.setattr(file_watch.time, "sleep", sleep)

    return prepare


def changing(path: Path, old: str, new: str) -> Step:
    return lambda: path.write_text(path.read_text().replace(old, new))


def rounds(said: str) -> list[list[str]]:
    """Return the output of each round, without its first and last line."""
    parts = said.split("waiting for changes; stop with Ctrl-C\n")
    assert parts[-1] == ""
    return [part.splitlines() for part in parts[:-1]]


def test_each_change_is_checked_once(run: Run, broken: Path, meanwhile: Callable[..., None]) -> None:
    meanwhile(
        changing(broken, "Leaf.x", "Leaf.closed"),
        lambda: None,
        changing(broken, "initial marked state opened", "marked state opened"),
        changing(broken, "marked state opened", "initial marked state opened"),
    )
    answer = run("check", broken.name, "--watch")
    assert answer.exit_code == 130
    assert rounds(answer.stderr) == [
        ["checking broken.rscd", "2 errors"],
        ["checking broken.rscd: broken.rscd changed", "1 error"],
        ["checking broken.rscd: broken.rscd changed", "no errors"],
        ["checking broken.rscd: broken.rscd changed", "1 error"],
    ]
    assert answer.stdout.count("[initial-state]") == 3
    assert answer.stdout.count("[unresolved-reference]") == 1


def test_without_a_change_nothing_is_checked_again(run: Run, door: Path, meanwhile: Callable[..., None]) -> None:
    meanwhile(*[lambda: None] * 5)
    assert rounds(run("check", door.name, "--watch").stderr) == [["checking door.rscd", "no errors"]]


def test_a_file_that_goes_and_comes_again(run: Run, door: Path, meanwhile: Callable[..., None]) -> None:
    """An editor may save like this: the name disappears for a moment, then it is another file."""
    other = door.with_name("door.rscd~")
    meanwhile(lambda: door.rename(other), lambda: other.rename(door))
    assert rounds(run("check", door.name, "--watch").stderr) == [
        ["checking door.rscd", "no errors"],
        ["checking door.rscd: door.rscd changed", "door.rscd: No such file or directory"],
        ["checking door.rscd: door.rscd changed", "no errors"],
    ]


def test_a_library_that_is_changed_or_appears(run: Run, courier: Path, meanwhile: Callable[..., None]) -> None:
    library = courier.parent / "parts" / "lamps.rscd"
    library.unlink()
    meanwhile(
        lambda: library.write_text(LAMPS),
        changing(library, "incoming message light", "incoming message lamp"),
        changing(library, "incoming message lamp", "incoming message light"),
    )
    answer = run("check", courier.name, "--watch", "-I", "parts")
    assert answer.exit_code == 130
    assert rounds(answer.stderr) == [
        ["checking courier.rscd", "1 error, 1 warning"],
        ["checking courier.rscd: parts/lamps.rscd changed", "1 warning", "no errors"],
        ["checking courier.rscd: parts/lamps.rscd changed", "1 error, 1 warning"],
        ["checking courier.rscd: parts/lamps.rscd changed", "1 warning", "no errors"],
    ]


def test_a_definition_of_ros_that_is_changed(run: Run, tmp_path: Path, meanwhile: Callable[..., None]) -> None:
    definition = tmp_path / "ros" / "yard_msgs" / "msg" / "Gate.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("bool closed\n")
    file = tmp_path / "yard.rscd"
    file.write_text(
        "robot Yard { component Gate { outgoing message gate with type: yard_msgs/Gate behaviour {"
        " variable shut: boolean initial marked state s { on response from gate do shut := value.closed } } } }"
    )
    meanwhile(lambda: definition.write_text("bool is_closed\n"))
    answer = run("check", file.name, "--watch", "--interface-path", "ros")
    first, second = rounds(answer.stderr)
    assert first == ["checking yard.rscd", "no errors"]
    assert second == ["checking yard.rscd: ros/yard_msgs/msg/Gate.msg changed", "1 error"]


@pytest.mark.skipif(sys.platform == "win32", reason="signals are not sent there")
def test_ctrl_c_ends_it_without_a_word(door: Path) -> None:
    program = [sys.executable, "-m", "robosc", "check", door.name, "--watch"]
    with subprocess.Popen(program, cwd=door.parent, stdout=-1, stderr=-1, text=True) as process:
        assert process.stderr is not None
        said = [process.stderr.readline() for _ in range(3)]
        os.kill(process.pid, signal.SIGINT)
        rest = process.stderr.read()
    assert process.returncode == 130
    assert said[-1] == "waiting for changes; stop with Ctrl-C\n"
    assert rest == ""


OPENS = """\
scenario "opens"
  expect open sent
"""


def lines_without_time(said: str) -> list[list[str]]:
    return [[line.partition(" in ")[0] for line in lines] for lines in rounds(said)]


def test_scenarios_are_played_again_after_each_change_of_an_input(
    run: Run, door: Path, meanwhile: Callable[..., None]
) -> None:
    scenarios = door.with_name("door.scenarios")
    scenarios.write_text(OPENS)
    settings = door.with_name("controller-config.json")
    meanwhile(
        changing(scenarios, "open sent", "open not sent"),
        lambda: None,
        lambda: settings.write_text('{"controlLoop": {"periodMs": 1000}}'),
        lambda: settings.write_text('{"controlLoop": {"periodMs": "long"}}'),
        settings.unlink,
        changing(scenarios, "open not sent", "open sent twice"),
        changing(scenarios, "open sent twice", "open sent"),
        changing(door, "open needs Leaf.closed", "open needs Leaf.opened"),
    )
    answer = run("test", door.name, scenarios.name, "--watch")
    assert answer.exit_code == 130
    failed = ["1 error", 'FAILED door.scenarios:1 "opens"', "1 failed"]
    first, *others = lines_without_time(answer.stderr)
    assert first == ["testing door.rscd", "1 passed"]
    assert [(line.removeprefix("testing door.rscd: "), *rest) for line, *rest in others] == [
        ("door.scenarios changed", *failed),
        ("controller-config.json changed", *failed),
        ("controller-config.json changed", "1 error"),
        ("controller-config.json changed", *failed),
        ("door.scenarios changed", "1 error"),
        ("door.scenarios changed", "1 passed"),
        ("door.rscd changed", "1 error, 3 warnings", *failed[1:]),
    ]


def test_a_library_that_changes_is_tested_again(run: Run, courier: Path, meanwhile: Callable[..., None]) -> None:
    library = courier.parent / "parts" / "lamps.rscd"
    courier.with_name("courier.scenarios").write_text('scenario "one"\n  expect light not sent\n')
    meanwhile(changing(library, "incoming message light", "incoming message lamp"))
    answer = run("test", courier.name, "courier.scenarios", "--watch", "-I", "parts")
    assert answer.exit_code == 130
    assert [lines[0] for lines in rounds(answer.stderr)] == [
        "testing courier.rscd",
        "testing courier.rscd: parts/lamps.rscd changed",
    ]


def test_a_call_that_cannot_be_executed_does_not_end_the_watch(
    run: Run, door: Path, meanwhile: Callable[..., None]
) -> None:
    door.with_name("door.scenarios").write_text(OPENS)
    meanwhile(lambda: door.write_text("library Doors {}\n"))
    answer = run("test", door.name, "door.scenarios", "--watch")
    assert answer.exit_code == 130
    assert rounds(answer.stderr)[1][:2] == [
        "testing door.rscd: door.rscd changed",
        "Error: door.rscd has a library: only a robot that imports it has a supervisor",
    ]
