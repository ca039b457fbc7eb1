"""`robosc test` with a node: users' scenarios over ROS 2, on nodes run from models and on a compiled node."""

from __future__ import annotations

import shlex
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

from tests.ros.running import PROJECT, Runner
from tests.ros.workspaces import EXAMPLES, Workspace, middleware
from tests.test_assumptions import SCENARIO, SHOP

if TYPE_CHECKING:
    from pathlib import Path

LINE_FOLLOWER = EXAMPLES / "line_follower" / "line_follower.rscd"
STOPS = """\
scenario "stops"
  pressed with false
  continue
  response from correction with 0.1
  response from scan with clear
  expect move sent with {"linear": {"x": 0.2}}
  pressed with true
  expect halt sent
"""
PUMP = """\
robot Plant {
  component Pump {
    service fill with identifier: "/fill", request: none, response: none

    behaviour {
      initial state empty {
        on request to fill goto filling
      }

      state filling {
        on response from fill goto full
        on error from fill goto pausing
      }

      state pausing {
        after 2 s goto empty
      }

      marked state full {}
    }
  }
}
"""
FILLS = """\
scenario "a call that fails, a pause, and another call"
  expect fill sent
  error from fill
  expect Pump.pausing
  wait 1500 ms
  expect Pump.pausing
  wait 3 s
  expect fill sent
  response from fill
  expect Pump.full
"""


def played(
    nodes: Workspace | Runner, python: str, folder: Path, text: str, *options: str, model: Path = LINE_FOLLOWER
) -> tuple[int, str]:
    """Run `robosc test`; return its exit status and its output."""
    scenarios = folder / "own.scenarios"
    scenarios.write_text(text, encoding="utf-8")
    command = [python, "-m", "robosc", "test", str(model), str(scenarios), "--ros2", *options]
    with middleware(nodes, folder / "run") as processes:
        environment = {**processes.environment, "PYTHONPATH": _path(processes.environment)}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600, check=False)
    return done.returncode, done.stdout + done.stderr


def _path(environment: dict[str, str]) -> str:
    return ":".join(filter(None, (str(PROJECT), environment.get("PYTHONPATH"))))


def test_a_node_plays_scenarios(run_ros2: Runner, tmp_path: Path) -> None:
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, STOPS)
    assert (status, "1 passed in" in said) == (0, True), said


def test_a_call_that_fails_and_times(run_ros2: Runner, tmp_path: Path) -> None:
    model = tmp_path / "plant.rscd"
    model.write_text(PUMP, encoding="utf-8")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, FILLS, model=model)
    assert (status, "1 passed in" in said) == (0, True), said


LAMP = """\
robot Lamp {
  component Door {
    outgoing message closed with identifier: "/closed", type: boolean

    behaviour {
      initial marked state unknown { on response from closed if value goto shut }
      marked state shut {
        on response from closed if !value goto unknown
        after 1 s without closed goto unknown
      }
    }
  }

  component Timer {
    outgoing message start with identifier: "/start", type: none
    incoming message lamp with identifier: "/lamp", type: double

    behaviour {
      initial marked state off { on response from start goto waiting }
      marked state waiting { after 1 s goto lit }
      marked state lit { on response from start goto waiting }
    }
  }

  requirement lamp needs Door.shut and Timer.lit
  provide lamp with 0.5
}
"""
SHINES = """\
before each {
  every 500 ms response from closed with true
  start
}

scenario "a time is up at the end of a wait"
  wait 500 ms
  wait 500 ms
  expect Timer.lit
  start
  expect lamp not sent

scenario "steps come again and again"
  repeat 2 {
    expect lamp sent with {"data": 0.5} within 2 s
    start
    wait 1100 ms
  }
  wait 300 ms
  expect lamp sent 3 times with 0.5
  stop closed
  expect Door.unknown within 2 s
  wait 200 ms
  expect lamp not sent
"""


def test_repeated_steps_and_times(run_ros2: Runner, tmp_path: Path) -> None:
    model = tmp_path / "lamp.rscd"
    model.write_text(LAMP, encoding="utf-8")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, SHINES, model=model)
    assert (status, "2 passed in" in said) == (0, True), said


