"""The packages of a supervisory layer, file by file; `tests/ros` shows that they build and work."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest
from catkin_pkg.package import parse_package_string
from ruamel.yaml import YAML

import robosc
from robosc.language import configuration as config
from robosc.language.configuration import Configuration
from robosc.m2t.targets import TARGETS
from robosc.model import sct
from tests.ros.launching import launched

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent
TARGET = "ros2-layer"


@pytest.fixture(scope="module")
def usher() -> robosc.Models:
    return models_of(HERE / "usher.rscd")


@pytest.fixture(scope="module")
def settings() -> Configuration:
    return config.read(HERE / "controller-config.json")


def models_of(path: Path) -> robosc.Models:
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot)


def test_every_file(
    usher: robosc.Models, settings: Configuration, golden_package: Callable[[Path, dict[str, str]], None]
) -> None:
    files = robosc.generate(TARGET, usher, settings)
    for path, text in files.items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path
    golden_package(HERE / TARGET, files)
    assert robosc.generate(TARGET, usher, settings) == files


@pytest.mark.parametrize("logs", [False, True])
def test_parameters_of_the_model_have_a_file(logs: bool) -> None:
    """The parameter YAML and the launch file declare them; a layer without parameters has no YAML file."""
    models = models_of(HERE.parents[1] / "run" / "runtime" / "cruise.rscd")
    behind = config.ExistingController(launch=config.Launch(package_name="drive", file="drive.launch.py"))
    settings = Configuration(write_events_to_log=logs, supervisor=config.Supervisor(controller=behind))
    files = robosc.generate(TARGET, models, settings)
    kept = {"period_ms": 100, "diagnostics_ms": 1000}
    own = {"speed": 0.2, "reach": 0.5, "least": 3, "greeting": "hello", "doubled": False}
    in_components = {"Base": {"factor": -1.0}, "Lamp": {"pause": 60.0}}
    read = YAML(typ="safe").load
    declared = kept | own | in_components
    assert read(files["config/cruise_layer.yaml"]) == {"/**/cruise_layer": {"ros__parameters": declared}}
    node, *_ = launched(files["launch/cruise_layer.launch.py"]).of("Node")
    file, *others = node.named["parameters"]
    assert file == os.devnull, "the installed file"
    assert len(others) == (not logs)
    # The controller that is launched behind it has its own file.
    assert '"params_file"' in files["launch/cruise_layer.launch.py"].partition("hidden = [")[2].partition("]")[0]
    assert "install(DIRECTORY config launch" in files["CMakeLists.txt"]


def test_packages_list_what_is_used(usher: robosc.Models, settings: Configuration) -> None:
    messages = {"diagnostic_msgs", "nav2_msgs", "sensor_msgs", "std_msgs", "std_srvs"}
    text = robosc.generate(TARGET, usher, settings)["package.xml"]
    package = parse_package_string(text)
    package.validate()
    assert package.name == "usher_layer"
    used = {"action_msgs", "rclcpp", "rclcpp_components", *messages}
    assert {build_depend.name for build_depend in package.build_depends} == used
    assert {exec_depend.name for exec_depend in package.exec_depends} == {*used, "launch", "launch_ros", "usher_driver"}
    described = ElementTree.fromstring(text).findtext("description")  # noqa: S314  # our own text
    assert described == "Lets <data> & more pass: ]]> -->"


def test_a_layer_and_its_controller_share_a_workspace(usher: robosc.Models) -> None:
    folders = {name: TARGETS[name].folder(usher, Configuration()) for name in ("ros2", TARGET)}
    assert folders == {"ros2": "ros2/usher_controller", TARGET: "ros2/usher_layer"}
    assert TARGETS[TARGET].folder(usher, Configuration.model_validate({"package": {"name": "gate"}})) == "ros2/gate"


def test_the_launch_file_re_maps_everything(usher: robosc.Models, settings: Configuration) -> None:
    text = robosc.generate(TARGET, usher, settings)["launch/usher_layer.launch.py"]
    action = [f"/go_to/_action/{part}" for part in ("send_goal", "cancel_goal", "get_result", "feedback", "status")]
    names = ["/stop", "/resume", "battery", "/scan", "/speed", "label", "/lamp/light", *action]
    layer, driver = launched(text).of("Node")
    assert (layer.named["package"], layer.named["executable"]) == ("usher_layer", "usher_layer")
    assert (driver.named["package"], driver.named["executable"]) == ("usher_driver", "driver.py")
    assert driver.named["remappings"] == [(name, f"/usher_layer/controller/{name.lstrip('/')}") for name in names]
    moved = launched(text, namespace="/left/", name="gate").of("Node")[1]
    assert moved.named["remappings"][0] == ("/stop", "/left/gate/controller/stop")
    # The layer is below a namespace that another launch file has pushed, unless its own namespace is absolute.
    for namespace, layer in {"": "/hall/usher_layer", "left": "/hall/left/usher_layer", "/": "/usher_layer"}.items():
        pushed = launched(text, ros_namespace="/hall", namespace=namespace).of("Node")[1]
        assert pushed.named["remappings"][0] == ("/stop", f"{layer}/controller/stop")


def test_the_clock_of_the_launch_file(usher: robosc.Models, settings: Configuration) -> None:
    text = robosc.generate(TARGET, usher, settings)["launch/usher_layer.launch.py"]
    layer, driver = launched(text).of("Node")
    assert [*layer.named["parameters"][0]] == ["event_log"]
    assert driver.named["parameters"] == [], "what is set elsewhere holds"
    layer, driver = launched(text, use_sim_time="true").of("Node")
    assert layer.named["parameters"][0] == driver.named["parameters"][0]
    assert driver.named["parameters"][0]["use_sim_time"].named == {"value_type": bool}


def test_a_controller_with_a_launch_file_of_its_own(usher: robosc.Models) -> None:
    controller = {"launch": {"packageName": "my_robot", "file": "drive.launch"}}
    settings = Configuration.model_validate({"supervisor": {"controller": controller}})
    there = launched(robosc.generate(TARGET, usher, settings)["launch/usher_layer.launch.py"])
    remaps = there.of("SetRemap")
    assert len(remaps) == 12
    assert remaps[0].positional == ("/stop", "/usher_layer/controller/stop")
    (include,) = there.of("IncludeLaunchDescription")
    (path,) = include.positional[0].positional
    assert [path.positional[0][0].positional, path.positional[0][1]] == [("my_robot",), "launch/drive.launch"]
    assert there.actions.index(include) > there.actions.index(remaps[-1])
    hidden = there.of("UnsetLaunchConfiguration")
    assert {action.positional[0] for action in hidden} == set(there.arguments), "the controller gets none of them"
    assert there.actions.index(include) > there.actions.index(hidden[-1])


def test_a_layer_alone(usher: robosc.Models) -> None:
    assert len(launched(robosc.generate(TARGET, usher)["launch/usher_layer.launch.py"]).of("Node")) == 1


def test_leaves_out_what_is_not_asked_for(usher: robosc.Models, tmp_path: Path) -> None:
    ear = tmp_path / "ear.rscd"
    ear.write_text("robot Ear { component One { outgoing message heard with type: none } }", encoding="utf-8")
    silent = robosc.generate(TARGET, usher, Configuration(publish_state_information=False, diagnostics_ms=0))
    assert "diagnostic_msgs" not in "".join(silent.values())
    assert "timer_" not in silent["src/usher_layer_node.cpp"]
    assert "include/usher_layer/definition.hpp" not in silent
    assert "state_report_" not in silent["src/usher_layer_node.cpp"]
    files = robosc.generate(TARGET, models_of(ear), Configuration(diagnostics_ms=0))
    headers = {path for path in files if path.startswith("include")}
    robosc_headers = ("callback_guard", "data", "event_log", "hangup", "json", "queue_depth", "transitions", "version")
    over_ros = ("arrivals", "countdown", "durabilities", "graph_monitor", "guarded_node", "message_relay")
    over_ros += ("node_services", "parameters", "report")
    assert headers == {
        "include/ear_layer/definition.hpp",
        *(f"include/robosc/{name}.hpp" for name in robosc_headers),
        *(f"include/robosc_ros2/{name}.hpp" for name in over_ros),
    }


@pytest.mark.parametrize(
    ("model", "node"),
    [
        ("run/runtime/guard", "GuardedNode<rclcpp::Node>"),
        ("ros/ends/carrier", "GuardedNode<rclcpp::Node>"),
        ("ros/blocked/hoist", "GuardedNode<rclcpp::Node, kSlowBeat>"),
    ],
)
def test_a_node_without_countdowns_wakes_rarely(model: str, node: str) -> None:
    models = models_of(HERE.parents[1] / f"{model}.rscd")
    (text,) = (text for name, text in robosc.generate(TARGET, models).items() if name.endswith("_node.cpp"))
    assert f"class Layer : public {node} {{" in text


def test_quality_of_service(usher: robosc.Models) -> None:
    chosen = {
        "speed": {"reliability": "best_effort", "depth": 3},
        "/stop": {"reliability": "best_effort"},
        "/battery": {"depth": 7, "durability": "transient_local"},
        "/lamp/light": {"depth": 4, "durability": "volatile"},
        "go_to": {"reliability": "best_effort", "depth": 5},
    }
    settings = Configuration.model_validate({"qos": chosen})
    assert TARGETS[TARGET].findings(usher, settings) == []
    node = " ".join(robosc.generate(TARGET, usher, settings)["src/usher_layer_node.cpp"].split())
    # Received with the configured QoS, forwarded reliably.
    kept = "rclcpp::QoS(10){}.transient_local()".format
    speed, battery = ".keep_last(3).best_effort()", ".keep_last(7)"
    for given in (
        f'"~/controller/speed", "/speed", rclcpp::QoS(10){speed}, {kept(speed)}, rclcpp::QoS(10).keep_last(3),',
        f'"~/controller/stop", rclcpp::QoS(10).best_effort(), {kept(".best_effort()")}, rclcpp::QoS(10),',
        f'"~/controller/battery", rclcpp::QoS(10){battery}, {kept(battery)}, rclcpp::QoS(10).keep_last(7),',
    ):
        assert given.replace(" .", ".") in node.replace(" .", ".")
    assert '"/lamp/light", rclcpp::ServicesQoS().keep_last(4).durability_volatile(), service_timeout' in node
    assert '"/go_to", rclcpp::QoS(10).keep_last(5).best_effort(), action_timeout' in node


SHARED = """
robot Cart {
  component Button {
    outgoing message down with identifier: "/button", type: none
    outgoing message up with identifier: "button", type: none
  }
  component Drive {
    incoming message go with identifier: "/drive", type: boolean
    incoming message halt with identifier: "/drive", type: boolean
  }
}
"""


def test_two_communications_on_one_topic(tmp_path: Path) -> None:
    cart = tmp_path / "cart.rscd"
    cart.write_text(SHARED, encoding="utf-8")
    models = models_of(cart)
    found = TARGETS[TARGET].findings(models, Configuration())
    assert [(finding.rule, finding.severity.value, finding.span.line) for finding in found] == [
        ("layer-topic", "error", 5),
        ("layer-topic", "error", 9),
    ]
    assert "go and halt are both on" in found[1].message
    assert TARGETS["ros2"].findings(models, Configuration(on_shutdown=[])) == []


@pytest.mark.parametrize(
    ("controller", "message"),
    [
        ({"run": {"packageName": "Drive", "executable": "drive"}}, "run.packageName"),
        ({"run": {"packageName": "drive", "executable": '"/><x>'}}, "run.executable"),
        ({"run": {"packageName": "drive", "executable": "drive", "name": "2nd"}}, "run.name"),
        ({"run": {"packageName": "drive", "executable": "drive", "namespace": "a//b"}}, "run.namespace"),
        ({"launch": {"packageName": "drive", "file": "../drive.launch"}}, "launch.file"),
        (
            {"run": {"packageName": "a_b", "executable": "c"}, "launch": {"packageName": "a_b", "file": "c.launch"}},
            "both start",
        ),
    ],
)
def test_a_controller_that_no_launch_file_could_start(
    controller: dict[str, object], message: str, usher: robosc.Models
) -> None:
    settings = Configuration.model_validate({"supervisor": {"controller": controller}})
    (found,) = TARGETS[TARGET].findings(usher, settings)
    assert (found.rule, found.severity.value) == ("configuration", "error")
    assert message in found.message


def test_settings_that_mean_nothing_to_a_layer(usher: robosc.Models) -> None:
    settings = Configuration.model_validate({"retryMs": 5, "onShutdown": ["speed"], "watchdogMs": {"stop": 100}})
    found = TARGETS[TARGET].findings(usher, settings)
    assert [finding.severity.value for finding in found] == 3 * ["warning"]
    assert [finding.message.split()[0] for finding in found] == ['"retryMs"', '"watchdogMs"', '"onShutdown"']


def test_frames_have_an_effect_only_on_the_messages_of_a_layer(usher: robosc.Models) -> None:
    frames = {"frameId": {"speed": "base"}}
    (found,) = TARGETS[TARGET].findings(usher, Configuration.model_validate(frames))
    assert found.message.startswith('"frameId" has no effect')
    sending = Configuration.model_validate({**frames, "onBlocked": ["speed"]})
    assert [found for found in TARGETS[TARGET].findings(usher, sending) if "frameId" in found.message] == []


def test_the_readme_of_a_layer_describes_no_managed_node(usher: robosc.Models) -> None:
    settings = Configuration.model_validate({"lifecycle": {"bond": True}})
    assert robosc.generate(TARGET, usher, settings)["README.md"] == robosc.generate(TARGET, usher)["README.md"]


def test_says_what_synthesis_added_is_the_reason(usher: robosc.Models) -> None:
    # A message has no requirement: only synthesis blocks it.
    text = robosc.generate(TARGET, usher)["src/usher_layer_node.cpp"]
    label = text.partition("bool pass_message_label()")[2].partition("}\n\n")[0]
    assert "add_requirement" not in label
    assert "add_state" not in label
    assert sum(plant.kind == sct.PlantKind.data for plant in usher.sct.plants) == 1
    assert "data_speed" not in text.replace("usher_data_speed_c_d1:", "").replace("usher_data_speed_c_none:", "")
