"""Generated packages over a real ROS: built and run once, so that the tests only read what came of it."""

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
#: Fixtures that run nodes for several tests, and the parameters that say of which kind they are.
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
    "model_workspace",
    "base",
)
KINDS = ("nodes", "layers", "controller", "kind", "name")
#: Compiled nodes of each ROS, and those of ROS 2 that run straight from their models.
NODES = ("ros1", "ros2", "run-ros2")
SIMULATOR = HERE.parents[1] / "examples" / "simulator"


@dataclass(frozen=True)
class Drive:
    """What crossed the world's topics, what the node did in its own order, what it reported and printed."""

    record: list[dict[str, Any]]
    log: list[dict[str, Any]]
    reports: list[dict[str, Any]]
    node_status: int
    node_output: str

    def commands(self, start: float = 0.0, end: float = 1e9) -> list[tuple[float, float, float]]:
        """Time, linear and angular speed of the commands that the world received in a span of time."""
        received = [entry for entry in self.record if entry["topic"] == "/cmd_vel" and start <= entry["time"] < end]
        return [
            (message["time"], message["data"]["linear"]["x"], message["data"]["angular"]["z"]) for message in received
        ]

    def poses(self, start: float = 0.0, end: float = 1e9) -> list[dict[str, Any]]:
        """Where the robot was in a span of time."""
        return [entry["data"] for entry in self.record if entry["topic"] == "pose" and start <= entry["time"] < end]

    def when(self, happening: str) -> float:
        """When something happened in the world."""
        (time,) = [
            entry["time"] for entry in self.record if (entry["topic"], entry["data"]) == ("happening", happening)
        ]
        return float(time)


@dataclass(frozen=True)
class Courier:
    """What the courier reported and sent after each step of `send_to_courier.py`, and what it logged and printed."""

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
    """Tests of one run of a node go to one process, those of another run to the next that is free."""
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
    """Whether a test runs what is compiled in the workspace of ROS 1."""
    if not is_here(item.path):
        return False
    return "ros1_workspace" in getattr(item, "fixturenames", ()) or "ros1" in parameters(item).values()


def group(item: pytest.Item) -> str:
    """The run of nodes that a test looks at, or else the test itself."""
    names = getattr(item, "fixturenames", ())
    run = next((name for name in RUNS if name in names), None)
    if run is None:
        return item.nodeid
    given = parameters(item)
    return " ".join([run, *(str(given[name]) for name in (*RUNS, *KINDS) if name in given)])


def parameters(item: pytest.Item) -> dict[str, Any]:
    """The values of a test's parameters by name."""
    callspec = getattr(item, "callspec", None)
    return dict(callspec.params) if callspec else {}


@dataclass
class Kept:
    """What the tests of one group share: names to what was made, and how it is given up."""

    ends: ExitStack = field(default_factory=ExitStack)
    made: dict[str, Any] = field(default_factory=dict)

    def end(self) -> None:
        """Gives all of it up."""
        self.made.clear()
        self.ends.close()


_KEPT = Kept()


@pytest.fixture
def kept() -> Callable[[str, Callable[[], AbstractContextManager[Any]]], Any]:
    """`kept(name, make)`: what the context of `make` yields, the same for all tests of a group; left after the last."""

    def one(name: str, make: Callable[[], AbstractContextManager[Any]]) -> Any:
        if name not in _KEPT.made:
            try:
                _KEPT.made[name] = _KEPT.ends.enter_context(make())
            except Exception as error:  # not to be tried, and waited for, again
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
    """Has `ros1_workspace` built from the first test on, if it is needed at all."""
    if any(map(needs_ros1_workspace, request.session.items)) and find_ros1().ros is not None:
        request.getfixturevalue("ros1_build")


@pytest.fixture(scope="session")
def workspace(request: pytest.FixtureRequest) -> Workspace:
    built: Workspace = request.getfixturevalue(f"{request.param}_workspace")
    return built


@pytest.fixture(scope="session")
def nodes(request: pytest.FixtureRequest) -> Workspace | Runner:
    """Nodes of every kind, to be started by their packages' names: compiled, and run straight from their models."""
    return nodes_of(request, request.param)


@pytest.fixture(scope="session")
def layers(request: pytest.FixtureRequest) -> Workspace | Runner:
    """The kinds of nodes that layers can be: those of ROS 2."""
    return nodes_of(request, request.param)


def nodes_of(request: pytest.FixtureRequest, kind: str) -> Workspace | Runner:
    """Return the nodes of one of the kinds `NODES`."""
    made: Workspace | Runner = request.getfixturevalue("run_ros2" if kind == "run-ros2" else f"{kind}_workspace")
    return made


@pytest.fixture(scope="session")
def drive(nodes: Workspace | Runner, tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """The line follower in its scenario, from start to end, in simulated time."""
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
    """The courier, sent one message after the other, in real time."""
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
