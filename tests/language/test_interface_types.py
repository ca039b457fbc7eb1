"""ROS types in place of objects: `type: geometry_msgs/Twist`."""

from pathlib import Path

import pytest

from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.model import robosc as rsc
from robosc.model.reflection import tree

ROBOT = """
robot Carrier {
  datatype enum Ahead from sensor_msgs/LaserScan to {
    value.ranges[0] > 0.5 and value.header.frame_id = "base" -> free
    default -> near
  }
  component Base {
    incoming message go with type: geometry_msgs/Twist
    outgoing message scan with type: Ahead
    outgoing message level with type: std_msgs/Int8
    outgoing message at with type: nav_msgs/Odometry
    service brake with request: std_srvs/SetBool, response: std_srvs/SetBool
    action lift with request: arm_msgs/Lift, response: arm_msgs/Lift, feedback: arm_msgs/Lift
    behaviour {
      variable ahead: Ahead
      variable x: double
      variable level: integer(-5..5)
      variable done: boolean
      on response from scan do ahead := value
      on response from at do x := value.pose.pose.position.x + value.pose.covariance[0]
      on response from level do level := value.data
      on response from brake do done := value.success
      on feedback from lift do x := value.height
      on response from lift do done := value.reached
      initial marked state idle { }
    }
  }
  requirement go needs Base.ahead = free and Base.level > 3 and Base.done
  requirement { brake, lift } needs Base.done
  provide go with { linear: { x: Base.x, y: 0.0 } }
  provide brake with { data: true }
  provide lift with { goal: 1.5 }
}
"""


@pytest.fixture
def interfaces(tmp_path: Path) -> RosTypes:
    actions = tmp_path / "arm_msgs" / "action"
    actions.mkdir(parents=True)
    (actions / "Lift.action").write_text("float64 goal\n---\nbool reached\nwstring why\n---\nfloat64 height\n")
    (tmp_path / "arm_msgs" / "msg").mkdir()
    (tmp_path / "arm_msgs" / "msg" / "Pair.msg").write_text("lost_msgs/Thing thing\nwstring text\nint8 small\n")
    return RosTypes([tmp_path])


def findings(folder: Path, interfaces: RosTypes, *texts: str) -> list[tuple[str, str, str | None]]:
    """Return the rules, messages and hints for the first of several files in one folder."""
    for number, text in enumerate(texts):
        (folder / f"model{number}.rscd").write_text(text)
    reading = read(folder / "model0.rscd", ros_types=interfaces)
    found = [*reading.findings, *check(reading.base, reading.findings, interfaces)]
    return [(finding.rule, finding.message, finding.hint) for finding in found]


def with_message(declared: str, rest: str = "") -> str:
    return f"robot R {{ component C {{ incoming message m with type: {declared} }} {rest} }}"


def test_nothing_is_wrong(tmp_path: Path, interfaces: RosTypes) -> None:
    assert findings(tmp_path, interfaces, ROBOT) == []


def test_the_object_has_what_is_used(tmp_path: Path, interfaces: RosTypes) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT)
    base = read(path, ros_types=interfaces).base
    assert isinstance(base, rsc.Robot)
    made = [
        (element.rosType, [every.name for every in element.definition.properties])
        for _, element in tree(base)
        if isinstance(element, rsc.InterfaceTypeReference)
    ]
    assert made == [
        ("LaserScan", ["ranges", "header"]),
        ("Header", ["frame_id"]),
        ("Twist", ["linear"]),
        ("Vector3", ["x", "y"]),
        ("Int8", ["data"]),
        ("Odometry", ["pose"]),
        ("PoseWithCovariance", ["pose", "covariance"]),
        ("Pose", ["position"]),
        ("Point", ["x"]),
        ("SetBool", ["data"]),
        ("SetBool", ["success"]),
        ("Lift", ["goal"]),
        ("Lift", ["reached"]),
        ("Lift", ["height"]),
    ]
    (small,) = [
        element for _, element in tree(base) if isinstance(element, rsc.IntegerDataType) and element.minimum == -128
    ]
    assert small.maximum == 127


def test_communication_has_the_interface_of_its_data(tmp_path: Path, interfaces: RosTypes) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT)
    base = read(path, ros_types=interfaces).base
    assert isinstance(base, rsc.Robot)
    _, trace = robosc_to_sct.transform(base)
    graph = robosc_to_rosgraph.transform(trace, interfaces)
    assert [(interface.package, interface.type, interface.kind.name) for interface in graph.interfaces] == [
        ("geometry_msgs", "Twist", "message"),
        ("sensor_msgs", "LaserScan", "message"),
        ("std_msgs", "Int8", "message"),
        ("nav_msgs", "Odometry", "message"),
        ("std_srvs", "SetBool", "service"),
        ("arm_msgs", "Lift", "action"),
    ]
    (go,) = graph.publishers[0].sendings
    assert [list(field.path) for field in go.alternatives[0].fields] == [["linear", "x"], ["linear", "y"]]


