"""Start usher_layer, and the controller behind it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

# Names that are remapped for a controller, to names below the layer's own. Actions are remapped by the names of their
# services and topics.
NAMES = [
    "/stop",
    "/resume",
    "battery",
    "/scan",
    "/speed",
    "label",
    "/lamp/light",
    "/go_to/_action/send_goal",
    "/go_to/_action/cancel_goal",
    "/go_to/_action/get_result",
    "/go_to/_action/feedback",
    "/go_to/_action/status",
]


def remappings(context):
    name, namespace = (LaunchConfiguration(argument).perform(context) for argument in ("name", "namespace"))
    # An including file may have pushed a namespace. It does not affect an absolute namespace.
    pushed = "" if namespace.startswith("/") else context.launch_configurations.get("ros_namespace", "")
    layer = "/".join(filter(None, (part.strip("/") for part in (pushed, namespace, name))))
    return [(topic, f"/{layer}/controller/{topic.lstrip('/')}") for topic in NAMES]


def start(context):
    clock = []
    if LaunchConfiguration("use_sim_time").perform(context):
        clock = [{"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)}]
    layer = Node(
        package="usher_layer",
        executable="usher_layer",
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        parameters=[*clock, {"event_log": ParameterValue(LaunchConfiguration("event_log"), value_type=str)}],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
        output="screen",
    )
    controller = Node(
        package="usher_driver",
        executable="driver.py",
        name="driver",
        parameters=clock,
        remappings=remappings(context),
        output="screen",
    )
    return [layer, controller]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value="usher_layer", description="Name of the layer's node"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the layer's node"),
            DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
            DeclareLaunchArgument(
                "use_sim_time", default_value="", description="Whether /clock gives the time; empty: as set elsewhere"
            ),
            DeclareLaunchArgument(
                "event_log", default_value="", description="A file that gets a line of JSON for each event"
            ),
            OpaqueFunction(function=start),
        ]
    )
