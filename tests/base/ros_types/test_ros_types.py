"""Places in which ROS type definitions are searched, and the fields read from them."""

import subprocess
import sys
from pathlib import Path

import pytest

from robosc.base import ros_types
from robosc.base.files.resources import locate
from robosc.base.ros_types import DefinitionError, RosTypes, Section, folders
from robosc.base.ros_types.wire import NestedType, Sequence

HERE = Path(__file__).parent
MINIMAL = HERE.parents[1] / "ros" / "interfaces"
SHIPPED = locate("base/ros_types/definitions")


@pytest.fixture(autouse=True)
def no_installation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ros_types, "_INSTALLATIONS", Path("/nowhere"))
    for variable in ("ROBOSC_INTERFACE_PATH", "AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)


def write(folder: Path, **texts: str) -> Path:
    """Write files by their paths: `__` stands for a slash, the last `__` for a dot."""
    for name, text in texts.items():
        *parents, stem, ending = name.split("__")
        path = folder.joinpath(*parents, f"{stem}.{ending}")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    return folder


def shown(
    interfaces: RosTypes, package: str, name: str, part: Section = Section.MESSAGE
) -> list[dict[str, str] | None]:
    """Return the fields in ROS 2 and in ROS 1."""
    found = [known.fields(package, name, part) for known in interfaces.distributions]
    return [None if fields is None else {key: str(value) for key, value in fields.items()} for fields in found]


def test_standard_types() -> None:
    twist = {"linear": "geometry_msgs/Vector3", "angular": "geometry_msgs/Vector3"}
    assert shown(RosTypes(), "geometry_msgs", "Twist") == [twist, twist]
    assert shown(RosTypes(), "std_msgs", "Empty") == [{}, {}]
    assert shown(RosTypes(), "std_msgs", "Nothing") == [None, None]
    assert shown(RosTypes(), "sensor_msgs", "Joy")[0] == {
        "header": "std_msgs/Header",
        "axes": "float32[]",
        "buttons": "int32[]",
    }


def test_what_the_two_ros_define_differently() -> None:
    ros2, ros1 = shown(RosTypes(), "std_msgs", "Header")
    assert ros1 is not None
    assert ros2 is not None
    assert ros1.keys() - ros2.keys() == {"seq"}
    ros2, ros1 = shown(RosTypes(), "builtin_interfaces", "Time")
    assert (ros2, ros1) == ({"sec": "int32", "nanosec": "uint32"}, {"sec": "uint32", "nsec": "uint32"})


@pytest.mark.parametrize(
    ("name", "request_fields", "response_fields"),
    [
        ("Empty", {}, {}),
        ("SetBool", {"data": "bool"}, {"success": "bool", "message": "string"}),
        ("Trigger", {}, {"success": "bool", "message": "string"}),
    ],
)
def test_standard_services(name: str, request_fields: dict[str, str], response_fields: dict[str, str]) -> None:
    assert shown(RosTypes(), "std_srvs", name, Section.REQUEST) == [request_fields] * 2
    assert shown(RosTypes(), "std_srvs", name, Section.RESPONSE) == [response_fields] * 2
    assert shown(RosTypes(), "std_srvs", name) == [None, None]


@pytest.mark.parametrize(
    ("package", "name", "section", "expected"),
    [
        ("nav2_msgs", "Wait", Section.GOAL, [{"time": "builtin_interfaces/Duration"}, None]),
        ("nav2_msgs", "GetCosts", Section.RESPONSE, [{"costs": "float32[]", "success": "bool"}, None]),
        ("example_interfaces", "Fibonacci", Section.FEEDBACK, [{"sequence": "int32[]"}, None]),
        ("example_interfaces", "Empty", Section.MESSAGE, [{}, None]),
        ("control_msgs", "GripperCommand", Section.GOAL, [{"command": "control_msgs/GripperCommand"}] * 2),
        ("control_msgs", "GripperCommand", Section.MESSAGE, [{"position": "float64", "max_effort": "float64"}] * 2),
        ("control_msgs", "PointHead", Section.FEEDBACK, [{"pointing_angle_error": "float64"}] * 2),
        ("control_msgs", "ParallelGripperCommand", Section.GOAL, [{"command": "sensor_msgs/JointState"}, None]),
    ],
)
def test_shipped_definitions(package: str, name: str, section: Section, expected: list[dict[str, str] | None]) -> None:
    assert shown(RosTypes(), package, name, section) == expected


def test_a_shipped_type_may_have_more_fields_in_ros_2() -> None:
    ros2, ros1 = shown(RosTypes(), "control_msgs", "FollowJointTrajectory", Section.GOAL)
    assert ros1 is not None
    assert ros2 is not None
    assert ros2.keys() - ros1.keys() == {
        "multi_dof_trajectory",
        "component_path_tolerance",
        "component_goal_tolerance",
    }
    assert ros1.keys() < ros2.keys()


def test_shipped_definitions_name_known_types() -> None:
    unknown = set()
    for distribution in RosTypes().distributions:
        for package in ("control_msgs", "example_interfaces", "nav2_msgs", "std_srvs"):
            for section in Section:
                for name in distribution.names(package, section.kind):
                    wires = list((distribution.fields(package, name, section) or {}).values())
                    inner = [wire.element if isinstance(wire, Sequence) else wire for wire in wires]
                    unknown |= {
                        str(wire)
                        for wire in inner
                        if isinstance(wire, NestedType)
                        and not distribution.defines(wire.package, wire.name, Section.MESSAGE)
                    }
    assert unknown == {"geographic_msgs/GeoPose"}


def test_a_shipped_type_is_in_one_place_for_each_ros() -> None:
    places = {
        folder: {str(path.relative_to(SHIPPED / folder)) for path in (SHIPPED / folder).rglob("*.*")}
        for folder in ("both", "ros1", "ros2")
    }
    assert not places["both"] & (places["ros1"] | places["ros2"])
    for path in SHIPPED.rglob("*.*"):
        assert "#" not in path.read_text()


def test_own_packages_come_before_shipped_definitions(tmp_path: Path) -> None:
    interfaces = RosTypes([write(tmp_path, nav2_msgs__action__Wait__action="int8 own\n---\n---\n")])
    assert shown(interfaces, "nav2_msgs", "Wait", Section.GOAL) == [{"own": "int8"}] * 2
    assert shown(interfaces, "nav2_msgs", "Spin", Section.GOAL)[0] is not None


def test_an_installed_package_needs_no_shipped_definitions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "share", nav2_msgs__action__Wait__action="int8 own\n---\n---\n")
    write(tmp_path / "share", control_msgs__package__xml="")  # without definitions
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    interfaces = RosTypes()
    assert shown(interfaces, "nav2_msgs", "Wait", Section.GOAL) == [{"own": "int8"}, None]
    assert shown(interfaces, "nav2_msgs", "Spin", Section.GOAL) == [None, None]
    assert interfaces.distribution(2).names("nav2_msgs", "action") == ["Wait"]
    assert shown(interfaces, "control_msgs", "PointHead", Section.GOAL)[0] is not None


