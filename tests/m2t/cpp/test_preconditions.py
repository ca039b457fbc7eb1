"""Models that cannot become a node, each with the position that must change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner

import robosc
from robosc.base.diagnostics import Severity
from robosc.language import configuration as config
from robosc.m2t.ros.preconditions import preconditions
from robosc.tools.cli import main
from tests.m2t.conftest import ROS1_INTERFACES

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = """\
robot %(robot)s {
  interface odometry use %(type)s from %(package)s
  datatype object Odometry { %(field)s: double }
  %(set)s
  component Base {
    outgoing message where with identifier: "%(topic)s", type: Odometry links odometry
    %(more)s

    behaviour {
      variable x: double
      initial marked state on { on response from where do x := value.%(field)s }
    }
  }
}
"""
GOOD = {
    "robot": "Cart",
    "type": "Odometry",
    "package": "nav_msgs",
    "field": "x",
    "topic": "/base/odometry",
    "more": "",
    "set": "",
}


def found(
    tmp_path: Path, settings: str = '{"onShutdown": []}', least: Severity | None = None, ros: int = 1, **changes: str
) -> list[str]:
    path = tmp_path / "cart.rscd"
    path.write_text(ROBOT % (GOOD | changes), encoding="utf-8")
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    file = tmp_path / "controller-config.json"
    file.write_text(settings, encoding="utf-8")
    graph = robosc.to_rosgraph(robot)
    findings = preconditions(robosc.Models(model, graph, robot), config.read(file), "controller", ros)
    return [
        f"{finding.file.rpartition('/')[2]}:{finding.span.line}: {finding.message}"
        for finding in findings
        if finding.severity is (least or finding.severity)
    ]


def test_nothing_against_a_good_model(tmp_path: Path) -> None:
    assert found(tmp_path) == []


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"package": "NavMsgs"}, 'cart.rscd:2: "NavMsgs" is not a name of a ROS package'),
        ({"package": "nav__msgs"}, 'cart.rscd:2: "nav__msgs" is not a name of a ROS package'),
        ({"type": "odometry"}, 'cart.rscd:2: "odometry" is not a name of a ROS type'),
        ({"topic": "/base/"}, 'cart.rscd:6: "/base/" is not a name of a ROS topic'),
        ({"topic": "/base odometry"}, 'cart.rscd:6: "/base odometry" is not a name of a ROS topic'),
        ({"topic": "/base//odometry"}, 'cart.rscd:6: "/base//odometry" is not a name of a ROS topic'),
        ({"topic": "/base/1"}, 'cart.rscd:6: "/base/1" is not a name of a ROS topic'),
        ({"topic": '/b\\n\\"); exit(1); (\\"'}, 'cart.rscd:6: "/b\n"); exit(1); ("" is not a name of a ROS topic'),
        ({"field": "_x"}, 'cart.rscd:11: "_x" is not a name of a field in ROS'),
        ({"robot": "_Cart"}, 'cart.rscd:1: "_cart_controller" is not a name of a ROS package'),
        (
            {"more": 'service reset with identifier: "re-set", request: none, response: none'},
            'cart.rscd:7: "re-set" is not a name of a ROS service',
        ),
        (
            {"more": 'incoming message tell with identifier: "base/odometry", type: boolean'},
            'cart.rscd:7: "base/odometry" is a topic of nav_msgs/Odometry already, and cannot be one of std_msgs/Bool',
        ),
        ({"set": "parameter period_ms: boolean = true"}, "cart.rscd:4: the node has a parameter period_ms of its own"),
        ({"set": "parameter log_level: boolean = true"}, "cart.rscd:4: the node has a parameter log_level of its own"),
        (
            {"set": "parameter far: integer(0..2147483648) = 1"},
            "cart.rscd:4: far may be set to 0..2147483648, and parameters of ROS 1 have 32 bits",
        ),
    ],
)
def test_names_and_kinds(tmp_path: Path, changes: dict[str, str], expected: str) -> None:
    assert found(tmp_path, **changes) == [expected]


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        (
            '{\n\n "onShutdown": ["where"]}',
            'controller-config.json:3: "onShutdown": where is not a message that the node sends',
        ),
        (
            '{\n "onWithheld": ["where"]}',
            'controller-config.json:2: "onWithheld": where is not a message that the node sends',
        ),
        (
            '{\n "waitFor": ["where"]}',
            'controller-config.json:2: "waitFor": the node does not listen to where',
        ),
        (
            '{"package": {\n "maintainer": "A\\") execute_process(COMMAND id) (\\""}}',
            "controller-config.json:2: the maintainer has characters that break the build of the package",
        ),
    ],
)
def test_settings(tmp_path: Path, settings: str, expected: str) -> None:
    assert found(tmp_path, settings) == [expected]


@pytest.mark.parametrize(
    ("settings", "key"),
    [
        (
            '{\n "supervisor": {\n  "controller": {"run": {"packageName": "p", "executable": "e"}}}}',
            "supervisor.controller",
        ),
        (
            '{\n "supervisor": {\n  "controller": {"launch": {"packageName": "p", "file": "f"}}}}',
            "supervisor.controller",
        ),
        ('{\n\n "onBlocked": ["drive"]}', "onBlocked"),
        ('{\n "output": {\n  "ros2SupervisorNodeLocation": "x"}}', "output.ros2SupervisorNodeLocation"),
    ],
)
def test_settings_without_effect(tmp_path: Path, settings: str, key: str) -> None:
    assert found(tmp_path, settings) == [f'controller-config.json:3: "{key}" has no effect on this target']
    assert found(tmp_path, settings, Severity.ERROR) == []


MORE = """incoming message halt with type: boolean
    incoming message go with type: boolean
  }
  component Eye {
    outgoing message seen with identifier: "eye", type: boolean
    behaviour { initial marked state open { on response from seen goto closed } marked state closed {} }
  }
  requirement Eye.open disables { halt, go }
  provide halt with true
  provide go with true
  component Arm {"""


LIMITED = """robot Cart {
  component Base { incoming message limit with identifier: "/limit", type: nav2_msgs/SpeedLimit }
}
"""


@pytest.mark.parametrize("kind", ["nav2_msgs/SpeedLimit", "example_interfaces/Bool"])
def test_a_package_that_only_the_other_ros_has(tmp_path: Path, kind: str) -> None:
    more, package = f"incoming message limit with type: {kind}", kind.partition("/")[0]
    (line,) = [
        number for number, text in enumerate((ROBOT % (GOOD | {"more": more})).splitlines(), start=1) if more in text
    ]
    said = f"cart.rscd:{line}: ROS 1 has no package {package}, only ROS 2 has it"
    assert found(tmp_path, more=more, least=Severity.ERROR) == [said]
    assert found(tmp_path, more=more, least=Severity.ERROR, ros=2) == []


def test_a_package_of_the_user_counts_for_each_ros(tmp_path: Path) -> None:
    model = tmp_path / "cart.rscd"
    model.write_text(LIMITED, encoding="utf-8")
    options = ["transform", str(model), "--to", "ros1", "-o", str(tmp_path / "out")]
    answer = CliRunner().invoke(main, options)
    assert answer.exit_code == 1
    assert f"{model}:2:76: error: ROS 1 has no package nav2_msgs, only ROS 2 has it [ros-node]" in answer.output
    assert "hint: generate for ROS 2; if nav2_msgs exists for ROS 1, add its folder" in answer.output
    assert not (tmp_path / "out").exists()
    answer = CliRunner().invoke(main, [*options, "--interface-path", str(ROS1_INTERFACES)])
    assert answer.exit_code == 0, answer.output


def test_services_and_actions_are_welcome(tmp_path: Path) -> None:
    assert found(tmp_path, more="service reset with request: none, response: none") == []


def test_what_goes_out_in_spite_of_requirements_is_listed(tmp_path: Path) -> None:
    settings = '{"onShutdown": ["halt",\n "Base.go"]}'
    assert found(tmp_path, settings, Severity.WARNING, more=MORE) == [
        'controller-config.json:1: "onShutdown": halt is then sent regardless of "requirement Eye.open disables halt"',
        'controller-config.json:2: "onShutdown": Base.go is then sent regardless of "requirement Eye.open disables go"',
    ]
    assert found(tmp_path, settings, Severity.ERROR, more=MORE) == []


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("{}", '1: "onShutdown" is not set: when the node ends, the robot continues with its last command'),
        ('{"onShutdown": []}', None),
        (
            '{"onShutdown": [],\n "watchdogStops": true}',
            '2: "watchdogStops" only holds commands back: "onShutdown" names no message that stops the robot',
        ),
    ],
)
def test_where_nothing_stops_the_robot(tmp_path: Path, settings: str, expected: str | None) -> None:
    warnings = [f"controller-config.json:{expected}"] if expected else []
    assert found(tmp_path, settings, Severity.WARNING, more=MORE) == warnings
    assert found(tmp_path, settings, Severity.WARNING) == [], "it sends no messages"


REPORTS = '"onViolation": after the first violation of an assumption, nothing about the robot is proved'
VIOLATED = 'a violation of an assumption only holds commands back: "onShutdown" names no message that stops the robot'


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("{}", ['"onShutdown" is not set: when the node ends, the robot continues with its last command', VIOLATED]),
        ('{"onShutdown": []}', [VIOLATED]),
        ('{"onShutdown": ["go"]}', ['"onShutdown": go is then sent regardless of "requirement Eye.open disables go"']),
        ('{"onShutdown": [], "onViolation": "report"}', [REPORTS]),
    ],
)
def test_where_nothing_stops_the_robot_after_a_violation(tmp_path: Path, settings: str, expected: list[str]) -> None:
    more = MORE.replace("requirement Eye", "assume seen needs Eye.open requirement Eye", 1)
    assert more != MORE
    expected = [f"controller-config.json:1: {message}" for message in expected]
    assert found(tmp_path, settings, Severity.WARNING, more=more) == expected


DOUBLES = """incoming message drive with type: double
  }
  component Eye {
    outgoing message seen with identifier: "eye", type: double
    behaviour {
      variable last: double
      variable before: double
      variable count: integer(0..9)
      initial marked state open { on response from seen do before := last, last := value, count := count + 1 }
    }
  }
  provide drive with %s
  component Arm {"""


@pytest.mark.parametrize(
    ("provided", "outside"),
    [("0.5", False), ("Eye.before * 2", True), ("1 / Eye.count", True), ("Eye.count / 2", False), ("-Eye.last", True)],
)
def test_what_may_be_no_number_has_something_in_its_place(tmp_path: Path, provided: str, outside: bool) -> None:
    said = (
        "cart.rscd:18: drive is not sent if its data is not a finite number, and no other"
        " message is: the robot continues with its last command"
    )
    more = DOUBLES % provided
    assert found(tmp_path, '{"onShutdown": []}', Severity.WARNING, more=more) == ([said] if outside else [])
    for decided in ("[]", '["drive"]'):
        settings = f'{{"onShutdown": [], "onWithheld": {decided}}}'
        unsteady = (
            'controller-config.json:1: "onWithheld": the data of drive depend on the state of the robot, and may not'
            " stop it"
        )
        is_unsteady = decided != "[]" and provided != "0.5"
        assert found(tmp_path, settings, Severity.WARNING, more=more) == ([unsteady] if is_unsteady else [])


KEPT = """incoming message drive with identifier: "drive", type: %s
  }
  component Eye {
    outgoing message seen with identifier: "eye", type: sensor_msgs/JointState
    behaviour {
      variable last: sensor_msgs/JointState
      variable speeds: array(double)
      variable names: array(string)
      initial marked state open {
        on response from seen do last := value, speeds := value.velocity[0..1], names := value.name
      }
    }
  }
  provide drive with %s
  component Arm {"""


@pytest.mark.parametrize(
    ("kind", "provided", "what"),
    [
        ("sensor_msgs/JointState", "Eye.last", "data has a value that is not a"),
        ("sensor_msgs/JointState", "{ position: Eye.speeds }", "position has a value that is not a"),
        ("sensor_msgs/JointState", "{ position: [0.0, Eye.speeds[1]] }", "position has a value that is not a"),
        ("sensor_msgs/JointState", "{ name: Eye.names, position: [0.0, 1.0] }", None),
        ("sensor_msgs/JointState", "{ header: Eye.last.header }", None),
        ("geometry_msgs/Vector3", "{ x: min(Eye.speeds) }", "x is not a"),
    ],
)
def test_what_is_handed_on_may_hold_what_is_not_finite(
    tmp_path: Path, kind: str, provided: str, what: str | None
) -> None:
    more = KEPT % (kind, provided)
    warnings = found(tmp_path, '{"onShutdown": []}', Severity.WARNING, more=more)
    end = " finite number, and no other message is: the robot continues with its last command"
    assert warnings == ([f"cart.rscd:20: drive is not sent if its {what}{end}"] if what else [])
    assert found(tmp_path, '{"onShutdown": [], "onWithheld": []}', Severity.WARNING, more=more) == []


def test_only_topics_that_the_node_hears_have_a_watchdog(tmp_path: Path) -> None:
    settings = '{"onShutdown": [], "watchdogMs": {"eye": 5,\n "halt": 5}}'
    assert found(tmp_path, settings, more=MORE) == [
        'controller-config.json:2: "watchdogMs": the node does not listen to halt'
    ]


def test_a_name_in_the_configuration_repairs_the_robot_s(tmp_path: Path) -> None:
    assert found(tmp_path, '{"package": {"name": "wheels"}}', robot="_Cart") == []
