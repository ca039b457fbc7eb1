"""Results of `robosc test`: the summary, and JUnit XML."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

if TYPE_CHECKING:
    from .conftest import Run

SCENARIOS = """\
// two that pass, and one that fails
before each {
  expect open sent
}

scenario "opens"
  expect close sent

scenario "stays open & \x1b[31mred"
  expect Leaf.opened
  expect close not sent

scenario "closes"
  expect close sent within 1 s
"""


@pytest.fixture
def files(door: Path) -> list[str]:
    """Return the names of a model and of its scenarios."""
    door.with_name("door.scenarios").write_text(SCENARIOS)
    door.with_name("more.scenarios").write_text('scenario "more"\n  expect Leaf.closed or Leaf.opened\n')
    return [door.name, "door.scenarios", "more.scenarios"]


def test_the_summary_names_failed_scenarios_and_counts_all(run: Run, files: list[str]) -> None:
    answer = run("test", *files)
    assert answer.exit_code == 1
    *_, errors, failed, counts = answer.stderr.splitlines()
    assert errors == "2 errors"
    assert failed == 'FAILED door.scenarios:9 "stays open & \\u001b[31mred"'
    assert re.fullmatch(r"1 failed, 3 passed in \d+\.\d\d s", counts)


def test_without_a_failure_the_summary_is_one_line(run: Run, files: list[str]) -> None:
    answer = run("test", files[0], files[2])
    assert (answer.exit_code, answer.stdout) == (0, "")
    assert re.fullmatch(r"1 passed in \d+\.\d\d s\n", answer.stderr)


def test_junit_has_the_file_and_the_line_of_each_scenario(run: Run, files: list[str], tmp_path: Path) -> None:
    assert run("test", *files, "--junit", "results.xml").exit_code == 1
    root = ElementTree.fromstring((tmp_path / "results.xml").read_text())  # noqa: S314
    assert [root.get(name) for name in ("name", "tests", "failures")] == ["robosc test", "4", "1"]
    assert [(suite.get("name"), suite.get("tests"), suite.get("failures")) for suite in root] == [
        ("door.scenarios", "3", "1"),
        ("more.scenarios", "1", "0"),
    ]
    cases = list(root.iter("testcase"))
    assert [(case.get("name"), case.get("file"), case.get("line")) for case in cases] == [
        ("opens", "door.scenarios", "6"),
        ("stays open & \\u001b[31mred", "door.scenarios", "9"),
        ("closes", "door.scenarios", "13"),
        ("more", "more.scenarios", "1"),
    ]
    [failure] = root.iter("failure")
    assert failure.get("message") == "`Leaf.opened` does not hold"
    assert failure.text is not None
    assert "door.scenarios:10:10: error: `Leaf.opened` does not hold [scenario]" in failure.text
    assert "door.scenarios:11:3: error: the request to `Leaf.close` was sent" in failure.text


def test_junit_never_replaces_an_input(run: Run, files: list[str]) -> None:
    answer = run("test", *files, "--junit", files[1])
    assert answer.exit_code == 2
    assert Path(files[1]).read_text() == SCENARIOS


def test_faults_of_the_text_leave_no_results(run: Run, door: Path, tmp_path: Path) -> None:
    (tmp_path / "door.scenarios").write_text('scenario "one"\n  expect\n')
    answer = run("test", door.name, "door.scenarios", "--junit", "results.xml")
    assert (answer.exit_code, answer.stderr) == (1, "1 error\n")
    assert not (tmp_path / "results.xml").exists()


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
@pytest.mark.parametrize("form", ["text", "json"])
def test_the_output_does_not_depend_on_the_number_of_processes(
    run: Run, files: list[str], engine: str, form: str, tmp_path: Path
) -> None:
    answers = []
    for jobs in ("1", "2", "9"):
        options = ["--engine", engine, "--format", form, "--traces", f"traces{jobs}", "--jobs", jobs]
        answers.append(run("test", *files, *options))
    assert [answer.exit_code for answer in answers] == [1, 1, 1]
    outputs = {(answer.stdout, re.sub(r"in [\d.]+ s", "", answer.stderr)) for answer in answers}
    assert len(outputs) == 1
    traces = [
        {path.name: path.read_bytes() for path in (tmp_path / f"traces{jobs}").iterdir()} for jobs in ("1", "2", "9")
    ]
    assert traces[0] == traces[1] == traces[2]
    assert len(traces[0]) == 4


def test_processes_do_not_play_over_ros(run: Run, files: list[str]) -> None:
    answer = run("test", *files, "--ros2", "--jobs", "2")
    assert answer.exit_code == 2
    assert "--ros2 plays one scenario at a time" in answer.output
