"""Start courier_controller, as a process or in a container."""

from pathlib import Path

import yaml
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

PACKAGE = "courier_controller"
NAME = "courier_controller"


def is_true(context, argument):
    return LaunchConfiguration(argument).perform(context).lower() in ("true", "1")


def full_name(context, name):
    """Return a name in the namespace of the node. An including file may have pushed one around it."""
    namespace = LaunchConfiguration("namespace").perform(context)
    outer = "" if namespace.startswith("/") else context.launch_configurations.get("ros_namespace", "")
    return "/" + "/".join(filter(None, (part.strip("/") for part in (outer, namespace, name))))


def typed(value):
    """Return parameters whose texts stay texts. Otherwise, the launch system reads them as YAML."""
    if isinstance(value, dict):
        return {name: typed(inner) for name, inner in value.items()}
    return ParameterValue(value, value_type=str) if isinstance(value, str) else value


def parameters(context):
    """Return the parameters. Those of NAME in the file apply with each name and in each namespace of the node."""
    file = LaunchConfiguration("params_file").perform(context)
    nodes = yaml.safe_load(Path(file).read_text(encoding="utf-8")) or {}
    keys = [NAME, f"/{NAME}"]
    # Only a process with this name reads the third form itself.
    if is_true(context, "use_composition") or LaunchConfiguration("name").perform(context) != NAME:
        keys.append(f"/**/{NAME}")
    values = [file, *(typed(nodes[key]["ros__parameters"]) for key in keys if key in nodes)]
    if LaunchConfiguration("use_sim_time").perform(context):
        values.append({"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)})
    return values


def node(context):
    """Return the action that starts the node: as a process, or in a container that runs already."""
    settings = {
        "package": PACKAGE,
        "name": LaunchConfiguration("name"),
        "namespace": LaunchConfiguration("namespace"),
        "parameters": parameters(context),
        "remappings": [
            tuple(remapping.split(":=", 1)) for remapping in LaunchConfiguration("remappings").perform(context).split()
        ],
    }
    if is_true(context, "use_composition"):
        container = LaunchConfiguration("container_name").perform(context)
        return LoadComposableNodes(
            target_container=container if container.startswith("/") else full_name(context, container),
            composable_node_descriptions=[ComposableNode(plugin=f"{NAME}::Controller", **settings)],
        )
    return Node(
        executable=NAME,
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
        output="screen",
        respawn=is_true(context, "use_respawn"),
        respawn_delay=2.0,
        **settings,
    )


def start(context):
    return [node(context)]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value=NAME, description="Name of the node"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node"),
            DeclareLaunchArgument(
                "params_file",
                default_value=PathJoinSubstitution([FindPackageShare(PACKAGE), "config", f"{NAME}.yaml"]),
                description="Parameters, as YAML",
            ),
            DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
            DeclareLaunchArgument(
                "use_sim_time", default_value="", description="Whether /clock gives the time; empty: as set elsewhere"
            ),
            DeclareLaunchArgument(
                "remappings", default_value="", description="Other names, such as '/scan:=/front/scan stop:=/stop'"
            ),
            DeclareLaunchArgument(
                "use_composition", default_value="false", description="Whether a running container loads the node"
            ),
            DeclareLaunchArgument(
                "container_name", default_value="nav2_container", description="Name of that container"
            ),
            DeclareLaunchArgument(
                "use_respawn", default_value="false", description="Whether a node that died starts again after 2 s"
            ),
            OpaqueFunction(function=start),
        ]
    )
