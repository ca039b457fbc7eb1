"""The ROS 2 package of the courier, file by file; `tests/ros` shows that it builds and works."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import pytest
from catkin_pkg.changelog import Changelog, populate_changelog_from_rst
from catkin_pkg.package import parse_package_string
from ruamel.yaml import YAML

import robosc
from robosc.language.configuration import Configuration, Lifecycle, Package
from robosc.language.configuration.names import absolute_names
from robosc.m2t.targets import TARGETS
from tests.m2t.conftest import differences
from tests.m2t.layer.test_layer import models_of
from tests.ros.launching import Made, launched

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def files(courier: robosc.Models, settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros2", courier, settings)


@pytest.fixture(scope="module")
def porter_files(porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros2", porter, porter_settings)


@pytest.fixture(scope="module")
def managed_files(porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    managed = {"lifecycle": Lifecycle(bond=True), "package": Package(name="managed_porter")}
    return robosc.generate("ros2", porter, porter_settings.model_copy(update=managed))


def test_every_file(files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]) -> None:
    golden_package(HERE / "courier", files)


def test_every_file_for_services_and_actions(
    porter_files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]
) -> None:
    golden_package(HERE / "porter", porter_files)


def test_what_is_special_in_a_managed_node(
    porter_files: dict[str, str], managed_files: dict[str, str], golden: Callable[[Path, str], None]
) -> None:
    def renamed(text: str) -> str:
        return text.replace("managed_porter", "porter_controller").replace("MANAGED_PORTER", "PORTER_CONTROLLER")

    same = {path for path, text in managed_files.items() if renamed(text) == porter_files.get(renamed(path))}
    special = sorted(set(managed_files) - same)
    assert special == [
        "CHANGELOG.rst",  # its title is underlined
        "CMakeLists.txt",
        "README.md",
        "include/robosc_ros2/bond.hpp",
        "include/robosc_ros2/lifecycle_services.hpp",
        "include/robosc_ros2/managed_node.hpp",
        "launch/managed_porter.launch.py",
        "package.xml",
        "src/managed_porter_node.cpp",
    ]
    own = [path for path in special if not path.endswith((".hpp", ".rst"))]
    managed = {renamed(path): renamed(managed_files[path]) for path in own}
    golden(HERE / "managed.diff", differences(porter_files, managed))


def test_package_lists_what_is_used(files: dict[str, str]) -> None:
    package = parse_package_string(files["package.xml"])
    package.validate()
    assert [buildtool_depend.name for buildtool_depend in package.buildtool_depends] == ["ament_cmake"]
    used = {"diagnostic_msgs", "geometry_msgs", "rclcpp", "rclcpp_components", "sensor_msgs", "std_msgs"}
    assert {build_depend.name for build_depend in package.build_depends} == used
    assert {exec_depend.name for exec_depend in package.exec_depends} == used | {"launch", "launch_ros", "python3-yaml"}
    described = ElementTree.fromstring(files["package.xml"]).findtext("description")  # noqa: S314  # our own text
    assert described == "Carries <data> & more: ]]> -->"
    assert package.maintainers[0].name == "A. O'Tester <&>"


def test_package_lists_what_services_actions_and_managed_nodes_need(
    porter_files: dict[str, str], managed_files: dict[str, str]
) -> None:
    messages = {"action_msgs", "diagnostic_msgs", "geometry_msgs", "nav2_msgs", "std_msgs", "std_srvs"}
    used = {"rclcpp", "rclcpp_action", "rclcpp_components"} | messages
    package = parse_package_string(porter_files["package.xml"])
    assert {build_depend.name for build_depend in package.build_depends} == used
    managed = parse_package_string(managed_files["package.xml"])
    used |= {"bond", "lifecycle_msgs", "rclcpp_lifecycle"}
    assert {build_depend.name for build_depend in managed.build_depends} == used
    launching = {exec_depend.name for exec_depend in managed.exec_depends} - {
        build_depend.name for build_depend in managed.build_depends
    }
    assert launching == {"launch", "launch_ros", "python3-yaml"}


@pytest.mark.parametrize("name", ["courier", "managed"])
def test_launch_file_is_python(name: str, files: dict[str, str], managed_files: dict[str, str]) -> None:
    path = {"courier": "launch/courier_controller.launch.py", "managed": "launch/managed_porter.launch.py"}[name]
    tree = ast.parse((files | managed_files)[path])
    functions = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    shared = ["is_true", "full_name", "typed", "parameters", "node"]
    assert functions == [*shared, "start", "generate_launch_description"]
    imported = [alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert set(imported) <= used


def test_a_container_loads_the_node(files: dict[str, str], tmp_path: Path) -> None:
    """The arguments are those of Nav2's launch files. Parameters of the default name apply to each name."""
    text = files["launch/courier_controller.launch.py"]
    (tmp_path / "mine.yaml").write_text(
        'courier_controller: {ros__parameters: {period_ms: 50, greeting: "on"}}', encoding="utf-8"
    )
    there = launched(
        text,
        use_composition="True",
        container_name="box",
        namespace="r1",
        name="left",
        remappings="/scan:=scan",
        params_file=str(tmp_path / "mine.yaml"),
    )
    (loading,) = there.of("LoadComposableNodes")
    assert loading.named["target_container"] == "/r1/box"
    (component,) = loading.named["composable_node_descriptions"]
    assert component.named["plugin"] == "courier_controller::Controller"
    assert component.named["remappings"] == [("/scan", "scan")]
    file, values = component.named["parameters"]
    assert file == str(tmp_path / "mine.yaml")
    assert values["period_ms"] == 50
    assert values["greeting"] == Made("ParameterValue", ("on",), {"value_type": str}), "a text stays a text"
    elsewhere = launched(text, use_composition="1", container_name="/box", namespace="r1")
    assert elsewhere.of("LoadComposableNodes")[0].named["target_container"] == "/box"