def test_definition_of_an_action(tmp_path: Path) -> None:
    text = "# ---\nLevel level  # of what\nint8 UP = 1\r\n--- \n\n---\nfloat32[<=4] done\nstring<=9 text 'a'\ntime t\n"
    interfaces = RosTypes([write(tmp_path, arm_msgs__action__Lift__action=text)])
    assert shown(interfaces, "arm_msgs", "Lift", Section.GOAL)[0] == {"level": "arm_msgs/Level"}
    assert shown(interfaces, "arm_msgs", "Lift", Section.RESULT)[0] == {}
    assert shown(interfaces, "arm_msgs", "Lift", Section.FEEDBACK)[0] == {
        "done": "float32[]",
        "text": "string",
        "t": "builtin_interfaces/Time",
    }
    assert shown(interfaces, "arm_msgs", "Lift", Section.REQUEST) == [None, None]


def test_a_message_may_have_a_rule_in_its_comments(tmp_path: Path) -> None:
    interfaces = RosTypes([write(tmp_path, a__msg__A__msg="#---\nint8 x\n#---\n")])
    assert shown(interfaces, "a", "A")[0] == {"x": "int8"}


@pytest.mark.parametrize(
    ("path", "text", "message"),
    [
        ("a__msg__A__msg", "int8 x\nint8[2][2] y\n", r"A\.msg: `int8\[2\]\[2\] y` is not a field$"),
        ("a__msg__A__msg", "int8 x\n---\n", r"A\.msg: `---` is not a field$"),
        ("a__srv__A__srv", "int8 x\n", r"A\.srv: it has 1 sections, expected 2 with `---` between them$"),
        ("a__action__A__action", "---\n---\n---\n", r"A\.action: it has 4 sections, expected 3"),
    ],
)
def test_damaged_definition(tmp_path: Path, path: str, text: str, message: str) -> None:
    part = {"msg": Section.MESSAGE, "srv": Section.REQUEST, "action": Section.GOAL}[path.rpartition("__")[2]]
    for distribution in RosTypes([write(tmp_path, **{path: text})]).distributions:
        with pytest.raises(DefinitionError, match=message):
            distribution.fields("a", "A", part)
    assert RosTypes([tmp_path]).field_of_basic("a", "A", part) == "data"


