"""Nodes of `scout.rscd`, compiled for ROS 1 or 2 or run from the model, with their world and their server."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.ros import running, workspaces
from tests.ros.conftest import NODES, nodes_of
from tests.ros.faults.partners import Peer, Scout

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    Keep = Callable[[str, Callable[[], AbstractContextManager[Scout]]], Scout]

HERE = Path(__file__).parent
MODEL = HERE / "scout.rscd"
PACKAGE = "scout_controller"
#: Time for which a patient node waits for the acceptance of a goal.
ACCEPTANCE_SECONDS = 60


@dataclass(frozen=True)
class Compiled:
    """A generated and compiled node."""

    place: workspaces.Workspace

    def command(self, *parameters: str) -> list[str | Path]:
        """Return the command that starts the node as one process, with parameters (`name:=value`)."""
        if self.place.ros.version == 2:
            return self.place.node(PACKAGE, *parameters)
        executable = self.place.folder / f"devel/lib/{PACKAGE}/{PACKAGE}"
        return [executable, f"__name:={PACKAGE}", *(f"_{parameter}" for parameter in parameters)]


@dataclass(frozen=True)
class Running:
    """A node run from its model."""

    place: running.Runner

    def command(self, *parameters: str) -> list[str | Path]:
        """Return the command that starts the node as one process, with parameters (`name:=value`)."""
        return [*self.place.command(MODEL, *parameters, own_types=True)]


Controller = Compiled | Running


@pytest.fixture(scope="session", params=NODES)
def controller(request: pytest.FixtureRequest) -> Controller:
    nodes = nodes_of(request, request.param)
    return Running(nodes) if isinstance(nodes, running.Runner) else Compiled(nodes)


@contextmanager
def scouting(controller: Controller, folder: Path, *parameters: str, clock: float | None = None) -> Iterator[Scout]:
    """Run a node among its peers, in real time or, with `clock`, in simulated time from this second on."""
    ros = controller.place.ros
    peers: list[Peer] = []
    with workspaces.middleware(controller.place, folder, simulated=clock is not None) as processes:

        def meet(name: str) -> Peer:
            peers.append(Peer(processes, ros.python, ros.version, name))
            return peers[-1]

        events = folder / "events.jsonl"
        scout = Scout(
            ros.version,
            processes,
            lambda name: processes.start(name, controller.command(f"event_log:={events}", *parameters)),
            meet,
            folder,
            events,
        )
        if clock is not None:
            scout.world.do("clock", seconds=clock)
        yield scout.ready()
        for peer in peers:
            # The peers need no orderly end.
            peer.process.kill()


@pytest.fixture
def under_way(controller: Controller, kept: Keep, tmp_path_factory: pytest.TempPathFactory) -> Scout:
    """A node that reports a silent sensor and drives on, shared by the tests of all faults that it survives."""
    return kept("under way", lambda: scouting(controller, tmp_path_factory.mktemp("faults") / "run"))


@pytest.fixture
def scout(under_way: Scout, request: pytest.FixtureRequest) -> Iterator[Scout]:
    """The shared node, at rest and driving."""
    with resting(under_way, request):
        yield under_way


@pytest.fixture
def with_patience(controller: Controller, kept: Keep, tmp_path_factory: pytest.TempPathFactory) -> Scout:
    """A node with long timeouts for the acceptance of a goal and for an answer, for busy machines."""
    parameters = [f"{name}_timeout_ms:={1000 * ACCEPTANCE_SECONDS}" for name in ("action", "service")]
    return kept("with patience", lambda: scouting(controller, tmp_path_factory.mktemp("patient") / "run", *parameters))


@pytest.fixture
def patient(with_patience: Scout, request: pytest.FixtureRequest) -> Iterator[Scout]:
    """The patient node, at rest and driving."""
    with resting(with_patience, request):
        yield with_patience


@contextmanager
def resting(scout: Scout, request: pytest.FixtureRequest) -> Iterator[None]:
    """Bring a node to rest; after a failed test, replace the server with its open calls and goals."""
    scout.rest()
    failed = request.session.testsfailed
    yield
    if request.session.testsfailed > failed:
        scout.kill_server()
        scout.serve()
        scout.nothing(1.0)


@pytest.fixture
def with_guard(controller: Controller, kept: Keep, tmp_path_factory: pytest.TempPathFactory) -> Scout:
    """A node that stops when its sensor is silent, for tests that end it, with a long timeout for goals."""
    parameters = ["watchdog_stops:=true", "action_timeout_ms:=15000"]
    return kept("with guard", lambda: scouting(controller, tmp_path_factory.mktemp("guarded") / "run", *parameters))


@pytest.fixture
def guarded(with_guard: Scout) -> Scout:
    """The guarded node, restarted if a test has ended it."""
    if with_guard.process.poll() is not None:
        with_guard.restart()
        with_guard.ready()
    return with_guard
