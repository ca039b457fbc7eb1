"""Where the event log goes that nobody named: the generated nodes say the same, see `tests/m2t/cpp/headers.cpp`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from robosc.runtime.reports import default_log

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
