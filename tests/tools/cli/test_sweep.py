"""`robosc sweep`: jobs, results, resumption, interrupts, and a cluster whose worker is killed."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.base.files.resources import locate
from robosc.tools.sweep.jobs import perform

from .conftest import DOOR

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.tools.sweep.jobs import Job

    from .conftest import Run

#: Two buffers that hold `places` parts at most. The supervised system has (places + 1)^2 states.
BUFFERS = """\
const int places = 2;
group def Cell():
  controllable put, take;
  plant Buffer:
    disc int[0..99] parts = 0;
    location: initial; marked;
      edge put when parts < 99 do parts := parts + 1;
      edge take when parts > 0 do parts := parts - 1;
  end
  requirement put needs Buffer.parts < places;
end
A: Cell();
B: Cell();
"""
SCHEMA = json.loads(locate("schemas/sweep.schema.json").read_text())


@pytest.fixture
def buffers(tmp_path: Path) -> str:
    (tmp_path / "buffers.cif").write_text(BUFFERS)
    return "buffers.cif"


def lines(file: str = "results.jsonl") -> list[dict[str, Any]]:
    found = [json.loads(line) for line in Path(file).read_text().splitlines()]
    for line in found:
        jsonschema.validate(line, SCHEMA)
    return found


def without_times(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the lines in the order of their jobs, without what differs between runs."""
    timeless = [{name: value for name, value in line.items() if "seconds" not in name} for line in found]
    for line in timeless:
        for row in line["result"].get("properties", ()):
            del row["seconds"]
    return sorted(timeless, key=lambda line: line["id"])


def test_variants_have_the_states_of_the_formula(run: Run, buffers: str) -> None:
    answer = run("sweep", "synthesize", buffers, "--set", "places=0..5", "--jobs", "1", "--output", "results.jsonl")
    assert answer.exit_code == 0
    states = {int(line["set"]["places"]): line["result"]["controlled_states"] for line in lines()}
    assert states == {places: (places + 1) ** 2 for places in range(6)}
    assert "6 jobs: 6 ok, 0 failed" in answer.stdout


