"""Calls in processes: each result once, also if processes are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from robosc.tools.cli import CallError
from robosc.tools.workers import completed


def square(number: int) -> int:
    return number * number


def kill_once(task: tuple[int, str]) -> int:
    """Kill the process at the first call with a marker file that does not exist yet."""
    number, marker = task
    if marker and not os.path.exists(marker):  # noqa: PTH110
        with open(marker, "w", encoding="utf-8"):  # noqa: PTH123
            os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.01)
    return number


def kill_always(number: int) -> int:
    if number % 5 == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def fail(number: int) -> int:
    raise ValueError(f"number {number}")


@pytest.mark.parametrize("jobs", [1, 2])
def test_each_task_has_its_result(jobs: int) -> None:
    assert sorted(completed(square, iter(range(40)), jobs)) == [(number, number**2) for number in range(40)]


def test_the_tasks_of_a_killed_process_run_again(tmp_path: Path) -> None:
    tasks = [(number, str(tmp_path / "marker") if number == 7 else "") for number in range(40)]
    results = [result for _, result in completed(kill_once, tasks, 2)]
    assert (tmp_path / "marker").exists()
    assert sorted(results) == list(range(40))


def test_a_task_that_always_kills_its_process_has_no_result_and_the_others_have_one() -> None:
    results = list(completed(kill_always, range(12), 2))
    assert len(results) == 12
    assert dict(results) == {number: None if number % 5 == 3 else number for number in range(12)}


def test_an_exception_reaches_the_caller() -> None:
    with pytest.raises(ValueError, match="number"):
        list(completed(fail, range(4), 2))


def test_the_processes_are_gone_after_the_last_result_and_after_a_stop() -> None:
    def pids(count: int) -> set[int]:
        calls = completed(process, range(20), 2)
        found = {pid for _, pid in (next(calls) for _ in range(count)) if pid is not None}
        calls.close()
        return found

    for pid in pids(20) | pids(3):
        assert not is_running(pid)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux signals the end of a parent")
@pytest.mark.parametrize("ending", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_the_processes_end_with_their_parent(ending: signal.Signals, tmp_path: Path) -> None:
    # `nohup` ignores hangups for all processes that it starts.
    script = "import sys; from tests.tools.test_workers import *; signal.signal(signal.SIGHUP, signal.SIG_DFL); "
    script += "list(completed(wait, [sys.argv[1]] * 2, 2))"
    with subprocess.Popen([sys.executable, "-c", script, str(tmp_path)], cwd=Path(__file__).parents[2]) as parent:
        while len(pids := [int(file.name) for file in tmp_path.iterdir()]) < 2:
            assert parent.poll() is None
            time.sleep(0.02)
        parent.send_signal(ending)
    try:
        for _ in range(600):
            if not any(map(is_running, pids)):
                return
            time.sleep(0.05)
        raise AssertionError("a process runs without its parent")
    finally:
        for pid in filter(is_running, pids):
            os.kill(pid, signal.SIGKILL)


def wait(folder: str) -> None:
    """Create a file with the number of the process as its name, and wait for its end."""
    (Path(folder) / str(os.getpid())).touch()
    time.sleep(300)


def process(_: int) -> int:
    time.sleep(0.02)
    return os.getpid()


def is_running(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:  # noqa: PTH123
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize(
    ("cluster", "message"),
    [("slurm:here", "write dask:tcp://HOST:PORT or ray:ADDRESS"), ("dask:nonsense:x:y", "--cluster dask:nonsense")],
)
def test_a_wrong_cluster_is_named(cluster: str, message: str) -> None:
    with pytest.raises(CallError, match=message):
        list(completed(square, range(3), 1, cluster))


def test_a_missing_library_is_named_with_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robosc.tools.workers.find_spec", lambda _: None)
    with pytest.raises(CallError, match=r"joblib is missing: run `pip install 'robosc\[sweep\]'`"):
        list(completed(square, range(3), 2))
