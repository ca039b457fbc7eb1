"""Scenarios that wait while timers run: any wait, any period, any number of restarting timers."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from click.testing import CliRunner

import robosc
from robosc.base.ros_types import RosTypes
from robosc.language import configuration as config
from robosc.run.node_tests.drive import parameters
from robosc.run.node_tests.samples import all_incoming
from robosc.run.node_tests.trace_player import Log, Player, read_trace
from robosc.run.node_tests.trace_test import player_files
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.tools.cli import main
from tests.run.node_tests import in_process_node
from tests.run.node_tests.test_traces import be_impatient

CLOCK = """\
robot Clock {
  component C {
    outgoing message start with identifier: "/start", type: none

    behaviour {
      variable n: integer(0..600) = 0

      initial marked state off {
        on response from start goto on
      }

      marked state on {
        after LENGTH ms do n := n + 1 goto on
      }
    }
  }

  component D {
    incoming message cmd with identifier: "/cmd", type: none
  }

  requirement cmd needs C.n < 600
}
"""
#: Periods, timers and waits in milliseconds. A timer of a period minus 1 ms coincides with every tick.
MEETING = [(100, 99, 40_000), (100, 199, 90_000), (10, 9, 3_000), (1, 1, 600), (100, 1000, 50_000), (20, 7, 1_000)]


def some(count: int) -> list[tuple[int, int, int]]:
    """Return other periods, timers and waits."""
    choice = random.Random(5)  # noqa: S311  # the same each time
    periods = [choice.randrange(1, 400) for _ in range(count)]
    lengths = [choice.randrange(1, 8 * period + 1) for period in periods]
    return [(*both, both[1] * choice.randrange(1, 500)) for both in zip(periods, lengths, strict=True)]


class _LatestFirst(EventLoop):
    """An event loop that makes due calls in reverse order, as an executor may: the tick before the timers."""

    def run_pending(self) -> float | None:
        while due := [planned for planned in self._timers if planned[0] <= self.clock()]:
            self._timers.remove(max(due))
            max(due)[2].fire()
        return super().run_pending()


@pytest.mark.slow
@pytest.mark.parametrize(("period", "length", "wait"), [*MEETING, *some(18)])
def test_every_wait_passes(
    period: int, length: int, wait: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The timer expires as often as time permits. A node does the same, whatever the order of its timer callbacks."""
    monkeypatch.chdir(tmp_path)
    whole = -(-wait // period) * period
    # It starts up to a millisecond late, and the clock stops a millisecond after its time.
    least, most = int(whole / (length + 2.1)) - 1, whole // length
    Path("clock.rscd").write_text(CLOCK.replace("LENGTH", str(length)))
    Path("clock.scenarios").write_text(
        f'scenario "it counts"\n  start\n  wait {wait} ms\n  expect C.n >= {least} and C.n <= {most}\n'
    )
    Path(config.FILE_NAME).write_text(json.dumps({"controlLoop": {"periodMs": period}}))
    command = ["test", "clock.rscd", "clock.scenarios", "--traces", "traces", "--config", config.FILE_NAME]
    answer = CliRunner().invoke(main, command, catch_exceptions=False)
    assert answer.exit_code == 0, answer.output

    robot, configuration = robosc.load("clock.rscd"), config.read(config.FILE_NAME)
    robosc.synthesize(robosc.to_sct(robot))
    graph = robosc.to_rosgraph(robot)
    started = parameters(graph, configuration)
    files = player_files(graph, configuration, started, all_incoming(graph, RosTypes().distributions[0]))
    be_impatient(monkeypatch)
    monkeypatch.setattr(in_process_node, "EventLoop", _LatestFirst)
    connections = json.loads(files["connections.json"])
    node = in_process_node.InProcessNode(connections, graph, configuration, Path("events.jsonl"))
    [trace] = Path("traces").iterdir()
    Player(connections, node, Log("events.jsonl")).play(read_trace(str(trace)))


def test_many_short_waits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("clock.rscd").write_text(CLOCK.replace("LENGTH", "1000"))
    steps = "".join(f"  wait {500 + 10 * number} ms\n" for number in range(41))
    Path("clock.scenarios").write_text(f'scenario "steps"\n  start\n{steps}  expect C.n >= 29 and C.n <= 30\n')
    answer = CliRunner().invoke(main, ["test", "clock.rscd", "clock.scenarios"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output


CHAIN = """\
robot Chain {
  component C {
    outgoing message start with identifier: "/start", type: none

    behaviour {
      initial marked state off { on response from start goto first }
      marked state first { after 500 ms goto second }
      marked state second { after 500 ms goto third }
      marked state third { after 1 s goto first on response from start goto off }
    }
  }
}
"""


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
@pytest.mark.parametrize(
    ("steps", "state"),
    [
        ("wait 500 ms", "second"),
        ("wait 400 ms", "first"),
        ("wait 1 s", "third"),
        ("wait 500 ms\nwait 500 ms", "third"),
        ("wait 250 ms\nwait 250 ms", "second"),
        ("repeat 5 { wait 100 ms }", "second"),
        ("wait 2 s", "first"),
        ("wait 2 s\nwait 500 ms", "second"),
        ("wait 500 ms\nwait 500 ms\nstart", "off"),
    ],
)
def test_a_time_that_is_up_at_the_end_of_a_wait_has_expired(
    steps: str, state: str, engine: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tick of the control loop is due at the same moment."""
    monkeypatch.chdir(tmp_path)
    Path("chain.rscd").write_text(CHAIN)
    Path("chain.scenarios").write_text(f'scenario "one"\nstart\n{steps}\nexpect C.{state}\n')
    answer = CliRunner().invoke(
        main, ["test", "chain.rscd", "chain.scenarios", "--engine", engine], catch_exceptions=False
    )
    assert answer.exit_code == 0, answer.output


def test_a_wait_goes_beyond_its_time_by_less_than_a_period(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A timer that restarts each millisecond is late each time; other times must not be up too early."""
    monkeypatch.chdir(tmp_path)
    Path("clock.rscd").write_text(CLOCK.replace("LENGTH", "1"))
    Path("clock.scenarios").write_text('scenario "one"\n  start\n  wait 100 ms\n  expect C.n >= 30 and C.n <= 70\n')
    answer = CliRunner().invoke(main, ["test", "clock.rscd", "clock.scenarios"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
