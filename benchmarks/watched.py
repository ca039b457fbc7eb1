"""Costs for a node of being watched: the line follower on its line, in turn alone and with observers."""

from __future__ import annotations

import os
import re
import time
from contextlib import contextmanager, nullcontext
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

from benchmarks.timed_packages import EXAMPLES
from tests.ros.reactions import HERE as TESTS
from tests.ros.reactions import PACKAGE, SENSORS_HZ, one_process
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from tests.ros.processes import Processes
    from tests.ros.running import Runner

ROOT = TESTS.parents[1]
MODEL = EXAMPLES / "line_follower" / "line_follower.rscd"
#: Monitor of robots; it reports when it has received the node's status.
MONITOR = """\
from topics import connect
topics = connect("2", "monitor")
topics.listen("/diagnostics", "diagnostic_msgs/DiagnosticArray", lambda message: print("heard", flush=True))
while True:
    topics.receive(1.0)
"""
#: Seconds in which the node starts, before the measurement.
_WARM_UP = 5.0


def watched(nodes: Workspace | Runner, runner: Runner, folder: Path, rounds: int, seconds: float) -> dict[str, Any]:
    """Return the node's share of a core without observers, with the page, and with a monitor: medians of the rounds.

    The cost of an observer is the median of the differences to no observer in the same round. `runner` runs
    `robosc view`.
    """
    with middleware(nodes, folder) as processes:
        node = processes.start("node", one_process(nodes, PACKAGE))
        processes.start("sensors", [nodes.ros.python, TESTS / "sensors.py", "2", str(SENSORS_HZ), "--going"])
        time.sleep(_WARM_UP)
        who: dict[str, Callable[[], AbstractContextManager[None]]] = {
            "nobody": nullcontext,
            "view": lambda: _page(processes, runner, folder),
            "monitor": lambda: _monitor(processes, nodes, folder),
        }
        taken: dict[str, list[float]] = {name: [] for name in who}
        for _ in range(rounds):
            for name, looking in who.items():
                with looking():
                    before, began = _processor(node.pid), time.monotonic()
                    time.sleep(seconds)
                    taken[name].append((_processor(node.pid) - before) / (time.monotonic() - began))
                assert node.poll() is None, processes.logs()
    more = {
        name: median(with_it - alone for with_it, alone in zip(taken[name], taken["nobody"], strict=True))
        for name in ("view", "monitor")
    }
    return {
        "rounds": rounds,
        "seconds": seconds,
        "taken": {name: median(shares) for name, shares in taken.items()},
        "more": more,
    }


def _processor(pid: int) -> float:
    """Return the processor seconds that a process has taken."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def page_served(processes: Processes, runner: Runner, folder: Path) -> Iterator[str]:
    """Serve the page of `robosc view` beside the line follower; yield its address."""
    path = os.pathsep.join(filter(None, (str(ROOT), processes.environment.get("PYTHONPATH"))))
    command = ["env", f"PYTHONPATH={path}", runner.ros.python, "-m", "robosc", "view", MODEL, "--ros2"]
    process, log = processes.start("view", command), folder / "view.log"
    processes.wait_until(lambda: "http" in log.read_text(), "the page is served")
    yield re.findall(r"^http\S+$", log.read_text(), re.MULTILINE)[-1]
    processes.stop(process)


@contextmanager
def _page(processes: Processes, runner: Runner, folder: Path) -> Iterator[None]:
    """Open the page and wait until it has shown a report of the node."""
    with page_served(processes, runner, folder) as address:
        with urlopen(f"{address}moments", timeout=60) as stream:  # noqa: S310  # loopback
            while b'"event"' not in stream.readline():
                pass
        yield


@contextmanager
def _monitor(processes: Processes, nodes: Workspace | Runner, folder: Path) -> Iterator[None]:
    log = folder / "monitor.log"
    path = os.pathsep.join(filter(None, (str(TESTS), processes.environment.get("PYTHONPATH"))))
    process = processes.start("monitor", ["env", f"PYTHONPATH={path}", nodes.ros.python, "-c", MONITOR])
    processes.wait_until(lambda: "heard" in log.read_text(), "the monitor hears of the node")
    yield
    processes.stop(process)
