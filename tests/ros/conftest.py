"""Generated packages over a real ROS. Fixtures build and run them once; the tests only read the results."""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.installations import find_ros1
from tests.ros.running import Runner, run_ros2
from tests.ros.workspaces import Workspace, middleware, ros1_build, ros1_workspace, ros2_workspace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

__all__ = ["ros1_build", "ros1_workspace", "ros2_workspace", "run_ros2"]

HERE = Path(__file__).parent
#: Fixtures that run nodes for several tests, and names of the parameters that select the kind of node.
RUNS = (
    "drive",
    "courier",
    "trial",
    "run",
    "under_way",
    "with_patience",
    "with_guard",
    "simulated",
    "graph",
    "served",
    "model_workspace",
    "base",
)
KINDS = ("nodes", "layers", "controller", "kind", "name")
#: Compiled nodes of each ROS version, and nodes that `robosc run` starts from models over ROS 2.
NODES = ("ros1", "ros2", "run-ros2")
SIMULATOR = HERE.parents[1] / "examples" / "simulator"


@dataclass(frozen=True)
class Drive:
    """A run of the line follower: messages on the world's topics, event log, reports and output of the node."""

    record: list[dict[str, Any]]
    log: list[dict[str, Any]]
    reports: list[dict[str, Any]]
    node_status: int
    node_output: str

    def commands(self, start: float = 0.0, end: float = 1e9) -> list[tuple[float, float, float]]:
        """Return time, linear and angular speed of the commands that the world received in an interval."""
        received = [entry for entry in self.record if entry["topic"] == "/cmd_vel" and start <= entry["time"] < end]
        return [
            (message["time"], message["data"]["linear"]["x"], message["data"]["angular"]["z"]) for message in received
        ]

    def poses(self, start: float = 0.0, end: float = 1e9) -> list[dict[str, Any]]:
        """Return the poses of the robot in an interval."""
        return [entry["data"] for entry in self.record if entry["topic"] == "pose" and start <= entry["time"] < end]

    def when(self, happening: str) -> float:
        """Return the time of an event in the world."""
        (time,) = [
            entry["time"] for entry in self.record if (entry["topic"], entry["data"]) == ("happening", happening)
        ]
        return float(time)