@pytest.mark.parametrize("below", ["", "src", "src/a_msgs"])
def test_a_folder_may_be_a_workspace_or_a_package(tmp_path: Path, below: str) -> None:
    write(tmp_path, src__a_msgs__msg__A__msg="int8 x\n")
    assert shown(RosTypes([tmp_path / below]), "a_msgs", "A")[0] == {"x": "int8"}


def test_a_package_has_the_name_in_its_manifest(tmp_path: Path) -> None:
    write(tmp_path, repository__package__xml="<package><name> a_msgs </name></package>")
    write(tmp_path, repository__msg__A__msg="int8 x\n", repository__test__b_msgs__msg__B__msg="int8 y\n")
    interfaces = RosTypes([tmp_path])
    assert shown(interfaces, "a_msgs", "A")[0] == {"x": "int8"}
    assert shown(interfaces, "repository", "A")[0] is None
    assert shown(interfaces, "b_msgs", "B")[0] is None


@pytest.mark.parametrize(
    ("manifest", "expected"),
    [
        ("<buildtool_depend>catkin</buildtool_depend>", [None, {"x": "int8"}]),
        ("<build_type>ament_cmake</build_type>", [{"x": "int8"}, None]),
        ("<depend>ament_cmake</depend><depend>catkin</depend>", [{"x": "int8"}, {"x": "int8"}]),
        ("", [{"x": "int8"}, {"x": "int8"}]),
    ],
)
def test_a_package_is_for_the_ros_that_it_is_built_for(tmp_path: Path, manifest: str, expected: list[object]) -> None:
    write(tmp_path, a__package__xml=f"<package><name>a</name>{manifest}</package>", a__msg__A__msg="int8 x\n")
    assert shown(RosTypes([tmp_path]), "a", "A") == expected


@pytest.mark.parametrize("marker", ["AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"])
def test_ignored_folders(tmp_path: Path, marker: str) -> None:
    write(tmp_path, old__a__msg__A__msg="int8 x\n")
    (tmp_path / "old" / marker).touch()
    assert shown(RosTypes([tmp_path]), "a", "A") == [None, None]


def test_the_first_folder_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("first", "second", "third"):
        write(tmp_path / name, a__msg__A__msg=f"int8 {name}\n")
    write(tmp_path / "third", a__msg__B__msg="int8 b\n", std_msgs__msg__Bool__msg="int8 own\n")
    monkeypatch.setenv("ROBOSC_INTERFACE_PATH", f"{tmp_path / 'second'}:{tmp_path / 'third'}")
    interfaces = RosTypes([tmp_path / "first"])
    assert shown(interfaces, "a", "A") == [{"first": "int8"}] * 2
    assert shown(RosTypes(), "a", "A") == [{"second": "int8"}] * 2
    assert shown(interfaces, "a", "B") == [{"b": "int8"}] * 2
    assert shown(interfaces, "std_msgs", "Bool") == [{"own": "int8"}] * 2


def test_installations(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "two" / "share", a__msg__A__msg="int8 two\n")
    write(tmp_path / "one" / "stacks", a__msg__A__msg="int8 one\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path / 'nothing'}:{tmp_path / 'two'}")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "one"))
    assert shown(RosTypes(), "a", "A") == [{"two": "int8"}, {"one": "int8"}]


def test_installations_whose_setup_was_not_sourced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ros_types, "_INSTALLATIONS", tmp_path)
    for name, mark in (("jazzy", "ament_index"), ("lyrical", "ament_index"), ("noetic", "catkin"), ("broken", "lost")):
        write(tmp_path / name / "share", a__msg__A__msg=f"int8 {name}\n")
        (tmp_path / name / "share" / mark).mkdir()
    write(tmp_path / "jazzy" / "share", b__msg__B__msg="int8 x\n")
    assert shown(RosTypes(), "a", "A") == [{"lyrical": "int8"}, {"noetic": "int8"}]
    assert shown(RosTypes(), "b", "B") == [{"x": "int8"}, None]
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "jazzy"))
    assert shown(RosTypes(), "a", "A") == [{"jazzy": "int8"}, {"noetic": "int8"}]