VISITOR = PROJECT / "tests" / "run" / "scenario_tests" / "visitor.rscd"
VISITS = """\
scenario "a client is rejected, sends a goal, and cancels it; calls wait meanwhile"
  request from visit with {"pose": {"pose": {"position": {"x": 0.5}}}}
  expect visit rejected
  request from visit with {"pose": {"pose": {"position": {"x": 1.0}}}}
  request from light with {"data": true}
  request from light with {"data": false}
  stuck
  expect feedback to visit sent with {"number_of_recoveries": 1}
  cancel from visit
  expect canceled to visit sent
  expect response to light sent 2 times
  request from visit with {"pose": {"pose": {"position": {"x": 2.0}}}}
  wait 3 s
  expect error to visit sent
  request from visit with {"pose": {"pose": {"position": {"x": 3.0}}}}
  there
  expect response to visit sent
"""


def test_clients_of_the_controller(run_ros2: Runner, tmp_path: Path) -> None:
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, VISITS, model=VISITOR)
    assert (status, "1 passed in" in said) == (0, True), said


LIFT = """
robot Shared {
  component Lift {
    outgoing message wish with identifier: "/wish", type: boolean
    service raise with identifier: "/lift/set", request: std_srvs/SetBool, response: std_srvs/SetBool
    service lower with identifier: "/lift/set", request: std_srvs/SetBool, response: std_srvs/SetBool

    behaviour {
      variable up: boolean
      on response from wish do up := value

      initial marked state down { on request to raise if up goto rising }
      state rising { on response from raise goto raised on error from raise goto down }
      marked state raised { on request to lower if !up goto sinking }
      state sinking { on response from lower goto down on error from lower goto raised }
    }
  }

  provide raise with { data: true }
  provide lower with { data: false }
}
"""
LIFTS = """
scenario "up and down"
  wish with true
  expect raise sent
  response from raise
  wish with false
  expect lower sent
  response from lower
  expect Lift.down
"""


def test_two_services_of_one_server(run_ros2: Runner, tmp_path: Path) -> None:
    model = tmp_path / "lift.rscd"
    model.write_text(LIFT, encoding="utf-8")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, LIFTS, model=model)
    assert (status, "1 passed in" in said) == (0, True), said


def test_a_violated_assumption(run_ros2: Runner, tmp_path: Path) -> None:
    model = tmp_path / "shop.rscd"
    model.write_text(SHOP, encoding="utf-8")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, SCENARIO, model=model)
    assert (status, "3 passed in" in said) == (0, True), said


CARRIER = """\
robot Carrier {
  interface following use FollowWaypoints from nav2_msgs

  component Base {
    service lift with identifier: "/lift", request: none, response: none
    action go with
      identifier: "/go",
      request: none,
      response: Followed,
      feedback: none links following

    behaviour {
      variable why: Failure
      variable missed: integer(0..9)

      initial marked state idle {
        on request to go goto going
        on request to lift goto lifting
      }

      state going {
        on cancel from go goto stopping
        on response from go if value.missed_waypoints[0] = 0 goto arrived
        on response from go goto idle
        on error from go do why := error, missed := value.missed_waypoints[1] goto failed
      }

      state stopping {
        on response from go goto arrived
        on error from go goto failed
        on canceled from go if value.missed_waypoints[0] = 3 goto idle
        on canceled from go goto arrived
      }

      state lifting {
        on response from lift goto idle
        on error from lift do why := error goto failed
      }

      marked state arrived {}

      marked state failed {}
    }
  }

  component Button {
    outgoing message stop with identifier: "/stop", type: none

    behaviour {
      initial marked state released { on response from stop goto pressed }
      marked state pressed {}
    }
  }

  datatype object Followed {
    missed_waypoints: array(integer)
  }

  requirement go needs Button.released and Base.missed < 9
  requirement lift needs Button.pressed and Base.why != rejected
}
"""
FAILS = """\
scenario "aborted with a result"
  error from go because aborted with {"missed_waypoints": [0, 4]}
  expect Base.failed and Base.why = aborted and Base.missed = 4

scenario "aborted"
  error from go
  expect Base.failed and Base.why = aborted and Base.missed = 0

scenario "a result that cannot be read"
  error from go because unreadable
  expect Base.failed and Base.why = unreadable

scenario "a refused cancel, then a call without an answer"
  stop
  refuse cancel of go
  expect Base.stopping
  wait 1500 ms
  canceled from go with {"missed_waypoints": [3]}
  expect lift sent
  error from lift because timeout
  expect Base.failed and Base.why = timeout

scenario "a call that fails"
  stop
  canceled from go with {"missed_waypoints": [3]}
  error from lift
  expect Base.failed and Base.why = failed

scenario "lost"
  error from go because lost
  expect Base.failed and Base.why = lost
"""


