"""Load two controllers into one component container of ROS 2. The topics of the second one begin with /second.

python3 load_two.py PACKAGE
"""

import sys

import rclpy
from composition_interfaces.srv import LoadNode

TOPICS = ["light", "travel_order", "scan", "charge", "pulse", "stop", "continue", "cmd_vel", "lamp", "travel", "bumper"]


def main(package):
    rclpy.init()
    node = rclpy.create_node("loader")
    client = node.create_client(LoadNode, "/ComponentManager/_container/load_node")
    assert client.wait_for_service(timeout_sec=20)
    for name, remapped in {"first": "", "second": "/second"}.items():
        request = LoadNode.Request(package_name=package, plugin_name=f"{package}::Controller", node_name=name)
        request.remap_rules = [f"/{topic}:={remapped}/{topic}" for topic in TOPICS] if remapped else []
        future = client.call_async(request)
        rclpy.spin_until_future_complete(node, future, timeout_sec=20)
        assert future.result().success, future.result().error_message


if __name__ == "__main__":
    main(*sys.argv[1:])
