"""Starts courier_controller."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value="courier_controller", description="Name of the node"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node"),
            DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Whether /clock gives the time"),
            DeclareLaunchArgument(
                "period_ms", default_value="100", description="Milliseconds from one tick to the next"
            ),
            Node(
                package="courier_controller",
                executable="courier_controller",
                name=LaunchConfiguration("name"),
                namespace=LaunchConfiguration("namespace"),
                parameters=[
                    {
                        "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
                        "period_ms": ParameterValue(LaunchConfiguration("period_ms"), value_type=int),
                    }
                ],
                arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
                output="screen",
            ),
        ]
    )
