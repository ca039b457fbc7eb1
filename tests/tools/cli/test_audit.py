"""The command `audit`: its output, exit statuses, options and errors, and the findings in `view`."""

from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.run.audit.recordings import Entry, write_mcap
from tests.tools.cli.conftest import DOOR

if TYPE_CHECKING:
    from tests.tools.cli.conftest import Run


def word(time: float, name: str) -> Entry:
    return Entry(time, f"/{name}", "std_msgs/msg/Empty")


#: The door is opened, opened again, and closed.
TWICE = [word(0.0, "open"), word(1.0, "open"), word(2.0, "open"), word(2.5, "close")]


@pytest.fixture
def door(tmp_path: Path) -> Path:
    (tmp_path / "door.rscd").write_text(DOOR, encoding="utf-8")
    return write_mcap(tmp_path / "twice", TWICE)


def test_findings_are_printed_with_their_state(run: Run, door: Path) -> None:
    done = run("audit", "door.rscd", door)
    assert done.exit_code == 1
    assert done.stdout.splitlines() == [
        "Door: 4 commands and 0 events of the robot in 2.500 s from 2023-11-14 22:13:20.000 UTC",
        "     1.000 s  Leaf.open (/open) is forbidden: requirement open needs Leaf.closed; 2 times until 2.000 s",
        "              in Leaf.opened",
        "2 forbidden commands",
        "0 violations of assumptions",
        "0 unexpected events",
    ]


def test_json_has_every_time(run: Run, door: Path) -> None:
    done = run("audit", "door.rscd", door, "--json")
    assert done.exit_code == 1
    (finding,) = json.loads(done.stdout)["findings"]
    assert (finding["name"], finding["reason"], finding["times"]) == ("Leaf.open", "requirement", [1.0, 2.0])


@pytest.mark.usefixtures("door")
def test_a_recording_without_findings_has_status_0(run: Run, tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "once", [TWICE[0], TWICE[3]])
    assert run("audit", "door.rscd", path).exit_code == 0
    started = run("audit", "door.rscd", path, "--from-state", "Leaf=opened")
    assert started.exit_code == 1
    assert "0.000 s  Leaf.open" in started.stdout


@pytest.mark.usefixtures("door")
def test_names_are_remapped(run: Run, tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "other", [word(0.0, "hall/open"), word(1.0, "hall/open")])
    names = ("-r", "/open:=/hall/open", "-r", "/close:=/hall/close")
    assert "2 commands" in run("audit", "door.rscd", path, *names).stdout
    assert run("audit", "door.rscd", path, "-r", "/open").exit_code == 2


def test_wrong_calls_and_damaged_recordings_have_status_2(run: Run, tmp_path: Path, door: Path) -> None:
    absent = run("audit", "door.rscd", "absent.mcap")
    assert (absent.exit_code, absent.stdout) == (2, "")
    wrong = run("audit", "door.rscd", door, "--from-state", "Leaf=ajar")
    assert wrong.exit_code == 2
    assert "--from-state" in wrong.stderr
    damaged = bytearray(door.read_bytes())
    damaged[len(damaged) // 4 : len(damaged) // 2] = b"\xff" * (len(damaged) // 2 - len(damaged) // 4)
    (tmp_path / "damaged.mcap").write_bytes(damaged)
    done = run("audit", "door.rscd", "damaged.mcap")
    assert done.exit_code == 2
    assert "damaged.mcap cannot be read" in done.stderr
    (tmp_path / "events.jsonl").write_text("no log\n", encoding="utf-8")
    done = run("audit", "door.rscd", "events.jsonl")
    assert done.exit_code == 2
    assert "events.jsonl:1:" in done.stderr


@pytest.mark.usefixtures("door")
def test_an_event_log_is_audited(run: Run, tmp_path: Path) -> None:
    event = "message_open.c_trigger"
    lines = [json.dumps({"time": time, "direction": "out", "event": event}) for time in (1.0, 2.0)]
    (tmp_path / "events.jsonl").write_text("\n".join([*lines, ""]), encoding="utf-8")
    done = run("audit", "door.rscd", "events.jsonl", "--json")
    assert done.exit_code == 1
    assert [finding["times"] for finding in json.loads(done.stdout)["findings"]] == [[1.0]]


def test_view_marks_the_findings(run: Run, door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        import_module("robosc.tools.view.export"), "page_files", lambda: {"index.html": b'<meta charset="utf-8" />'}
    )
    done = run("view", "door.rscd", "--audit", door, "--export", "page")
    assert done.exit_code == 0, done.output
    text = Path("page/run.js").read_text(encoding="utf-8")
    moments = json.loads(text.removeprefix("globalThis.robosc = ").rstrip(";\n"))["moments"]
    marked = [(moment["time"], moment["by"], moment["reason"]) for moment in moments if "by" in moment]
    reason = "is forbidden: requirement open needs Leaf.closed"
    assert marked == [(1.0, "requirement", reason), (2.0, "requirement", reason)]
    states = [moment["state"]["component_Leaf"] for moment in moments if "component_Leaf" in moment["state"]]
    assert states == ["closed", "opened", "closed"]
    assert run("view", "door.rscd", "--tolerance", "5").exit_code == 2
