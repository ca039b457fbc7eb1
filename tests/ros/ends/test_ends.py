"""A lift must not rise before the wheels have stopped, for any behavior of the action server of the wheels.

The model `carrier.rscd` becomes a controller and a layer. The controller behind the layer is `careless.rscd`, which
raises the lift as soon as the button is pressed. The server ends its goal when the test decides that the wheels have
stopped.
"""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.conftest import KILTED, nodes_of
from tests.ros.ends.base import CANCELED, ERROR, LATE, RESPONSE, TRIGGER, WAIT_MS, Base, Drive, under_way
from tests.ros.processes import PATIENCE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

REFUSED = "the server refuses to cancel the goal"
UNANSWERED = f"the server does not answer the request to cancel the goal within {WAIT_MS} ms"
#: Longer than the node waits for an answer, in seconds.
LONG = WAIT_MS / 1000 + 0.5
#: Kinds of the node under test: compiled or run from its model, version of ROS, controller or layer.
NODES = [
    pytest.param(kind, layer, id=f"{kind}-{'layer' if layer else 'controller'}")
    for kind in ("ros1", "run-ros2", "ros2")
    for layer in (False, True)
    if not (kind == "ros1" and layer)
]
NODES.append(pytest.param(KILTED, False, id=KILTED, marks=pytest.mark.matrix))
pytestmark = pytest.mark.parametrize(("kind", "base"), NODES, indirect=["base"])


@pytest.fixture
def base(
    kind: str,
    request: pytest.FixtureRequest,
    kept: Callable[[str, Callable[[], Any]], Base],
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Base]:
    """A base at rest; after a failed test, a new server takes the place of the old one."""
    nodes = nodes_of(request, kind)
    layer = request.param
    folder = tmp_path_factory.mktemp("ends") / "run"
    made = kept(f"{kind} {layer}", lambda: under_way(nodes, folder, layer=layer))
    if made.node.poll() is not None:
        made.start()
    failed = request.session.testsfailed
    yield made
    made.resume_server()
    if request.session.testsfailed > failed:
        made.kill_server()
        made.serve()
    if made.node.poll() is None:
        made.rest()


@pytest.mark.parametrize(("how", "event"), [("cancelled", CANCELED), ("succeeded", RESPONSE)])
def test_it_brakes(base: Base, how: str, event: str) -> None:
    """The lift rises after the braking goal ends, as canceled or as succeeded."""
    drive = Drive.begin(base)
    drive.press()
    drive.until_asked()
    drive.rolls(LONG)
    drive.end(how)
    drive.until_lifted(event)
    assert drive.events.count(TRIGGER) == 1
    assert drive.asked == 1, "an accepted request is not repeated"
    assert REFUSED not in base.output


def test_it_aborts_when_it_shall_stop(base: Base) -> None:
    drive = Drive.begin(base)
    drive.press()
    drive.until_asked()
    drive.end("aborted")
    drive.until(ERROR)
    drive.never_lifted()


def test_it_refuses_to_stop(base: Base) -> None:
    if base.version == 1:
        pytest.skip("a server of ROS 1 can't refuse, it can only go on")
    drive = Drive.begin(base)
    base.server.do("on_cancel", answer="refuse")
    drive.press()
    drive.until_asked(3)
    base.until(lambda: base.warns(f"/navigate: {REFUSED}"), "the diagnostics warn")
    drive.rolls(0.0)
    base.server.do("on_cancel", answer="ignore")
    asked = drive.asked
    drive.until_asked(asked + 1)
    base.until(lambda: not base.warns(REFUSED), "the diagnostics warn no more")
    asked = drive.asked
    drive.rolls(LONG)
    assert drive.asked == asked, "an accepted request is not repeated"
    drive.end("cancelled")
    drive.until_lifted(CANCELED)


def test_it_does_not_answer(base: Base) -> None:
    drive = Drive.begin(base)
    base.pause_server()
    drive.press()
    base.until(lambda: base.warns(f"/navigate: {UNANSWERED}"), "the diagnostics warn")
    assert f"/navigate: {UNANSWERED}" in base.output
    drive.rolls(0.0)
    base.resume_server()
    drive.until_asked()
    drive.rolls(LONG)
    drive.end("cancelled")
    drive.until_lifted(CANCELED)


def test_it_accepts_late(base: Base) -> None:
    late = base.output.count(LATE)
    drive = Drive.begin(base, accept=False)
    base.until(lambda: base.output.count(LATE) > late, "the node says so")
    drive.press()
    drive.rolls(0.0)
    base.server.do("decide", number=drive.number, accept=True)
    drive.until_asked()
    drive.rolls(LONG)
    drive.end("cancelled")
    drive.until_lifted(CANCELED)


def test_someone_else_stops_it(base: Base) -> None:
    """The base cancels a goal that another client is already canceling."""
    drive = Drive.begin(base)
    base.server.do("cancel_elsewhere", number=drive.number)
    drive.rolls(LONG)
    drive.press()
    drive.rolls(LONG)
    drive.end("cancelled")
    drive.until_lifted(CANCELED)


def test_someone_else_has_stopped_it(base: Base) -> None:
    drive = Drive.begin(base)
    drive.end("cancelled")
    drive.until(ERROR)
    base.send("/pressed", value=True)
    drive.never_lifted()


def test_it_dies(base: Base) -> None:
    drive = Drive.begin(base)
    base.kill_server()
    base.send("/pressed", value=True)
    drive.until(ERROR)
    drive.never_lifted()
    assert "/navigate: the server is gone" in base.output
    base.serve()
    base.outlive_server()


def test_it_is_started_anew(base: Base) -> None:
    """The new server does not know the goal, but offers everything that the old one offered."""
    drive = Drive.begin(base)
    base.kill_server()
    base.serve()
    base.send("/pressed", value=True)
    drive.until(ERROR)
    drive.never_lifted()
    base.outlive_server()


def test_the_node_ends_while_it_brakes(base: Base) -> None:
    drive = Drive.begin(base)
    drive.press()
    drive.until_asked()
    os.kill(base.node.pid, signal.SIGINT)
    assert base.node.wait(PATIENCE) == 0
    ends = "layer" if base.layer else "node"
    assert f"/navigate: the goal has not ended when this {ends} ends: the server cancels the goal" in base.output
    drive.end("cancelled")


def test_the_node_ends_while_it_goes_on(base: Base) -> None:
    drive = Drive.begin(base)
    if base.version == 1:
        base.pause_server()
        drive.press()
        why = UNANSWERED
        base.until(lambda: UNANSWERED in base.output, "the node says so")
    else:
        base.server.do("on_cancel", answer="refuse")
        drive.press()
        why = REFUSED
        drive.until_asked()
        base.until(lambda: REFUSED in base.output, "the node says so")
    os.kill(base.node.pid, signal.SIGINT)
    assert base.node.wait(PATIENCE) == 0
    ends = "layer" if base.layer else "node"
    assert f"/navigate: the goal has not ended when this {ends} ends: {why}" in base.output
    base.resume_server()
    drive.end("succeeded")


def test_the_end_of_a_goal_is_in_the_log_when_the_node_ends(base: Base) -> None:
    if base.layer:
        pytest.skip("a layer that ends leaves goals that it need not cancel to the controller")
    drive = Drive.begin(base)
    base.until(lambda: base.state("Navigation") == "driving", "it drives")
    base.server.do("on_cancel", answer="grant")
    os.kill(base.node.pid, signal.SIGINT)
    assert base.node.wait(PATIENCE) == 0
    assert {CANCELED, ERROR} & set(drive.events)
    assert "when this node ends" not in base.output