@pytest.mark.parametrize("place", ["", "src/arm", "install/arm_msgs/share", "install/share", "deep/down/below"])
@pytest.mark.parametrize("below", [False, True])
def test_a_package_is_found_in_each_layout(tmp_path: Path, place: str, below: bool) -> None:
    manifest = "<package><name>arm_msgs</name><depend>rosidl_default_generators</depend></package>"
    write(tmp_path / place, arm_msgs__msg__Grip__msg="int8 x\n", arm_msgs__package__xml=manifest)
    types = RosTypes([tmp_path / place / "arm_msgs" if below else tmp_path])
    assert shown(types, "arm_msgs", "Grip") == [{"x": "int8"}, None]


@pytest.mark.parametrize(("package", "name"), [("..", "A"), ("a/../a", "A"), ("a", "../msg/A"), ("/a", "A"), ("", "A")])
def test_names_are_no_paths(tmp_path: Path, package: str, name: str) -> None:
    folder = write(tmp_path, a__msg__A__msg="int8 x\n") / "a"
    assert shown(RosTypes([folder]), package, name) == [None, None]


def test_names_of_types(tmp_path: Path) -> None:
    write(tmp_path, a__msg__B__msg="", a__msg__A__msg="", a__srv__C__srv="---\n", std_srvs__srv__Own__srv="---\n")
    for distribution in RosTypes([tmp_path]).distributions:
        assert distribution.names("a", "message") == ["A", "B"]
        assert distribution.names("a", "service") == ["C"]
        assert distribution.names("a", "action") == []
        assert {*distribution.names("std_srvs", "service")} >= {"Empty", "Own", "SetBool", "Trigger"}
        assert "Twist" in distribution.names("geometry_msgs", "message")


def test_field_of_a_basic_value(tmp_path: Path) -> None:
    write(tmp_path, a__msg__Level__msg="int8 level\n", a__msg__Two__msg="int8 level\nint8 data\n")
    write(tmp_path, a__srv__Set__srv="bool on\n---\n---\n")
    write(tmp_path / "old", b__package__xml="<name>b</name>catkin", b__msg__Old__msg="int8 old\n")
    write(tmp_path / "new", b__package__xml="<name>b</name>ament_cmake", b__msg__Old__msg="int8 new\nint8 more\n")
    interfaces = RosTypes([tmp_path])
    assert interfaces.field_of_basic("a", "Level", Section.MESSAGE) == "level"
    assert interfaces.field_of_basic("a", "Two", Section.MESSAGE) == "data"
    assert interfaces.field_of_basic("std_srvs", "SetBool", Section.REQUEST) == "data"
    assert interfaces.field_of_basic("nowhere", "A", Section.MESSAGE) == "data"
    assert interfaces.field_of_basic("a", "Set", Section.REQUEST) == "data"  # a file without read permission
    assert interfaces.field_of_basic("b", "Old", Section.MESSAGE) == "old"


@pytest.mark.parametrize(("ros", "distribution"), [("ros1", 1), ("ros2", 0)])
def test_minimal_packages_define_the_same_for_both_ros(ros: str, distribution: int) -> None:
    definitions = sorted(path for path in (MINIMAL / ros).rglob("*.*") if path.suffix in {".msg", ".srv", ".action"})
    definitions = [path for path in definitions if path.parents[1].name != "bond"]  # ROS 2 only
    assert len(definitions) == 13
    interfaces = RosTypes([MINIMAL])
    kinds = {part: folder for part in Section for folder in ("msg", "srv", "action") if part.kind.startswith(folder[0])}
    for path in definitions:
        package = path.parents[1].name
        for part in (part for part, folder in kinds.items() if folder == path.parent.name):
            fields = interfaces.distributions[distribution].fields(package, path.stem, part)
            assert fields is not None
            assert interfaces.distributions[1 - distribution].fields(package, path.stem, part) == fields