def test_a_process_starts_again_on_demand(files: dict[str, str]) -> None:
    text = files["launch/courier_controller.launch.py"]
    (node,) = launched(text).of("Node")
    assert node.named["respawn"] is False
    assert node.named["parameters"] == [os.devnull], "a process reads its parameters from the installed file"
    assert launched(text, use_respawn="true").of("Node")[0].named["respawn"] is True


def test_the_package_describes_itself(files: dict[str, str], courier: robosc.Models) -> None:
    readme = files["README.md"]
    assert courier.rosgraph is not None
    for topic in (*courier.rosgraph.subscriptions, *courier.rosgraph.publishers):
        assert f"| `{topic.topic}` | `{topic.interface.package}/msg/{topic.interface.type}` |" in readme
    (declared,) = YAML(typ="safe").load(files["config/courier_controller.yaml"]).values()
    for name, value in declared["ros__parameters"].items():
        for path in [f"{name}.{inner}" for inner in value] if isinstance(value, dict) else [name]:
            assert f"| `{path}` |" in readme
    changelog = Changelog("courier_controller")
    populate_changelog_from_rst(changelog, files["CHANGELOG.rst"].replace("Forthcoming", "9.9.9 (2026-11-28)", 1))
    assert [version for version, _, _ in changelog.foreach_version()] == ["9.9.9"]


@pytest.mark.parametrize("name", ["Apache-2.0", "BSD-3-Clause", "MIT", "MPL-2.0", "Proprietary"])
def test_a_known_license_has_its_text(porter: robosc.Models, porter_settings: Configuration, name: str) -> None:
    package = Package(license=name, maintainer="Ada Lovelace", url="https://example.org")
    settings = porter_settings.model_copy(update={"package": package, "typed_state": True})
    target = TARGETS["ros2"]
    named = {finding.message for finding in target.findings(porter, settings) if "LICENSE" in finding.message}
    assert len(named) == (name == "MPL-2.0")
    files = target.files(porter, settings)
    xml = ElementTree.fromstring(files["package.xml"])  # noqa: S314  # our own text
    has_text = name not in {"MPL-2.0", "Proprietary"}
    assert ("LICENSE" in files) == has_text
    assert any(path.endswith("_msgs/LICENSE") for path in target.beside(porter, settings)) == has_text
    license_of = xml.find("license")
    assert license_of is not None
    assert license_of.attrib == ({"file": "LICENSE"} if has_text else {})
    assert xml.findtext("url") == "https://example.org"
    if name in {"BSD-3-Clause", "MIT"}:
        assert "Copyright (c) Ada Lovelace" in files["LICENSE"]


