"""Operator of ROS 2 nodes: loads components, changes states of managed nodes, reads and sets parameters.

python3 manage_ros2.py load PACKAGE NAMESPACE EVENT_LOG | unload NUMBER | change NODE TRANSITION | describe NODE NAME...
    | give NODE NAME NUMBER

Prints the result as JSON. The container is `/ComponentManager`; transitions have the numbers of lifecycle_msgs.
"""

import json
import sys

import rclpy
from composition_interfaces.srv import LoadNode, UnloadNode
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, SetParameters

PATIENCE = 120.0


def call(kind, service, request):
    node = rclpy.create_node("operator")
    client = node.create_client(kind, service)
    if not client.wait_for_service(PATIENCE):
        raise TimeoutError(f"nobody offers {service}")
    answer = client.call_async(request)
    rclpy.spin_until_future_complete(node, answer, timeout_sec=PATIENCE)
    if not answer.done():
        raise TimeoutError(f"{service} does not answer")
    return answer.result()


def load(package, namespace, event_log):
    """Load a component; return its number in the container, its name, and the error."""
    text = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=event_log)
    request = LoadNode.Request(
        package_name=package,
        plugin_name=f"{package}::Controller",
        node_namespace=namespace,
        parameters=[Parameter(name="event_log", value=text)],
    )
    loaded = call(LoadNode, "/ComponentManager/_container/load_node", request)
    return {"number": loaded.unique_id, "name": loaded.full_node_name, "error": loaded.error_message}


def unload(number):
    request = UnloadNode.Request(unique_id=int(number))
    return call(UnloadNode, "/ComponentManager/_container/unload_node", request).success


def change(node, transition):
    request = ChangeState.Request()
    request.transition.id = int(transition)
    return call(ChangeState, f"{node}/change_state", request).success


def describe(node, *names):
    """Return the description and the range of each parameter."""
    found = call(DescribeParameters, f"{node}/describe_parameters", DescribeParameters.Request(names=names))
    return {
        descriptor.name: [
            descriptor.description,
            [[bounds.from_value, bounds.to_value] for bounds in descriptor.integer_range],
        ]
        for descriptor in found.descriptors
    }


def give(node, name, number):
    """Set a parameter; return whether the node accepts it."""
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=float(number))
    request = SetParameters.Request(parameters=[Parameter(name=name, value=value)])
    return call(SetParameters, f"{node}/set_parameters", request).results[0].successful


if __name__ == "__main__":
    rclpy.init()
    sys.stdout.write(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))
