"""Load components into the container `/ComponentManager` and unload them, while it receives many messages.

python3 churn_ros2.py ROUNDS

Each round loads and unloads a controller, two managed nodes that are activated (one of them with times), and a layer.
Prints the number of unloaded components.
"""

import sys
import threading

import rclpy
from composition_interfaces.srv import LoadNode, UnloadNode
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from std_msgs.msg import Bool, Empty, Float64MultiArray, Int32

PATIENCE = 120.0
MANAGED = ["managed_porter", "managed_watch"]
COMPONENTS = [*((name, "Controller") for name in ["scout_controller", *MANAGED]), ("usher_layer", "Layer")]
RAIN = [("/pulse", Int32), ("/light", Bool), ("/stop", Empty), ("/resume", Empty), ("/errand", Float64MultiArray)]


class Operator:
    """Client that sends a request and waits for the answer."""

    def __init__(self):
        self.node = rclpy.create_node("operator")
        manager = "/ComponentManager/_container"
        self.loading = self.node.create_client(LoadNode, f"{manager}/load_node")
        self.unloading = self.node.create_client(UnloadNode, f"{manager}/unload_node")
        self.changing = [self.node.create_client(ChangeState, f"/{name}/change_state") for name in MANAGED]

    def ask(self, client, request):
        if not client.wait_for_service(PATIENCE):
            raise TimeoutError(f"nobody offers {client.srv_name}")
        answer = client.call_async(request)
        rclpy.spin_until_future_complete(self.node, answer, timeout_sec=PATIENCE)
        if not answer.done():
            raise TimeoutError(f"{client.srv_name} does not answer")
        return answer.result()

    def load(self, package, plugin):
        fast = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=1)
        short = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.02)
        parameters = [Parameter(name="period_ms", value=fast), Parameter(name="pause", value=short)]
        request = LoadNode.Request(package_name=package, plugin_name=f"{package}::{plugin}", parameters=parameters)
        loaded = self.ask(self.loading, request)
        assert loaded.success, loaded.error_message
        return loaded.unique_id

    def unload(self, number):
        unloaded = self.ask(self.unloading, UnloadNode.Request(unique_id=number))
        assert unloaded.success, unloaded.error_message


def rain(node, ended):
    publishers = [(node.create_publisher(kind, topic, 10), kind()) for topic, kind in RAIN]
    while not ended.wait(0.001):
        for publisher, message in publishers:
            publisher.publish(message)


if __name__ == "__main__":
    rclpy.init()
    operator, ended, unloaded = Operator(), threading.Event(), 0
    weather = threading.Thread(target=rain, args=[rclpy.create_node("weather"), ended])
    weather.start()
    try:
        for _ in range(int(sys.argv[1])):
            numbers = [operator.load(package, plugin) for package, plugin in COMPONENTS]
            for changing in operator.changing:
                for transition in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
                    request = ChangeState.Request(transition=Transition(id=transition))
                    assert operator.ask(changing, request).success
            for number in numbers:
                operator.unload(number)
                unloaded += 1
    finally:
        ended.set()
        weather.join()
    sys.stdout.write(str(unloaded))
