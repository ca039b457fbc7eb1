"""Timers: each test checks one statement about "after" on the language's page on transitions."""

from pathlib import Path

import pytest

import robosc
from robosc.engine import ControlLoop, Hooks, Settings

ROBOT = """
robot R {{
  component Lidar {{ outgoing message scan with identifier: "/scan", type: none }}
  component Button {{ outgoing message pressed with identifier: "/pressed", type: none }}
  component Base {{
    incoming message move with identifier: "/move", type: none
    behaviour {{
      variable times: integer(0..9) = 0
      {behaviour}
    }}
  }}
  {rest}
}}
"""


class Robot:
    """A robot with this behavior; `heard` has its events with their times."""

    def __init__(self, folder: Path, behaviour: str, rest: str = "requirement move needs Base.times > 9") -> None:
        path = folder / "robot.rscd"
        path.write_text(ROBOT.format(behaviour=behaviour, rest=rest))
        loaded = robosc.load(path)
        assert [finding for finding in robosc.check(loaded) if finding.severity == "error"] == []
        model = robosc.to_sct(loaded)
        robosc.synthesize(model)
        self.heard: list[tuple[int, str]] = []
        self.loop = ControlLoop(model, Settings(), Hooks(after=self._hear))

    def _hear(self, event: str) -> None:
        self.heard.append((self.loop.timers.now, event.removeprefix("component_Base.").removeprefix("message_")))

    def wait(self, milliseconds: int) -> None:
        """Advance the clock and call the loop at each time that the robot requests."""
        timers = self.loop.timers
        end = timers.now + milliseconds
        while timers.wait is not None and timers.now + timers.wait <= end:
            timers.at(timers.now + timers.wait)
            self.loop.expire()
        timers.at(end)

    def hear(self, message: str) -> None:
        self.loop.begin()
        self.loop.perform(f"message_{message}.u_response")
        self.loop.end()

    def timeouts(self) -> list[tuple[int, str]]:
        return [(at, event) for at, event in self.heard if event.startswith("u_after")]


def test_time_since_the_state_was_entered(tmp_path: Path) -> None:
    """`after 3.0 s goto rotating` in a state counts from the entry of the state."""
    robot = Robot(
        tmp_path,
        "initial marked state idle { on response from pressed goto driving } state driving { after 3.0 s goto idle }",
    )
    robot.wait(10_000)
    assert robot.timeouts() == []
    robot.hear("pressed")
    robot.wait(2_999)
    assert robot.timeouts() == []
    robot.wait(1)
    assert robot.timeouts() == [(13_000, "u_after1")]
    assert robot.loop.state["component_Base"] == "idle"
    robot.wait(10_000)
    assert len(robot.timeouts()) == 1


@pytest.mark.parametrize(("target", "up"), [("goto idle", 1_500), ("", 1_000), ("do times := 1 goto idle", 1_500)])
def test_entering_again_starts_anew_and_staying_does_not(tmp_path: Path, target: str, up: int) -> None:
    """Entering a state again, also by `goto` to the same state, restarts its timer.

    A transition without `goto` does not.
    """
    robot = Robot(
        tmp_path,
        f"initial marked state idle {{ after 1 s goto other on response from pressed {target} }}"
        " marked state other { }",
    )
    robot.wait(500)
    robot.hear("pressed")
    robot.wait(5_000)
    assert robot.timeouts() == [(up, "u_after1")]


@pytest.mark.parametrize(("target", "times"), [("", [1000]), ("goto idle", [1000, 2000, 3000])])
def test_each_fires_once_for_each_entry(tmp_path: Path, target: str, times: list[int]) -> None:
    """A timer fires once per entry or silence. Its own `goto` to the same state is an entry."""
    robot = Robot(tmp_path, f"initial marked state idle {{ after 1 s do times := times + 1 {target} }}")
    robot.wait(3_500)
    assert [at for at, _ in robot.timeouts()] == times
    assert robot.loop.state["Base.times"] == len(times)


def test_the_initial_state_is_entered_when_the_node_starts(tmp_path: Path) -> None:
    """The initial state is entered when the node starts.

    A managed node enters it when it is activated, which restarts timers.
    """
    robot = Robot(tmp_path, "initial marked state idle { after 1 s goto idle }")
    robot.loop.timers.at(600)
    robot.loop.timers.restart()
    robot.wait(999)
    assert robot.timeouts() == []
    robot.wait(1)
    assert robot.timeouts() == [(1600, "u_after1")]


def test_a_silence_in_a_state(tmp_path: Path) -> None:
    """In a state, a silence counts from the entry or the last message, whichever is later.

    It fires once per silence.
    """
    robot = Robot(
        tmp_path,
        "initial marked state idle { on response from pressed goto seeing }"
        " marked state seeing { after 500 ms without scan, pressed do times := times + 1 }",
    )
    robot.hear("scan")
    robot.wait(400)
    robot.hear("pressed")
    robot.wait(400)
    robot.hear("scan")
    robot.wait(400)
    robot.hear("pressed")
    robot.wait(2_000)
    assert robot.timeouts() == [(1_700, "u_after1")]
    robot.hear("scan")
    robot.wait(2_000)
    assert robot.timeouts() == [(1_700, "u_after1"), (3_700, "u_after1")]


