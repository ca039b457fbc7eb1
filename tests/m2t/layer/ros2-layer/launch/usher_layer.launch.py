"""Start usher_layer, and the controller behind it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue

PACKAGE = "usher_layer"
NAME = "usher_layer"
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


def is_true(context, argument):
    return LaunchConfiguration(argument).perform(context).lower() in ("true", "1")


def full_name(context, name):
    """Return a name in the namespace of the node. An including file may have pushed one around it."""
    namespace = LaunchConfiguration("namespace").perform(context)
    outer = "" if namespace.startswith("/") else context.launch_configurations.get("ros_namespace", "")
    return "/" + "/".join(filter(None, (part.strip("/") for part in (outer, namespace, name))))


def parameters(context):
    values = []
    if LaunchConfiguration("use_sim_time").perform(context):
        values.append({"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)})
    values.append({"event_log": ParameterValue(LaunchConfiguration("event_log"), value_type=str)})
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
            composable_node_descriptions=[ComposableNode(plugin=f"{NAME}::Layer", **settings)],
        )
    return Node(
        executable=NAME,
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
        output="screen",
        respawn=is_true(context, "use_respawn"),
        respawn_delay=2.0,
        **settings,
    )


def controller_remappings(context):
    layer = full_name(context, LaunchConfiguration("name").perform(context))
    return [(name, f"{layer}/controller/{name.lstrip('/')}") for name in NAMES]


def start(context):
    layer = node(context)
    clock = []
    if LaunchConfiguration("use_sim_time").perform(context):
        clock = [{"use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)}]
    controller = Node(
        package="usher_driver",
        executable="driver.py",
        name="driver",
        parameters=clock,
        remappings=controller_remappings(context),
        output="screen",
    )
    return [layer, controller]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value=NAME, description="Name of the node"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node"),
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
            DeclareLaunchArgument(
                "event_log", default_value="", description="A file that gets a line of JSON for each event"
            ),
            OpaqueFunction(function=start),
        ]
    )