@pytest.mark.parametrize(("links", "loaded"), [("", False), (" links number", True)])
def test_loads_definitions_only_where_a_model_links_them(tmp_path: Path, links: str, loaded: bool) -> None:
    model = tmp_path / "robot.rscd"
    declared = "interface number use Float64 from std_msgs"
    model.write_text(f"robot R {{ {declared} component C {{ incoming message m with type: double{links} }} }}")
    program = (
        "import sys, robosc; robot = robosc.load(sys.argv[1]);"
        "assert robosc.check(robot) == []; robosc.to_rosgraph(robot);"
        "print(any(module.split('.')[0] == 'rosbags' for module in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", program, model], check=True, capture_output=True, text=True)
    assert done.stdout == f"{loaded}\n"


@pytest.mark.parametrize(
    ("package", "name", "section", "meant"),
    [
        ("nav5_msgs", "ManageLifecycleNodes", Section.REQUEST, ("nav2_msgs", "ManageLifecycleNodes")),
        ("nav5_msgs", "ManageLifecycleNodes", Section.MESSAGE, None),
        ("nav5_msgs", "Path", Section.MESSAGE, ("nav_msgs", "Path")),
        ("std5_srvs", "SetBool", Section.MESSAGE, None),
        ("std5_srvs", "SetBool", Section.REQUEST, ("std_srvs", "SetBool")),
        ("nav5_msgs", "NavigateToPose", Section.GOAL, ("nav2_msgs", "NavigateToPose")),
        ("nav5_msgs", "NavigateToPose", Section.MESSAGE, None),
        ("nav5_msgs", "SpeedLimit", Section.MESSAGE, ("nav2_msgs", "SpeedLimit")),
        ("nav5_msgs", "SpeedLimit", Section.REQUEST, None),
        ("control5_msgs", "GripperCommand", Section.GOAL, ("control_msgs", "GripperCommand")),
        ("control5_msgs", "GripperCommand", Section.MESSAGE, ("control_msgs", "GripperCommand")),
        ("control5_msgs", "GripperCommand", Section.REQUEST, None),
        ("sensors_msgs", "LaserScan", Section.MESSAGE, ("sensor_msgs", "LaserScan")),
        ("std_srv", "Trigger", Section.REQUEST, ("std_srvs", "Trigger")),
        ("std_srv", "Triger", Section.REQUEST, None),
    ],
)
def test_a_package_is_suggested_only_if_it_has_that_type_of_that_kind(
    package: str, name: str, section: Section, meant: tuple[str, str] | None
) -> None:
    message, hint, found = RosTypes().why_unknown(package, name, section)
    assert message == f"the package `{package}` is unknown"
    assert found == meant
    assert ("did you mean" in hint) == (meant is not None)


@pytest.mark.parametrize(
    ("package", "name", "section", "meant"),
    [
        ("geometry_msgs", "LaserScan", Section.MESSAGE, ("sensor_msgs", "LaserScan")),
        ("nav_msgs", "SpeedLimit", Section.MESSAGE, ("nav2_msgs", "SpeedLimit")),
        ("std_srvs", "GripperCommand", Section.GOAL, ("control_msgs", "GripperCommand")),
        ("std_msgs", "Trigger", Section.MESSAGE, None),
        ("geometry_msgs", "Twits", Section.MESSAGE, ("geometry_msgs", "Twist")),
        ("geometry_msgs", "Nothing", Section.MESSAGE, None),
    ],
)
def test_another_package_is_suggested_only_if_it_has_that_type(
    package: str, name: str, section: Section, meant: tuple[str, str] | None
) -> None:
    message, hint, found = RosTypes().why_unknown(package, name, section)
    assert (f"{package}/{name} is of kind" in message) or message.startswith(f"no {section.kind} type `{name}` of")
    assert found == meant
    assert ("did you mean" in hint) == (meant is not None)


def test_a_folder_that_is_too_large_is_searched_in_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(folders, "MOST_FOLDERS", 30)
    for number in range(40):
        (tmp_path / f"p{number:02}" / "msg").mkdir(parents=True)
        (tmp_path / f"p{number:02}" / "msg" / "Found.msg").write_text("int32 x\n")
    types = RosTypes([tmp_path])
    assert types.distributions[0].fields("p03", "Found", Section.MESSAGE) is not None
    assert types.distributions[0].fields("p39", "Found", Section.MESSAGE) is None
    message, hint, _ = types.why_unknown("p39", "Found", Section.MESSAGE)
    assert message == "the package `p39` is unknown"
    assert hint.endswith("use --interface-path with a folder nearer to the package")
    assert "name a folder above the package" in RosTypes([tmp_path / "p39"]).why_unknown("q", "X", Section.MESSAGE)[1]