def test_a_folder_has_all_models_at_any_depth(run: Run, tmp_path: Path) -> None:
    for name in ("b/door.rscd", "a/deep/door.rscd", ".hidden/door.rscd"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(DOOR)
    (tmp_path / "a" / "parts.rscd").write_text("library Parts {}\n")
    (tmp_path / "a" / "buffers.cif").write_text(BUFFERS)
    run("sweep", "synthesize", ".", "--jobs", "1", "--output", "results.jsonl")
    assert [line["model"] for line in lines()] == ["a/buffers.cif", "a/deep/door.rscd", "b/door.rscd"]
    checked = run("sweep", "check", ".", "--jobs", "1")
    assert "4 jobs: 4 ok, 0 failed" in checked.stdout


@pytest.mark.parametrize("action", ["check", "synthesize", "verify", "test"])
@pytest.mark.usefixtures("door", "broken", "stuck", "courier")
def test_results_are_those_of_the_command(action: str, run: Run, tmp_path: Path) -> None:
    models = [tmp_path / f"{name}.rscd" for name in ("door", "broken", "stuck", "courier")]
    for model in models:
        model.with_suffix(".scenarios").write_text('scenario "opens"\n  expect open sent\n')
    options = ["-I", "parts"]
    answer = run(
        "sweep", action, *(model.name for model in models), *options, "--jobs", "2", "--output", "results.jsonl"
    )
    by_model = {line["model"]: line for line in lines()}
    for model in models:
        scenarios = [model.with_suffix(".scenarios").name] if action == "test" else []
        alone = run(action, model.name, *scenarios, *options)
        line = by_model[model.name]
        assert line["exit_status"] == alone.exit_code, model
        places = {f"{finding['file']}:{finding['line']}:{finding['column']}: " for finding in line["findings"]}
        assert all(place in alone.output for place in places)
        assert alone.output.count("error: ") + alone.output.count("warning: ") == len(line["findings"])
    assert answer.exit_code == max(line["exit_status"] for line in by_model.values())
    rows = [line.split("│")[1].strip() for line in answer.stdout.splitlines() if line.startswith("│")]
    assert [name for name in rows if name] == [model.name for model in models]


def test_the_result_does_not_depend_on_the_number_of_processes(run: Run, door: Path, buffers: str) -> None:
    found = []
    for jobs in ("1", "2"):
        arguments = ["sweep", "verify", door.name, buffers, "--jobs", jobs, "--output", f"{jobs}.jsonl"]
        assert run(*arguments).exit_code == 0
        found.append(without_times(lines(f"{jobs}.jsonl")))
    assert found[0] == found[1]
    assert [line["result"]["proved"] for line in found[0]] == [True, True]


def test_a_job_needs_only_its_own_bytes(run: Run, courier: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = courier.parent / "types" / "courier_msgs"
    (package / "action").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>courier_msgs</name></package>\n")
    (package / "action" / "Drive.action").write_text("---\n---\nint32 distance\n")
    jobs: list[Job] = []

    def keep(_work: object, tasks: list[Job], *_: object) -> list[tuple[Job, None]]:
        jobs.extend(tasks)
        return [(task, None) for task in tasks]

    monkeypatch.setattr("robosc.tools.cli.sweep.completed", keep)
    options = ["-I", "parts", "--interface-path", "types"]
    assert run("sweep", "synthesize", courier.name, *options, "--jobs", "1").exit_code == 2
    alone = run("synthesize", courier.name, *options)
    for folder in (courier.parent / "parts", courier.parent / "types"):
        shutil.rmtree(folder)
    courier.unlink()
    [job] = jobs
    line = perform(job)
    assert line["exit_status"] == alone.exit_code == 0
    places = [f"{finding['file']}:{finding['line']}:{finding['column']}: " for finding in line["findings"]]
    assert any(place.startswith("parts/lamps.rscd") for place in places)
    assert [place for place in places if place not in alone.stderr] == []
    assert alone.stderr.count("warning: ") == len(places)


def test_random_walks_find_a_violated_property_and_their_trace_repeats_it(run: Run, tmp_path: Path) -> None:
    claim = "property never Leaf.opened\n"
    (tmp_path / "door.rscd").write_text(DOOR.replace("  requirement", f"  {claim}  requirement"))
    answer = run(
        "sweep", "test", "door.rscd", "--seeds", "1..5", "--events", "50", "--jobs", "1", "--output", "w.jsonl"
    )
    assert answer.exit_code == 1
    for number, line in enumerate(lines("w.jsonl"), 1):
        assert line["seed"] == number
        script = "".join(json.dumps(event) + "\n" for event in line["result"]["trace"])
        (tmp_path / "trace").write_text(script)
        answers = run("simulate", "door.rscd", "--script", "trace").stdout.splitlines()
        assert all(json.loads(answered)["accepted"] for answered in answers)
        assert json.loads(answers[-1])["state"]["component_Leaf"] == "opened"


def test_random_walks_without_a_fault(run: Run, door: Path) -> None:
    answer = run("sweep", "test", door.name, "--seeds", "1..2", "--events", "30", "--jobs", "1", "--output", "w.jsonl")
    assert answer.exit_code == 0
    assert [line["result"] for line in lines("w.jsonl")] == [{"events": 30, "fault": None}] * 2


@given(cut=st.floats(0, 1))
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_file_that_breaks_off_anywhere_is_completed(run: Run, buffers: str, cut: float) -> None:
    arguments = ["sweep", "check", buffers, "--set", "places=0..5", "--jobs", "1", "--output"]
    if not Path("whole.jsonl").exists():
        assert run(*arguments, "whole.jsonl").exit_code == 0
    whole = Path("whole.jsonl").read_bytes()
    begin = whole[: round(cut * len(whole))]
    Path("results.jsonl").write_bytes(begin)
    assert run(*arguments, "results.jsonl").exit_code == 0
    assert without_times(lines()) == without_times(lines("whole.jsonl"))
    complete = begin[: begin.rfind(b"\n") + 1]
    assert Path("results.jsonl").read_bytes().startswith(complete)


def test_changed_inputs_and_options_are_done_again(run: Run, buffers: str) -> None:
    call = ["sweep", "synthesize", buffers, "--jobs", "1", "--output", "results.jsonl"]

    def done(*more: str) -> int:
        before = len(lines()) if Path("results.jsonl").exists() else 0
        assert run(*call, *more).exit_code == 0
        return len(lines()) - before

    assert [done(), done(), done("--memory", "500"), done("--set", "places=2"), done()] == [1, 0, 1, 1, 0]
    Path(buffers).write_text(BUFFERS + "// changed\n")
    assert [done(), done()] == [1, 0]


def test_a_file_with_other_content_stays(run: Run, buffers: str) -> None:
    assert run("sweep", "check", buffers, "--jobs", "1", "--output", "own.jsonl").exit_code == 0
    for content, line in (("my notes", 1), ("my notes\n", 1), (Path("own.jsonl").read_text() + "[1]\n", 2)):
        Path("results.jsonl").write_text(content)
        answer = run("sweep", "check", buffers, "--output", "results.jsonl")
        assert answer.exit_code == 2
        assert f"results.jsonl:{line}: this line is no result of `robosc sweep`" in answer.output
        assert Path("results.jsonl").read_text() == content


@pytest.mark.parametrize(
    "line",
    [
        '{"id": "a", "exit_status": 0, "seconds": 1, "error": null, "findings": [], "result": null}',
        '{"id": "a", "exit_status": "boom", "seconds": "z", "error": null, "findings": [], "result": {}}',
        '{"id": "a", "exit_status": 256, "seconds": 1, "error": null, "findings": [], "result": {}}',
        '{"id": "a", "exit_status": 0, "seconds": 1' + "0" * 400 + ', "error": null, "findings": [], "result": {}}',
        "[" * 100_000,
    ],
    ids=["result", "types", "status", "seconds", "depth"],
)
def test_a_damaged_line_is_no_result(run: Run, buffers: str, line: str) -> None:
    Path("results.jsonl").write_text(line + "\n")
    answer = run("sweep", "check", buffers, "--output", "results.jsonl")
    assert answer.exit_code == 2
    assert "results.jsonl:1: this line is no result of `robosc sweep`" in answer.output


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a full device")
def test_a_full_output_is_named(run: Run, buffers: str) -> None:
    answer = run("sweep", "check", buffers, "--jobs", "1", "--output", "/dev/full")
    assert answer.exit_code == 2
    assert "/dev/full: No space left on device" in answer.output


def test_paths_in_results_are_those_of_the_user(
    run: Run, broken: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / 'Tür "1"'
    (folder / "inside").mkdir(parents=True)
    monkeypatch.chdir(folder)
    text = broken.read_text()
    for place in (folder / "inside" / "größe.rscd", tmp_path / "größe.rscd"):
        place.write_text(text)
    models = ["inside/größe.rscd", str(tmp_path / "größe.rscd")]
    assert run("sweep", "check", *models, "--jobs", "1", "--output", "results.jsonl").exit_code == 1
    assert [{finding["file"] for finding in line["findings"]} for line in lines()] == [{model} for model in models]


def test_the_number_of_jobs_is_limited(run: Run, buffers: str) -> None:
    limits = ["--set", "places=1..2000", "--seeds", "1..1000"]
    answer = run("sweep", "test", buffers, *limits, "--jobs", "1")
    assert answer.exit_code == 2
    assert "the sweep would have 2,000,000 jobs, and at most 1,000,000 are possible" in answer.output


def test_wrong_values_are_a_wrong_call(run: Run, buffers: str) -> None:
    answer = run("sweep", "check", buffers, "--set", "places=1..3,(5", "--jobs", "1")
    assert answer.exit_code == 2
    assert "places: `1..3` is no expression of .cif files" in answer.output
    assert "places: `(5` is no expression of .cif files" in answer.output


def test_the_output_never_replaces_an_input(run: Run, buffers: str) -> None:
    assert run("sweep", "check", buffers, "--output", buffers).exit_code == 2
    assert Path(buffers).read_text() == BUFFERS


def test_all_wrong_names_are_reported_at_once(run: Run, buffers: str, door: Path) -> None:
    answer = run("sweep", "check", buffers, door.name, "--set", "place=1", "--jobs", "1")
    assert answer.exit_code == 2
    assert "buffers.cif has no constant or parameter `place`; did you mean `places`?" in answer.output
    assert "door.rscd has no constant or parameter `place`" in answer.output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["check", "buffers.cif", "--seeds", "1..3"], "need `sweep test`"),
        (["test", "door.rscd", "--seeds", "3"], "3: write the first and the last number, such as 1..100"),
        (["test", "door.rscd"], "door.rscd has no door.scenarios beside it"),
        (["check", "empty"], "there is no model to check"),
    ],
)
@pytest.mark.usefixtures("buffers", "door")
def test_wrong_calls(arguments: list[str], message: str, run: Run, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    answer = run("sweep", *arguments)
    assert answer.exit_code == 2
    assert message in answer.output


def wait_for(happened: Callable[[], bool]) -> None:
    for _ in range(1200):
        if happened():
            return
        time.sleep(0.05)
    raise AssertionError("it did not happen within a minute")


def number_of_lines() -> int:
    file = Path("results.jsonl")
    return file.read_bytes().count(b"\n") if file.exists() else 0


@pytest.mark.slow
def test_an_interrupted_sweep_goes_on(run: Run, buffers: str) -> None:
    call = ["sweep", "synthesize", buffers, "--set", "places=30..69", "--jobs", "2", "--output", "results.jsonl"]
    with subprocess.Popen(
        [sys.executable, "-m", "robosc", *call], start_new_session=True, stderr=subprocess.PIPE, text=True
    ) as process:
        wait_for(lambda: number_of_lines() >= 2)
        os.killpg(process.pid, signal.SIGINT)  # as the terminal does
        _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "of 40 jobs have results; the same call does the others" in told
    assert not re.search("Traceback|Warning", told)
    before = lines()
    assert 2 <= len(before) < 40
    assert run(*call).exit_code == 0
    assert lines()[: len(before)] == before
    states = {int(line["set"]["places"]): line["result"]["controlled_states"] for line in lines()}
    assert len(lines()) == 40
    assert states == {places: (places + 1) ** 2 for places in range(30, 70)}


@pytest.mark.slow
def test_a_dask_cluster_whose_worker_is_killed_loses_and_doubles_nothing(
    run: Run, buffers: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = list(client.run(os.getpid).values())
        at_death: list[int] = []

        def kill() -> None:
            wait_for(lambda: number_of_lines() >= 3)
            os.kill(workers[0], signal.SIGKILL)
            at_death.append(number_of_lines())

        thread = threading.Thread(target=kill)
        thread.start()
        call = ["sweep", "synthesize", buffers, "--set", "places=30..69", "--output", "results.jsonl"]
        answer = run(*call, "--cluster", f"dask:{cluster.scheduler_address}")
        thread.join()
        assert workers[0] not in client.run(os.getpid).values()
        with monkeypatch.context() as patch:
            patch.setattr("robosc.tools.workers.__version__", "0.0.1")
            other = run("sweep", "check", buffers, "--cluster", f"dask:{cluster.scheduler_address}")
        assert other.exit_code == 2
        assert "it has robosc" in other.output
        assert "install robosc 0.0.1 for all workers" in other.output
    assert answer.exit_code == 0, answer.output
    assert at_death[0] < 40
    assert len(lines()) == 40
    states = {int(line["set"]["places"]): line["result"]["controlled_states"] for line in lines()}
    assert states == {places: (places + 1) ** 2 for places in range(30, 70)}
    # The same jobs on this machine have the same results.
    assert "40 of 40 jobs have results already" in run(*call, "--jobs", "2").stderr
    assert len(lines()) == 40
