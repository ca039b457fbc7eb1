"""Times over a real ROS. Their delays depend on the machine; `benchmarks/expiry.py` measures them."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import pytest

from tests.ros.expiries import DURATION, expiries
from tests.ros.workspaces import HERE, middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

TRIALS = 10
GUARD = HERE.parent / "run" / "runtime" / "guard.rscd"


def test_a_time_is_never_up_early(nodes: Workspace | Runner, tmp_path: Path) -> None:
    """With `after 200 ms`, at least 200 ms pass between the message that starts the timer and the resulting message."""
    found = expiries(nodes, tmp_path / "run", TRIALS, 30)
    assert len(found) == TRIALS
    assert min(found) >= DURATION


#: Programs with a delayed executor: the package, its class, and the type of its scans.
LATE = {"patience_controller": ("Controller", "sensor"), "guard_layer": ("Layer", "empty")}


@pytest.mark.parametrize("package", LATE)
def test_what_arrived_before_a_time_was_up_is_handled_before_it_where_compiled(
    ros2_workspace: Workspace, package: str, tmp_path: Path
) -> None:
    name, scan = LATE[package]
    log, install = tmp_path / "events.jsonl", ros2_workspace.folder / "install"
    library = install / package / "lib" / f"lib{package}_component.so"
    with middleware(ros2_workspace, tmp_path / "run") as processes:
        command = [install / "late_arrival/lib/late_arrival/late", library, f"{package}::{name}", scan, log]
        late = processes.start("late", command)
        processes.wait_until(lambda: late.poll() is not None, "it has ended")
        assert late.returncode == 0, processes.logs()
    assert first_of_late(tmp_path / "run" / "late.log", log) == "message_scan.u_response"


@pytest.mark.parametrize("kind", ["controller", "layer"])
def test_what_arrived_before_a_time_was_up_is_handled_before_it(run_ros2: Runner, kind: str, tmp_path: Path) -> None:
    """The order does not depend on the order in which the executor of ROS 2 polls."""
    log = tmp_path / "events.jsonl"
    with middleware(run_ros2, tmp_path / "run") as processes:
        command = [run_ros2.ros.python, HERE / "late_ros2.py", kind, GUARD]
        late = processes.start("late", [*command, "--ros-args", "-p", f"event_log:={log}"])
        processes.wait_until(lambda: late.poll() is not None, "it has ended")
        assert late.returncode == 0, processes.logs()
    assert first_of_late(tmp_path / "run" / "late.log", log) == "message_scan.u_response"


def first_of_late(output: Path, log: Path) -> str:
    """Return the event, a scan or its timeout, that occurred first after the time that the program printed."""
    (on,) = re.findall(r"^on at (\S+)$", output.read_text(), re.MULTILINE)
    entries = [json.loads(line) for line in log.read_text().splitlines()]
    late = [str(entry["event"]) for entry in entries if entry["time"] >= float(on)]
    return next(event for event in late if event in {"message_scan.u_response", "component_Base.u_after1"})
