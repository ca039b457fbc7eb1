"""The emergency stops of the standard library, in the control loop of a robot that drives when permitted."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

ROVER = """
robot Rover {
  component EmergencyStop from EmergencyStopLibrary import %s
  component Platform from TurtlebotLibrary import TurtlebotPlatform

  requirement move needs EmergencyStop.in_service
  requirement halt needs EmergencyStop.stopped

  provide move with { linear: { x: 0.2 } }
  provide halt with { linear: { x: 0.0 } }
}
"""
PERIODIC, SHORT, LATCHED = "PeriodicEmergencyStop", "PeriodicEmergencyStop(patience: 200)", "LatchedEmergencyStop"
REAL = pytest.mark.parametrize("component", [PERIODIC, LATCHED])
PRESSED, RELEASED = (f'message_pressed.u_response {{"value": {value}}}' for value in ("true", "false"))
CONTINUE = "message_continue.u_response"


def states(folder: Path, component: str, *lines: str) -> str:
    """Return `m` or `h` for each line of a script: the command that the robot sends at the next tick."""
    path = folder / "rover.rscd"
    path.write_text(ROVER % component)
    script = "\n".join(f"{line}\ntick" for line in lines)
    done = CliRunner().invoke(main, ["simulate", str(path), "--loop", "--script", "-"], script)
    assert done.exit_code == 0, done.stderr
    ticks = [json.loads(line)["happened"] for line in done.stdout.splitlines()][1::2]
    sent = [[event.split("_")[1][0] for event in happened if event.endswith(".c_trigger")] for happened in ticks]
    assert all(len(commands) == 1 for commands in sent)
    return "".join(commands[0] for commands in sent)


@REAL
def test_the_robot_begins_stopped(tmp_path: Path, component: str) -> None:
    assert states(tmp_path, component, "tick", CONTINUE, RELEASED, RELEASED) == "hhhh"


@REAL
def test_a_new_acknowledgement_sets_the_robot_going(tmp_path: Path, component: str) -> None:
    assert states(tmp_path, component, RELEASED, CONTINUE, PRESSED, RELEASED, RELEASED, CONTINUE) == "hmhhhm"


@REAL
def test_an_acknowledgement_does_not_count_while_the_button_is_pressed(tmp_path: Path, component: str) -> None:
    assert states(tmp_path, component, RELEASED, CONTINUE, PRESSED, CONTINUE, RELEASED) == "hmhhh"
    assert states(tmp_path, component, RELEASED, PRESSED, CONTINUE) == "hhh"


@pytest.mark.parametrize(("component", "patience"), [(PERIODIC, 0.5), (SHORT, 0.2)])
def test_silence_stops_the_robot_until_a_new_acknowledgement(tmp_path: Path, component: str, patience: float) -> None:
    short, rest = f"wait {patience - 0.1}", "wait 0.1"
    heard = states(tmp_path, component, RELEASED, CONTINUE, short, RELEASED, short, rest, CONTINUE, RELEASED, CONTINUE)
    assert heard == "hmmmmhhhm"


def test_a_released_button_that_fell_silent_is_not_known_to_be_released(tmp_path: Path) -> None:
    assert states(tmp_path, PERIODIC, RELEASED, "wait 0.5", CONTINUE) == "hhh"


def test_silence_of_a_latched_button_is_not_noticed(tmp_path: Path) -> None:
    assert states(tmp_path, LATCHED, RELEASED, CONTINUE, "wait 60") == "hmm"


def test_two_buttons_have_topics_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "two.rscd"
    rear = 'component Rear from EmergencyStopLibrary import PeriodicEmergencyStop(ns: "/rear") component Platform'
    path.write_text((ROVER % PERIODIC).replace("component Platform", rear, 1))
    done = CliRunner().invoke(main, ["check", str(path)])
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "")