def test_reasons_of_errors(run_ros2: Runner, tmp_path: Path) -> None:
    """The command reports, at its line, each reason that no test server can cause: a lost goal, a failed call."""
    model = tmp_path / "carrier.rscd"
    model.write_text(CARRIER, encoding="utf-8")
    types = str(PROJECT / "tests" / "ros" / "interfaces" / "ros2")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, FAILS, "--interface-path", types, model=model)
    number = FAILS.splitlines().index("  error from go because lost") + 1
    fault = "error: this cannot be played over ROS: no test server lets"
    assert status == 1, said
    assert f"own.scenarios:{number}:3: {fault} /go fail because lost" in said
    failed = FAILS.splitlines().index("  error from lift") + 1
    assert f"own.scenarios:{failed}:3: {fault} /lift fail because failed" in said
    assert "2 failed, 4 passed in" in said


def test_a_node_that_does_something_else_is_told_at_the_line(run_ros2: Runner, tmp_path: Path) -> None:
    """The node ignores its stop button."""
    shutil.copytree(LINE_FOLLOWER.parent, tmp_path / "careless")
    model = tmp_path / "careless" / LINE_FOLLOWER.name
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace(" and EmergencyStop.in_service", "").replace(" or EmergencyStop.stopped", ""))
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, STOPS, "--node", shlex.join(run_ros2.command(model)))
    assert (status, "1 failed in" in said) == (1, True), said
    assert (
        "own.scenarios:7:3: error: the node deviates from the scenario: the trace has out message_halt.c_trigger"
        in said
    )


@pytest.mark.parametrize(
    ("command", "told"),
    [
        ("false", "the node ended before the scenario"),
        ("none-such-program", "`none-such-program` does not start: No such file"),
    ],
)
def test_a_node_that_does_not_start(run_ros2: Runner, tmp_path: Path, command: str, told: str) -> None:
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, STOPS, "--node", command)
    assert (status, told in said) == (2, True), said


def test_a_compiled_node_plays_scenarios(ros2_workspace: Workspace, run_ros2: Runner, tmp_path: Path) -> None:
    node = str(ros2_workspace.node("line_follower_controller")[0])
    status, said = played(ros2_workspace, run_ros2.ros.python, tmp_path, STOPS, "--node", node)
    assert (status, "1 passed in" in said) == (0, True), said


ROUTE = """\
robot Route {
  component Mission {
    outgoing message route with identifier: "/route", type: nav_msgs/Path
    outgoing message fix with identifier: "/fix", type: sensor_msgs/NavSatFix
    incoming message go with identifier: "/goal", type: geometry_msgs/PoseStamped
    incoming message lost with identifier: "/lost", type: none

    behaviour {
      variable kept: array(geometry_msgs/PoseStamped)

      initial marked state waiting {
        on response from route do kept := value.poses goto driving
        on response from fix if value.position_covariance[8] = 0.0 and value.status.status < 0 goto blind
      }
      marked state driving { on request to go }
      marked state blind { on request to lost }
    }
  }

  provide go with Mission.kept[0]
}
"""
LEFT_OUT = """\
scenario "a pose without an orientation"
  route with message {"poses": [{"pose": {"position": {"x": 1.0}}}, {}]}
  expect go sent with {"pose": {"position": {"x": 1.0}, "orientation": {"w": 1.0}}}
scenario "a fix without a status"
  fix with message {"latitude": 51.4}
  expect lost sent
"""


def test_data_that_is_left_out(run_ros2: Runner, tmp_path: Path) -> None:
    """A field missing in a scenario has the default of its definition, in the test and in the node."""
    model = tmp_path / "route.rscd"
    model.write_text(ROUTE, encoding="utf-8")
    status, said = played(run_ros2, run_ros2.ros.python, tmp_path, LEFT_OUT, model=model)
    assert status == 0, said