@dataclass(frozen=True)
class Courier:
    """State and messages of the courier after each step of `send_to_courier.py`, its event log and its output."""

    steps: dict[str, Any]
    log: list[dict[str, Any]]
    node_output: str


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "workspace" in metafunc.fixturenames:
        metafunc.parametrize("workspace", ["ros1", "ros2"], indirect=True, scope="session")
    if "nodes" in metafunc.fixturenames:
        metafunc.parametrize("nodes", NODES, indirect=True, scope="session")
    if "layers" in metafunc.fixturenames:
        metafunc.parametrize("layers", [kind for kind in NODES if kind != "ros1"], indirect=True, scope="session")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Assign the tests of one run of a node to one process, and those of another run to the next free process."""
    groups: dict[str, int] = {}
    for item in items:
        if is_here(item.path):
            groups.setdefault(group(item), len(groups))
            item.add_marker(pytest.mark.xdist_group(group(item)))
            item.add_marker(pytest.mark.ros)
            if needs_ros1_workspace(item) or "model_workspace" in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.build)
    items.sort(key=lambda item: groups.get(group(item), 0))


@cache
def is_here(path: Path) -> bool:
    return HERE in path.parents


def needs_ros1_workspace(item: pytest.Item) -> bool:
    """Whether a test needs the compiled workspace of ROS 1."""
    if not is_here(item.path):
        return False
    return "ros1_workspace" in getattr(item, "fixturenames", ()) or "ros1" in parameters(item).values()


def group(item: pytest.Item) -> str:
    """Return the name of the node run that a test uses, or else the name of the test."""
    names = getattr(item, "fixturenames", ())
    run = next((name for name in RUNS if name in names), None)
    if run is None:
        return item.nodeid
    given = parameters(item)
    return " ".join([run, *(str(given[name]) for name in (*RUNS, *KINDS) if name in given)])


def parameters(item: pytest.Item) -> dict[str, Any]:
    """Return the parameters of a test by name."""
    callspec = getattr(item, "callspec", None)
    return dict(callspec.params) if callspec else {}


@dataclass
class Kept:
    """Resources shared by the tests of one group, by name, and their cleanup."""

    ends: ExitStack = field(default_factory=ExitStack)
    made: dict[str, Any] = field(default_factory=dict)

    def end(self) -> None:
        """Release all resources."""
        self.made.clear()
        self.ends.close()


_KEPT = Kept()


@pytest.fixture
def kept() -> Callable[[str, Callable[[], AbstractContextManager[Any]]], Any]:
    """Return `kept(name, make)`, which yields the context of `make` once for all tests of a group.

    The context ends after the last test of the group.
    """

    def one(name: str, make: Callable[[], AbstractContextManager[Any]]) -> Any:
        if name not in _KEPT.made:
            try:
                _KEPT.made[name] = _KEPT.ends.enter_context(make())
            except Exception as error:  # the tests that follow fail at once
                _KEPT.made[name] = error
        if isinstance(_KEPT.made[name], Exception):
            raise _KEPT.made[name]
        return _KEPT.made[name]

    return one


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> Iterator[None]:
    yield
    if nextitem is None or group(nextitem) != group(item):
        _KEPT.end()


@pytest.fixture(scope="session", autouse=True)
def ros1_build_begins(request: pytest.FixtureRequest) -> None:
    """Start the build of `ros1_workspace` before the first test, if any test needs it."""
    if any(map(needs_ros1_workspace, request.session.items)) and find_ros1().ros is not None:
        request.getfixturevalue("ros1_build")


@pytest.fixture(scope="session")
def workspace(request: pytest.FixtureRequest) -> Workspace:
    built: Workspace = request.getfixturevalue(f"{request.param}_workspace")
    return built


@pytest.fixture(scope="session")
def nodes(request: pytest.FixtureRequest) -> Workspace | Runner:
    """Nodes of every kind, started by the names of their packages: compiled, and run from their models."""
    return nodes_of(request, request.param)


@pytest.fixture(scope="session")
def layers(request: pytest.FixtureRequest) -> Workspace | Runner:
    """Layers of every kind: compiled, and run from their models, both over ROS 2."""
    return nodes_of(request, request.param)


def nodes_of(request: pytest.FixtureRequest, kind: str) -> Workspace | Runner:
    """Return the nodes of one of the kinds `NODES`."""
    made: Workspace | Runner = request.getfixturevalue("run_ros2" if kind == "run-ros2" else f"{kind}_workspace")
    return made


@pytest.fixture(scope="session")
def drive(nodes: Workspace | Runner, tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """Run the line follower through its whole scenario in simulated time."""
    package, ros = "line_follower_controller", nodes.ros
    folder = tmp_path_factory.mktemp("drive") / "run"
    events, reports, record = folder / "events.jsonl", folder / "reports.jsonl", folder / "record.jsonl"
    with middleware(nodes, folder, simulated=True) as processes:
        listener = processes.start("reports", [ros.python, HERE / "reports.py", str(ros.version), package, reports])
        processes.wait_until(reports.exists, "somebody listens to the node's reports")
        clock = ["use_sim_time:=true"] if ros.version == 2 else []
        node = processes.start("node", nodes.node(package, f"event_log:={events}", *clock))
        options = ["--scenario", "line_follower", "--ros", str(ros.version), "--speed", "5", "--record", record]
        world = processes.start("world", [ros.python, SIMULATOR, *options])
        processes.wait_until(lambda: world.poll() is not None, "the scenario has ended", seconds=900)
        assert world.returncode == 0, processes.logs()
        status = processes.stop(node)
        processes.stop(listener)
    output = (folder / "node.log").read_text()
    return Drive(_lines(record), _lines(events), _lines(reports), status, output)


@pytest.fixture(scope="session")
def courier(nodes: Workspace | Runner, tmp_path_factory: pytest.TempPathFactory) -> Courier:
    """Send messages to the courier one by one, in real time."""
    package, ros = "courier_controller", nodes.ros
    folder = tmp_path_factory.mktemp("courier") / "run"
    steps = folder / "steps.json"
    with middleware(nodes, folder, simulated=False) as processes:
        node = processes.start("node", nodes.node(package))
        client = processes.start("client", [ros.python, HERE / "send_to_courier.py", str(ros.version), steps])
        processes.wait_until(lambda: client.poll() is not None, "all steps are done", seconds=600)
        assert client.returncode == 0, processes.logs()
        processes.stop(node)
    log = _lines(folder / "log" / f"{package}-events.jsonl")
    return Courier(json.loads(steps.read_text()), log, (folder / "node.log").read_text())


def _lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
