"""Starts managed_porter."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition

PACKAGE = "managed_porter"
NAME = "managed_porter"


def start(context):
    """The node; its remappings are one text until here."""
    remappings = LaunchConfiguration("remappings").perform(context).split()
    parameters = [LaunchConfiguration("params_file")]
    if LaunchConfiguration("use_sim_time").perform(context):
        parameters.append({"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)})
    node = LifecycleNode(
        package=PACKAGE,
        executable=NAME,
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        parameters=parameters,
        remappings=[tuple(remapping.split(":=", 1)) for remapping in remappings],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
        output="screen",
    )
    if LaunchConfiguration("autostart").perform(context).lower() != "true":
        return [node]
    configure = ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=Transition.TRANSITION_CONFIGURE)
    activate = ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=Transition.TRANSITION_ACTIVATE)
    configured = OnStateTransition(
        target_lifecycle_node=node,
        start_state="configuring",
        goal_state="inactive",
        entities=[EmitEvent(event=activate)],
        handle_once=True,  # later it is somebody else who configures it
    )
    return [RegisterEventHandler(configured), node, EmitEvent(event=configure)]


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
            DeclareLaunchArgument(
                "autostart", default_value="true", description="Whether the node is configured and activated at once"
            ),
            OpaqueFunction(function=start),
        ]
    )
