"""Start courier_controller."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

PACKAGE = "courier_controller"
NAME = "courier_controller"


def start(context):
    """Return the node. Its remappings arrive as one text."""
    remappings = LaunchConfiguration("remappings").perform(context).split()
    parameters = [LaunchConfiguration("params_file")]
    if LaunchConfiguration("use_sim_time").perform(context):
        parameters.append({"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)})
    node = Node(
        package=PACKAGE,
        executable=NAME,
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        parameters=parameters,
        remappings=[tuple(remapping.split(":=", 1)) for remapping in remappings],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
        output="screen",
    )
    return [node]


def generate_launch_description():
    parameters = PathJoinSubstitution([FindPackageShare(PACKAGE), "config", f"{NAME}.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value=NAME, description="Name of the node"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="Parameters, as YAML"),
            DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
            DeclareLaunchArgument(
                "use_sim_time", default_value="", description="Whether /clock gives the time; empty: as set elsewhere"
            ),
            DeclareLaunchArgument(
                "remappings", default_value="", description="Other names, such as '/scan:=/front/scan stop:=/stop'"
            ),
            OpaqueFunction(function=start),
        ]
    )
