"""Omitted data has the defaults of ROS; passed-on data is compared."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.tools.cli import main

SRV = 'bool use_dock true\n---\nbool ready true\nint32 code 7\nfloat64[3] k\nint32[] codes [4, 5]\nstring side "left"\n'
ACTION = "float64 speed 0.5\n---\nbool ok true\n---\nfloat32 left 0.5\n"
MODEL = """\
robot Porter {
  component Dock {
    service ask with identifier: "/ask", request: porter_msgs/Ask, response: porter_msgs/Ask

    behaviour {
      initial marked state idle { on request to ask goto asked }
      marked state asked {
        on response from ask
          if value.ready and value.code = 7 and value.side = "left"
            and value.k[2] = 0.0 and value.codes[1] = 5 and size(value.codes) = 2
          goto ready
        on response from ask goto idle
      }
      marked state ready {}
    }
  }

  component Base {
    action go with
      identifier: "/go", request: porter_msgs/Go, response: porter_msgs/Go, feedback: porter_msgs/Go

    behaviour {
      initial marked state idle { on request to go goto going }
      marked state going {
        on feedback from go if value.left = 0.5 goto half
        on response from go goto idle
      }
      marked state half { on response from go if value.ok goto done }
      marked state done {}
    }
  }
}
"""
POSES = """\
robot Route {
  component Mission {
    outgoing message route with identifier: "/route", type: nav_msgs/Path
    outgoing message fix with identifier: "/fix", type: sensor_msgs/NavSatFix
    incoming message go with identifier: "/goal", type: geometry_msgs/PoseStamped

    behaviour {
      variable kept: array(geometry_msgs/PoseStamped)

      initial marked state waiting {
        on response from route if value.poses[0].pose.orientation.w = 1.0 do kept := value.poses goto upright
        on response from route do kept := value.poses goto tilted
      }
      marked state upright {
        on request to go
        on response from fix if value.status.status = -2 goto lost
      }
      marked state tilted { on request to go }
      marked state lost {}
    }
  }

  provide go with Mission.kept[0]
}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in {"srv/Ask.srv": SRV, "action/Go.action": ACTION}.items():
        path = Path("interfaces", "porter_msgs", name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    Path("porter.rscd").write_text(MODEL)
    Path("route.rscd").write_text(POSES)


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, [*arguments, "--interface-path", "interfaces"], catch_exceptions=False)


def played(model: str, steps: str, *options: str) -> Result:
    Path("own.scenarios").write_text(f'scenario "one"\n{steps}')
    return run("test", model, "own.scenarios", *options)


def test_services_and_actions() -> None:
    steps = """\
  response from ask with message {}
  expect Dock.ready
  feedback from go with message {}
  expect Base.half
  response from go with message {}
  expect Base.done
"""
    answer = played("porter.rscd", steps)
    assert answer.exit_code == 0, answer.output


def test_a_quaternion() -> None:
    """ROS 2 has a default for `w`; an element without fields gets it."""
    answer = played("route.rscd", '  route with message {"poses": [{}]}\n  expect Mission.upright\n')
    assert answer.exit_code == 0, answer.output


def test_a_trace_names_the_defaults_that_only_one_ros_has() -> None:
    steps = '  route with message {"poses": [{}, {"pose": {"position": {"x": 2.0}}}]}\n  expect go sent\n'
    assert played("route.rscd", steps, "--traces", "traces").exit_code == 0
    lines = map(json.loads, Path("traces/scenario_1.jsonl").read_text().splitlines())
    [incoming] = [line for line in lines if line["direction"] == "in"]
    upright = {"orientation": {"w": 1}}
    assert incoming["message"] == {"poses": {"0": {"pose": upright}, "1": {"pose": {"position": {"x": 2}, **upright}}}}
    assert incoming["data"]["value"]["poses"][1]["pose"]["orientation"]["w"] == 1


@pytest.mark.parametrize(
    ("expected", "fault"),
    [
        ('{"pose": {"position": {"x": 2.0}}}', ""),
        ('{"pose": {"orientation": {"w": 1.0}}}', ""),
        ('{"pose": {"position": {"x": 3.0}}}', "was sent with other data"),
        ('{"pose": {"positon": {"x": 2.0}}}', "geometry_msgs/Pose has no field `positon`"),
        ('{"header": {"stamp": {"sec": 1}}}', "`header.stamp` of the request to `Mission.go` cannot be compared"),
    ],
)
def test_what_is_handed_on_is_compared(expected: str, fault: str) -> None:
    steps = f"""\
  route with message {{"poses": [{{"pose": {{"position": {{"x": 2.0}}}}}}]}}
  expect go sent with {expected}
"""
    answer = played("route.rscd", steps)
    assert fault in answer.output
    assert answer.exit_code == bool(fault), answer.output
    if "other data" in fault:
        assert '"position":{"x":2,"y":0,"z":0}' in answer.output