def test_a_silence_at_automaton_level(tmp_path: Path) -> None:
    """At automaton level, a silence counts from the last message or from the node's start, in every state."""
    robot = Robot(
        tmp_path,
        "after 500 ms without scan goto blind"
        " initial marked state idle { on response from pressed goto idle }"
        " state blind { on response from scan goto idle }",
    )
    robot.wait(300)
    robot.hear("pressed")
    robot.wait(300)
    assert robot.timeouts() == [(500, "u_after1")]
    robot.wait(2_000)
    assert len(robot.timeouts()) == 1
    robot.hear("scan")
    robot.wait(2_000)
    assert robot.timeouts() == [(500, "u_after1"), (3_100, "u_after1")]


def test_what_arrived_before_a_time_was_up_is_handled_before(tmp_path: Path) -> None:
    """A message that arrives before a timer expires is handled first: the caller delivers both in that order."""
    robot = Robot(
        tmp_path,
        "initial marked state idle { after 1 s goto late on response from pressed goto early }"
        " marked state early { } marked state late { }",
    )
    robot.loop.timers.at(5_000)  # the loop was not called meanwhile
    robot.hear("pressed")
    assert robot.loop.expire() is None
    assert robot.loop.state["component_Base"] == "early"


def test_times_that_are_up_together(tmp_path: Path) -> None:
    """Expired timers fire in the order of their expiry, ties in text order. Each settles before the next."""
    robot = Robot(
        tmp_path,
        "variable over: boolean = false"
        " initial marked state idle { after 20 ms do times := 1 after 10 ms do over := true after 20 ms do times := 2"
        " after 20 ms goto done transition if over and times = 1 do times := 3, over := false }"
        " marked state done { after 5 ms goto idle }",
    )
    robot.loop.timers.at(1_000)
    while robot.loop.expire():
        pass
    assert [event for _, event in robot.heard] == ["u_after2", "u_after1", "c_tau1", "u_after3", "u_after4"]
    assert robot.loop.timers.running == {"component_Base.u_after5": 5}


def test_a_state_that_is_left_has_no_time(tmp_path: Path) -> None:
    """A timer lasts as long as its state: if two expire together, the first may leave the state of the second."""
    robot = Robot(
        tmp_path,
        "initial marked state idle { after 10 ms goto over after 10 ms do times := 1 } marked state over { }",
    )
    robot.wait(1_000)
    assert [event for _, event in robot.heard] == ["u_after1"]
    assert robot.loop.timers.wait is None


def test_a_time_that_goes_back_starts_all_anew(tmp_path: Path) -> None:
    """A clock that goes backward restarts all timers."""
    robot = Robot(
        tmp_path,
        "after 3 s without scan do times := 1"
        " initial marked state idle { after 1 s do times := 2 after 2 s goto idle }",
    )
    robot.loop.timers.at(1_500)
    robot.loop.expire()
    robot.loop.timers.at(1_400)
    assert robot.loop.timers.running == {"component_Base.u_after1": 3_000, "component_Base.u_after3": 2_000}


def test_it_is_handled_as_incoming_data_is(tmp_path: Path) -> None:
    """A timeout is handled like incoming data: event, settle, react."""
    robot = Robot(
        tmp_path,
        "initial marked state idle { after 1 s goto waiting } marked state waiting { transition if times = 0 goto go }"
        " marked state go { on request to move goto idle }",
        "",
    )
    robot.loop.tick()
    robot.wait(1_000)
    assert robot.heard == [(1_000, "u_after1"), (1_000, "c_tau1"), (1_000, "move.c_trigger")]


def test_no_time_is_up_early_where_now_is_rounded_down(tmp_path: Path) -> None:
    """`resolution_ms` is the clock error: the real time may be this much later than `now`."""
    robot = Robot(tmp_path, "initial marked state idle { after 1 s goto idle }")
    robot.loop = ControlLoop(robot.loop.engine.model, Settings(resolution_ms=1), Hooks(after=robot._hear))
    robot.wait(5_000)
    assert robot.timeouts() == [(1_001 * number, "u_after1") for number in (1, 2, 3, 4)]


def test_names_and_durations(tmp_path: Path) -> None:
    """Units `ms`, `s` and `min`; constants of type integer or double; `component_X.u_after1…` in text order."""
    robot = Robot(
        tmp_path,
        "after 2 min without scan goto idle"
        " initial marked state idle { after hold s goto idle after 7 ms goto idle }"
        " marked state other { after tenth * 3 s }",
        "constant hold: integer = 3 constant tenth: double = 0.1",
    )
    timers = {timer.event.name: timer.milliseconds for timer in robot.loop.engine.executed.timers}
    assert timers == {
        "component_Base.u_after1": 120_000,
        "component_Base.u_after2": 3_000,
        "component_Base.u_after3": 7,
        "component_Base.u_after4": 300,
    }