def test_objects_may_contain_ros_types(tmp_path: Path, interfaces: RosTypes) -> None:
    text = """
        robot R {
          interface stamped use PoseStamped from geometry_msgs
          datatype object Target { pose: geometry_msgs/Pose }
          component C { incoming message m with type: Target links stamped }
          provide m with { pose: { position: { x: 1.0 } } }
        }
    """
    assert findings(tmp_path, interfaces, text) == []
    wrong = text.replace("geometry_msgs/Pose ", "geometry_msgs/Point ").replace("position: { x: 1.0 }", "x: 1.0")
    assert findings(tmp_path, interfaces, wrong) == [
        (
            "interface-type",
            "`pose` is object Point here, and geometry_msgs/Pose in geometry_msgs/PoseStamped",
            "write `pose: geometry_msgs/Pose`",
        )
    ]


def test_library_with_ros_types(tmp_path: Path, interfaces: RosTypes) -> None:
    robot = """
        robot R {
          component Base from BaseLibrary import Base
          component Other { outgoing message seen with type: Ahead }
          provide go with { linear: { x: 1.0 }, angluar: { z: 1.0 } }
        }
    """
    library = """
        library BaseLibrary {
          datatype enum Ahead from sensor_msgs/LaserScan to { value.ranges[0] > 0.5 -> free default -> near }
          component Base { incoming message go with type: geometry_msgs/Twist }
        }
    """
    assert findings(tmp_path, interfaces, robot, library) == [
        (
            "unresolved-reference",
            "the ROS type `Twist` has no field that a model can use named `angluar`",
            "did you mean `angular`?",
        )
    ]


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ("lost_msgs/Thing", "the package `lost_msgs` is unknown"),
        ("geometry_msgs/Twits", "no message type `Twits` of the package `geometry_msgs` is known"),
        ("std_srvs/SetBool", "std_srvs/SetBool is of kind service, expected a type of kind message"),
    ],
)
def test_unknown_type_draws_nothing_further(tmp_path: Path, interfaces: RosTypes, declared: str, message: str) -> None:
    text = with_message(declared, "provide m with { linear: { x: 1.0 } }")
    assert [finding[:2] for finding in findings(tmp_path, interfaces, text)] == [("unresolved-reference", message)]


@pytest.mark.parametrize("name", ["thing", "text", "nothing"])
def test_fields_that_no_model_can_use(tmp_path: Path, interfaces: RosTypes, name: str) -> None:
    text = with_message("arm_msgs/Pair", f"provide m with {{ {name}: 1 }}")
    message = f"the ROS type `Pair` has no field that a model can use named `{name}`"
    assert [finding[:2] for finding in findings(tmp_path, interfaces, text)] == [("unresolved-reference", message)]


def test_types_of_fields_count(tmp_path: Path, interfaces: RosTypes) -> None:
    text = with_message("arm_msgs/Pair", "provide m with { small: 0.5 } provide m with { small: 300 }")
    assert [finding[0] for finding in findings(tmp_path, interfaces, text)] == ["type", "integer-range"]


@pytest.mark.parametrize(
    "parts",
    [
        "message m with type: geometry_msgs/Pose links twist",
        "service m with request: std_srvs/Trigger, response: std_srvs/SetBool",
    ],
)
def test_one_communication_has_one_type(tmp_path: Path, interfaces: RosTypes, parts: str) -> None:
    direction = "" if parts.startswith("service") else "incoming "
    text = f"robot R {{ interface twist use Twist from geometry_msgs component C {{ {direction}{parts} }} }}"
    assert [finding[0] for finding in findings(tmp_path, interfaces, text)] == ["interface-type"]


def test_needed_integers_without_range(tmp_path: Path, interfaces: RosTypes) -> None:
    text = """
        robot R {
          component C {
            outgoing message count with type: std_msgs/Int32
            incoming message go with type: none
            behaviour {
              variable n: integer
              on response from count do n := value.data
              initial marked state idle { }
            }
          }
          requirement go needs C.n > 3
        }
    """
    ((rule, _, hint), _) = findings(tmp_path, interfaces, text)
    assert rule == "integer-range"
    assert hint == "ROS defines it: declare an object in its place, with a `data: integer(0..100)`"


def test_type_that_only_ros_2_has(tmp_path: Path) -> None:
    text = """
        robot R {
          component C {
            outgoing message scan with type: sensor_msgs/LaserScan
            action grip with request: none, response: control_msgs/ParallelGripperCommand, feedback: none
            behaviour {
              variable number: integer
              variable reached: boolean
              on response from scan do number := value.header.seq
              on response from grip do reached := value.reached_goal
              initial marked state idle { }
            }
          }
        }
    """
    ((rule, message, hint),) = findings(tmp_path, RosTypes(), text)
    assert rule == "interface-mix"
    assert "`grip` fits ROS 2 only" in message
    assert hint is not None
    assert hint.endswith("in ROS 1, there is no control_msgs/ParallelGripperCommand")
    assert findings(tmp_path, RosTypes(), text.replace("header.seq", "header.stamp.nanosec")) == []
