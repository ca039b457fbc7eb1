"""The controller and the simulated robot: ros2 launch follower_robot drive.launch.py speed:=4."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, SetLaunchConfiguration, Shutdown
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the nodes and their launch arguments."""
    controller = PathJoinSubstitution(
        [FindPackageShare("follower_robot"), "launch", "person_follower_controller.launch.py"]
    )
    world = ["--scenario", "person_follower", "--ros", "2", "--speed", LaunchConfiguration("speed")]
    return LaunchDescription(
        [
            DeclareLaunchArgument("speed", default_value="1", description="How many times as fast as real time"),
            DeclareLaunchArgument("record", default_value="", description="A file for what the robot sees"),
            SetLaunchConfiguration("use_sim_time", "true"),
            IncludeLaunchDescription(PythonLaunchDescriptionSource(controller)),
            Node(
                package="simulated_robot",
                executable="simulate",
                arguments=[*world, "--record", LaunchConfiguration("record")],
                output="screen",
                on_exit=Shutdown(),
            ),
        ]
    )
