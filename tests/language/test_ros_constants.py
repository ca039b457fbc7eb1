"""Constants of ROS types: `BatteryState.POWER_SUPPLY_STATUS_FULL` is the value of the definition."""

from __future__ import annotations

from pathlib import Path

import pytest

from robosc.base.ros_types import RosTypes
from robosc.language.reading import Reading, read
from robosc.language.text import Documents
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.printing import RoboscPrinter

ROBOT = """robot Cart {{
  {definitions}
  component Battery {{
    outgoing message battery with type: sensor_msgs/BatteryState
    outgoing message moded with type: {type}
    incoming message go with type: none
    behaviour {{
      variable full: boolean
      variable x: integer(-200..200)
      initial marked state idle {{ on response from battery do full := value.power_supply_status = {constant} }}
    }}
  }}
  requirement go needs Battery.full
}}
"""
FULL = "BatteryState.POWER_SUPPLY_STATUS_FULL"


def robot(constant: str = FULL, definitions: str = "", type_: str = "none") -> str:
    return ROBOT.format(constant=constant, definitions=definitions, type=type_)


def reading(content: str, interfaces: RosTypes | None = None) -> Reading:
    return read(Path("cart.rscd"), [], interfaces or RosTypes(), Documents({"cart.rscd": content}))


def faults(content: str, interfaces: RosTypes | None = None) -> list[tuple[str, str]]:
    return [(finding.rule, finding.message) for finding in reading(content, interfaces).findings]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return the folder of a package with a message, a service and an action that have constants."""
    folder = tmp_path / "cart_msgs"
    for path, text in {
        "msg/Mode.msg": "int8 BACK=-3\nfloat32 HALF=0.5\nstring NAME=cart\nbool ON=true\nint8 mode\n",
        "msg/Ask.msg": "int8 FIRST=5\nint8 asked\n",
        "srv/Ask.srv": "int8 FIRST=1\nint8 asked\n---\nint8 answer\n",
        "srv/Find.srv": "int8 FIRST=1\nint8 asked\n---\nint8 SECOND=2\nint8 answer\n",
        "msg/BatteryState.msg": "uint8 POWER_SUPPLY_STATUS_FULL=9\nuint8 OWN=7\nuint8 status\n",
    }.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    (folder / "package.xml").write_text("<package><name>cart_msgs</name></package>")
    return tmp_path


def test_a_constant_is_its_value() -> None:
    found = reading(robot())
    assert found.findings == []
    (assignment,) = [part for _, part in tree(found.base) if isinstance(part, rsc.Assignment)]
    assert RoboscPrinter()(assignment.value) == "value.power_supply_status = 4"


@pytest.mark.parametrize(
    ("constant", "text"),
    [("Mode.BACK", "-3"), ("Mode.HALF", "0.5"), ("Mode.NAME", '"cart"'), ("Mode.ON", "true")],
)
def test_constants_of_each_type(package: Path, constant: str, text: str) -> None:
    content = robot(definitions="condition named = " + f"{constant} = {constant}", type_="cart_msgs/Mode")
    found = reading(content, RosTypes([package]))
    assert found.findings == []
    assert RoboscPrinter()(found.base.definitions[0].value) == f"{text} = {text}"


def test_constants_of_all_sections_of_an_interface(package: Path) -> None:
    content = robot(definitions="interface ask use Find from cart_msgs condition c = Find.FIRST < Find.SECOND")
    found = reading(content, RosTypes([package]))
    assert found.findings == []
    assert RoboscPrinter()(found.base.definitions[1].value) == "1 < 2"
    content = robot(definitions="interface ask use Ask from cart_msgs condition c = Ask.FIRST < 2")
    assert faults(content, RosTypes([package])) == [
        ("unresolved-reference", "`FIRST` is a constant of `cart_msgs/msg/Ask` or `cart_msgs/srv/Ask`")
    ]


def test_an_unknown_constant_is_reported() -> None:
    assert faults(robot("BatteryState.POWER_SUPPLY_STATUS_FUL")) == [
        ("unresolved-reference", "the ROS type `BatteryState` has no constant `POWER_SUPPLY_STATUS_FUL`")
    ]


def test_a_type_that_the_text_does_not_use_has_no_constants() -> None:
    assert faults(robot("JoyFeedback.TYPE_LED")) != []


def test_a_constant_of_two_types_is_ambiguous(package: Path) -> None:
    content = robot(type_="cart_msgs/BatteryState")
    types = "`cart_msgs/msg/BatteryState`", "`sensor_msgs/msg/BatteryState`"
    assert faults(content, RosTypes([package])) == [
        (
            "unresolved-reference",
            f"`POWER_SUPPLY_STATUS_FULL` is a constant of {' or '.join(types)}",
        )
    ]
    assert faults(robot("BatteryState.OWN", type_="cart_msgs/BatteryState"), RosTypes([package])) == []


def test_a_constant_that_differs_between_ros_versions(tmp_path: Path) -> None:
    for ros, value, built in (("one", 1, "catkin"), ("two", 2, "ament_cmake")):
        folder = tmp_path / ros / "cart_msgs"
        (folder / "msg").mkdir(parents=True)
        (folder / "msg" / "Mode.msg").write_text(f"int8 FAST={value}\nint8 mode\n")
        (folder / "package.xml").write_text(
            f"<package><name>cart_msgs</name><buildtool_depend>{built}</buildtool_depend></package>"
        )
    content = robot("Mode.FAST", type_="cart_msgs/Mode")
    assert faults(content, RosTypes([tmp_path])) == [
        ("interface-type", "`FAST` has other values in ROS 1 and in ROS 2")
    ]


@pytest.mark.parametrize(
    "definitions",
    [
        "datatype enum BatteryState from integer to { value > 3 -> POWER_SUPPLY_STATUS_FULL default -> other }",
        "component BatteryState { behaviour { initial marked state POWER_SUPPLY_STATUS_FULL { } } }",
        "requirement BatteryState: automaton { initial marked state POWER_SUPPLY_STATUS_FULL { on go } }",
    ],
)
def test_a_name_of_the_text_takes_precedence(definitions: str) -> None:
    found = reading(robot(definitions=definitions))
    assert found.findings == []
    items = [part.item for _, part in tree(found.base) if isinstance(part, rsc.Access)]
    assert "POWER_SUPPLY_STATUS_FULL" in [item.name for item in items if item is not None]


def test_an_object_of_the_text_does_not() -> None:
    content = robot(definitions="datatype object BatteryState { power_supply_status: integer }")
    assert faults(content) == []
