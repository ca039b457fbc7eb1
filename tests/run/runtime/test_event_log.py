"""The default path of the event log, and how it is written.

The generated nodes behave alike, see `tests/m2t/cpp/headers.cpp` and `threads.cpp`.
"""

from __future__ import annotations

import json
import os
from threading import Thread
from typing import TYPE_CHECKING

import pytest

from robosc.run.runtime.core.event_log import EventLog, default_log

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("node", "name"),
    [
        ("/base", "base-events.jsonl"),
        ("/hall/left/base", "hall.left.base-events.jsonl"),
        ("/left/wheels", "left.wheels.base-events.jsonl"),
    ],
)
def test_logs_are_named_by_their_nodes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, node: str, name: str) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    assert default_log(node, "base") == str(tmp_path / "logs" / name)
    assert (tmp_path / "logs").is_dir()


def test_a_log_is_whole_and_in_order(tmp_path: Path) -> None:
    path = tmp_path / "log"
    log = EventLog(str(path))
    for number in range(5000):
        log.write(number, "in", "e", {"value": "\ud800"} if number == 0 else None)
    assert log.lost() == 0
    log.close()
    assert not log.active
    assert [json.loads(line)["time"] for line in path.read_text().splitlines()] == list(range(5000))


def test_a_disk_that_hangs_delays_nobody(tmp_path: Path) -> None:
    # A pipe without a reader behaves like a disk that hangs.
    path = tmp_path / "pipe"
    os.mkfifo(path)
    pipe = os.open(path, os.O_RDWR)
    log = EventLog(str(path))
    for number in range(12000):
        log.write(number, "in", "e" * 1000)
    assert 1000 < log.lost() < 12000

    def drain() -> None:
        while os.read(pipe, 1 << 20) != b"!":
            pass

    reader = Thread(target=drain)
    reader.start()
    log.close()
    while reader.is_alive():
        # It is alone in the pipe after all earlier lines were read.
        os.write(pipe, b"!")
        reader.join(0.1)
    os.close(pipe)


def test_a_full_disk_is_told() -> None:
    log = EventLog("/dev/full")
    log.write(1, "in", "e")
    log.flush()
    assert log.lost() == 1
    log.write(2, "in", "e")
    log.flush()
    # The log reports lost lines at most once a second.
    assert log.lost() == 0
    log.close()