def test_names_lose_their_slash(porter: robosc.Models, porter_settings: Configuration) -> None:
    """Only inside the generator: the graph stays as the model has it."""
    graph = porter.rosgraph
    assert graph is not None
    plain = robosc.generate("ros2", porter, porter_settings)
    absolute = [name for names in absolute_names(graph) for name in names]
    assert absolute
    relative = robosc.generate("ros2", porter, porter_settings.model_copy(update={"absolute_names": False}))
    node = relative["src/porter_controller_node.cpp"]
    for name in absolute:
        assert f'"{name}"' in plain["src/porter_controller_node.cpp"]
        assert f'"{name}"' not in node
        assert f'"{name[1:]}"' in node
    assert [name for names in absolute_names(graph) for name in names] == absolute
    assert "names_outside" not in node
    decided = Configuration.model_validate({"absoluteNames": True})
    assert "names_outside" not in robosc.generate("ros2", porter, decided)["src/porter_controller_node.cpp"]
    assert "names_outside" in plain["src/porter_controller_node.cpp"]


def test_a_library_declares_the_parameters(library: dict[str, str], tmp_path: Path) -> None:
    """The names and defaults are those of the parameters file."""
    ((name, tree),) = YAML(typ="safe").load(library["src/cruise_controller_parameters.yaml"]).items()
    assert name == "cruise_controller_parameters"
    (declared,) = YAML(typ="safe").load(library["config/cruise_controller.yaml"]).values()
    assert defaults(tree) == declared["ros__parameters"]
    assert tree["speed"]["validation"] == {"bounds<>": [0.05, 1.0]}
    assert "read_only" not in tree["speed"]
    assert tree["period_ms"]["read_only"] is True
    assert "<depend>generate_parameter_library</depend>" in library["package.xml"]
    generator = shutil.which("generate_parameter_library_cpp")
    if generator is None:
        pytest.skip("no generate_parameter_library_cpp")
    yaml = tmp_path / "cruise_controller_parameters.yaml"
    yaml.write_text(library["src/cruise_controller_parameters.yaml"], encoding="utf-8")
    subprocess.run([generator, tmp_path / "out.hpp", yaml], check=True)
    assert "double speed = 0.2;" in (tmp_path / "out.hpp").read_text(encoding="utf-8")


def test_a_library_gets_no_keyword_as_a_name() -> None:
    models = models_of(HERE.parents[2] / "examples" / "line_follower" / "line_follower.rscd")
    settings = Configuration.model_validate({"parameters": "library"})
    files = robosc.generate("ros2", models, settings)
    (tree,) = YAML(typ="safe").load(files["src/line_follower_controller_parameters.yaml"]).values()
    assert set(tree["watchdog_ms"]) == {"correction", "emergency_stop", "no_line", "scan"}
    assert '"watchdog_ms.continue"' in files["src/line_follower_controller_node.cpp"]
    logs = settings.model_copy(update={"write_events_to_log": True})
    assert "event_log" not in robosc.generate("ros2", models, logs)["src/line_follower_controller_parameters.yaml"]


def defaults(tree: dict[str, Any]) -> dict[str, Any]:
    """Return the defaults of a tree of parameters."""
    return {
        name: known["default_value"] if "default_value" in known else defaults(known) for name, known in tree.items()
    }


@pytest.fixture(scope="module")
def library() -> dict[str, str]:
    models = models_of(HERE.parents[1] / "run" / "runtime" / "cruise.rscd")
    return robosc.generate("ros2", models, Configuration.model_validate({"parameters": "library"}))