SENDER = """\
robot Sender {
  component Mission {
    outgoing message name with identifier: "/name", type: string
    incoming message goal with identifier: "/goal", type: geometry_msgs/PoseStamped
    incoming message echo with identifier: "/echo", type: string
    incoming message speed with identifier: "/speed", type: double
    incoming message beep with identifier: "/beep", type: std_msgs/Bool
    service power with identifier: "/power", request: std_srvs/SetBool, response: std_srvs/SetBool

    behaviour {
      variable text: string

      initial marked state waiting { on response from name do text := value goto driving }
      marked state driving {
        on request to goal
        on request to echo
        on request to speed
        on request to beep
        on request to power goto switching
      }
      state switching {
        on response from power goto driving
        on error from power goto driving
      }
    }
  }

  provide goal with { pose: { position: { x: 2.0 } } }
  provide echo with Mission.text
  provide speed with 0.5
  provide power with { data: true }
}
"""


@pytest.mark.parametrize(
    ("expected", "sent"),
    [
        ('goal sent with {"pose": {"position": {"x": 2.0, "y": 0.0}, "orientation": {"w": 1.0}}}', ""),
        ('goal sent with {"pose": {"orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}}', ""),
        (
            'goal sent with {"pose": {"orientation": {"w": 0.0}}}',
            '{"pose":{"position":{"x":2},"orientation":{"w":1}}}',
        ),
        ('goal sent with {"header": {"frame_id": ""}}', '{"pose":{"position":{"x":2}}}'),  # the node sets it
        ('echo sent with "hello"', ""),
        ('echo sent with {"data": "hello"}', ""),
        ('echo sent with {"data": "hell"}', '{"data":"hello"}'),
        ("speed sent with 0.5", ""),
        ('speed sent with {"data": 0.5}', ""),
        ("beep sent with false", ""),
        ('beep sent with {"data": false}', ""),
        ("beep sent with true", '{"data":false}'),
        ("power sent with true", ""),
        ('power sent with {"data": true}', ""),
        ("power sent with false", "true"),
        ("goal sent with 2.0", '{"pose":{"position":{"x":2}}}'),
    ],
)
def test_sent_data_has_the_defaults_of_ros_and_a_single_value_is_an_object_with_one_field(
    expected: str, sent: str
) -> None:
    Path("sender.rscd").write_text(SENDER)
    answer = played("sender.rscd", f'  name with {{"data": "hello"}}\n  expect {expected} within 500 ms\n')
    assert answer.exit_code == bool(sent), answer.output
    assert f"the sent data is {sent}" in answer.output or not sent


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ('speed sent with {"dat": 0.5}', "has no field `dat`"),
        ('goal sent with {"pose": {"orientaton": {"w": 1.0}}}', "geometry_msgs/Pose has no field `orientaton`"),
        ('power sent with {"success": true}', "std_srvs/SetBool has no field `success`"),
    ],
)
def test_an_expected_field_that_the_type_does_not_have_is_reported_before_the_first_scenario(
    data: str, message: str
) -> None:
    Path("sender.rscd").write_text(SENDER)
    answer = played("sender.rscd", f"  expect speed sent\n  expect {data}\n")
    assert answer.exit_code == 1
    assert "own.scenarios:3:3: error: " in answer.output
    assert message in answer.output
    assert "failed in" not in answer.output


@pytest.mark.parametrize("loop", [[], ["--loop"]])
def test_simulate(loop: list[str]) -> None:
    def state_after(model: str, *lines: str) -> dict[str, str]:
        Path("script").write_text("\n".join(lines))
        answer = run("simulate", model, "--script", "script", *loop)
        assert answer.exit_code == 0, answer.output
        state: dict[str, str] = json.loads(answer.stdout.splitlines()[-1])["state"]
        return state

    start = ["tick"] if loop else ["service_ask.c_trigger", "action_go.c_trigger"]
    porter = [*start, "service_ask.u_response {}", 'action_go.u_feedback {"value": {}}', "action_go.u_response"]
    state = state_after("porter.rscd", *porter)
    assert (state["component_Dock"], state["component_Base"]) == ("ready", "done")
    upright = 'message_route.u_response {"value": {"poses": [{}]}}'
    assert state_after("route.rscd", upright)["component_Mission"] == "upright"
    fix = 'message_fix.u_response {"value": {"latitude": 1.0}}'
    assert state_after("route.rscd", upright, fix)["component_Mission"] == "lost"
