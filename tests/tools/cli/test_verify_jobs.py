"""`robosc verify` in several processes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import robosc.analysis.supervise
from robosc.analysis.verify import PARTS
from robosc.synthesis import Strategy, Tuning
from robosc.tools.cli import verify as command
from robosc.tools.cli.options import Paths
from robosc.tools.workers import completed

from .conftest import DOOR

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .conftest import Run


def without_seconds(text: str) -> str:
    return re.sub(r"\d+\.\d+", "", text)


@pytest.mark.build
@pytest.mark.parametrize("more", [[], ["--json"]])
def test_the_output_does_not_depend_on_the_number_of_processes(run: Run, door: Path, more: list[str]) -> None:
    door.write_text(DOOR.replace("  requirement", "  property never Leaf.opened\n  requirement"))
    answers = [run("verify", door, "--jobs", jobs, "--junit", f"{jobs}.xml", *more) for jobs in ("1", "2")]
    assert [answer.exit_code for answer in answers] == [1, 1]
    assert without_seconds(answers[0].stdout) == without_seconds(answers[1].stdout)
    assert answers[0].stderr == answers[1].stderr
    assert "refuted" in answers[1].stdout
    assert "loop-translation" in answers[1].stdout
    results = [without_seconds(Path(f"{jobs}.xml").read_text()) for jobs in ("1", "2")]
    assert results[0] == results[1]


def test_findings_and_an_empty_supervisor_are_those_of_one_process(run: Run, stuck: Path, broken: Path) -> None:
    for file, status in ((stuck, 3), (broken, 1)):
        answers = [run("verify", file, "--jobs", jobs) for jobs in ("1", "2")]
        assert [answer.exit_code for answer in answers] == [status, status]
        assert answers[0].output == answers[1].output


def test_each_process_synthesizes_with_the_tuning_of_the_call(monkeypatch: pytest.MonkeyPatch, door: Path) -> None:
    tunings = []
    supervise = robosc.analysis.supervise.supervise

    def observed(*arguments: Any, **options: Any) -> Any:
        tunings.append(options["tuning"])
        return supervise(*arguments, **options)

    monkeypatch.setattr("robosc.analysis.supervise.supervise", observed)
    tuning = Tuning("text", Strategy.BACKWARD)
    verdicts = command._part((str(door), None, Paths(), tuning, 0, next(iter(PARTS))))
    assert tunings == [tuning]
    assert verdicts


@pytest.mark.parametrize(
    ("action", "most"), [("verify", len(PARTS)), ("test", 2)], ids=["one process a part", "one process a scenario"]
)
def test_no_process_is_without_work(
    action: str, most: int, run: Run, door: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers: list[int] = []

    def in_this_process(work: Any, tasks: list[Any], jobs: int) -> Iterator[tuple[Any, Any]]:
        numbers.append(jobs)
        return completed(work, tasks, 1)

    monkeypatch.setattr(f"robosc.tools.cli.{action}.completed", in_this_process)
    Path("door.scenarios").write_text('scenario "a"\n  expect open sent\nscenario "b"\n  expect open sent\n')
    files = [door, "door.scenarios"] if action == "test" else [door]
    assert run(action, *files, "--jobs", "64").exit_code == 0
    assert numbers == [most]