@pytest.mark.parametrize(
    ("quality", "expected"),
    [
        ("{}", "rclcpp::SensorDataQoS()"),
        ('{"scan": {"depth": 3}}', "rclcpp::SensorDataQoS().keep_last(3)"),
        ('{"/scan": {"reliability": "reliable"}}', "rclcpp::SensorDataQoS().reliable()"),
        (
            '{"scan": {"reliability": "best_effort", "durability": "transient_local", "depth": 1}}',
            "rclcpp::SensorDataQoS().keep_last(1).best_effort().transient_local()",
        ),
        ('{"scan": {"durability": "volatile"}}', "rclcpp::SensorDataQoS().durability_volatile()"),
        ('{"target": {"depth": 1}}', "rclcpp::SensorDataQoS()"),
    ],
)
def test_quality_of_service(courier: robosc.Models, quality: str, expected: str) -> None:
    settings = Configuration.model_validate_json(f'{{"qos": {quality}}}')
    node = robosc.generate("ros2", courier, settings)["src/courier_controller_node.cpp"]
    assert f'"/scan", {expected},' in " ".join(node.split())
    assert '"count", rclcpp::QoS(10),' in " ".join(node.split())


@pytest.mark.parametrize(
    ("name", "default"), [("/gripper/grip", "rclcpp::ServicesQoS()"), ("/travel", "rclcpp::QoS(10)")]
)
def test_quality_of_service_of_clients(porter: robosc.Models, name: str, default: str) -> None:
    quality = f'{{"qos": {{"{name}": {{"depth": 3, "reliability": "best_effort"}}}}}}'
    for settings, expected in (("{}", default), (quality, f"{default}.keep_last(3).best_effort()")):
        files = robosc.generate("ros2", porter, Configuration.model_validate_json(settings))
        assert f'"{name}", {expected},' in " ".join(files["src/porter_controller_node.cpp"].split())


def test_parameters_of_the_file_are_those_of_the_node(porter_files: dict[str, str]) -> None:
    (node,) = YAML(typ="safe").load(porter_files["config/porter_controller.yaml"]).items()
    assert node[0] == "/**/porter_controller"
    parameters = node[1]["ros__parameters"]
    assert parameters == {
        "period_ms": 100,
        "events_per_tick": 0,
        "react_immediately": True,
        "reactions_per_tick": 10,
        "event_log": "",
        "service_timeout_ms": 3000,
        "action_timeout_ms": 2000,
        "retry_ms": 500,
        "watchdog_stops": True,
        "diagnostics_ms": 1000,
        "watchdog_ms": {"order": 0, "stop": 400},
    }
    node = " ".join(porter_files["src/porter_controller_node.cpp"].split())
    names = [*parameters, *(f"watchdog_ms.{topic}" for topic in parameters.pop("watchdog_ms"))]
    assert [name for name in names if f'"{name}",' not in node] == ["watchdog_ms"]


def test_leaves_out_what_is_not_asked_for(courier: robosc.Models) -> None:
    silent = robosc.generate("ros2", courier, Configuration(publish_state_information=False))
    assert "include/courier_controller/definition.hpp" not in silent
    assert "~/" not in silent["src/courier_controller_node.cpp"]


def test_the_same_twice(courier: robosc.Models, settings: Configuration, files: dict[str, str]) -> None:
    assert robosc.generate("ros2", courier, settings) == files


def test_every_text_ends_with_a_line(files: dict[str, str], managed_files: dict[str, str]) -> None:
    for path, text in (files | managed_files).items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path


@pytest.mark.parametrize("name", ["courier", "porter", "managed"])
def test_the_platform_s_linter_is_content(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    files = request.getfixturevalue("files" if name == "courier" else f"{name}_files")
    # The options of ament_lint_cmake.
    filters = "--filter=-convention/filename,-package/consistency,-package/stdargs"
    (tmp_path / "CMakeLists.txt").write_text(files["CMakeLists.txt"], encoding="utf-8")
    command = [sys.executable, "-m", "cmakelint.main", filters, "--linelength=140", tmp_path / "CMakeLists.txt"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
