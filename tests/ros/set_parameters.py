"""Record the messages of a node with preset parameters, or set parameters while it runs, and write them to a file.

python3 set_parameters.py (1|2) FILE [--running]
"""

import json
import math
import sys
import time
from pathlib import Path

from topics import connect

if sys.argv[1:2] == ["2"]:  # Nodes of ROS 1 have no parameter services.
    from rcl_interfaces.srv import DescribeParameters, SetParameters
    from rclpy.parameter import Parameter

PATIENCE = 120.0
NODE = "/cruise_controller"


class World:
    """Publisher of ranges, listener to velocities, and client that sets parameters like `ros2 param set`."""

    def __init__(self, version):
        self.heard = []
        self.topics = connect(version, "world")
        self.topics.listen("/move", "std_msgs/Float32", lambda message: self.heard.append(round(message.data, 3)))
        self.lit = False
        self.topics.listen("/lamp", "std_msgs/Bool", lambda message: setattr(self, "lit", message.data))
        self.range = self.topics.publisher("/range", "std_msgs/Float32")
        if version == "2":
            self.setting = self.topics.node.create_client(SetParameters, f"{NODE}/set_parameters")
            self.describing = self.topics.node.create_client(DescribeParameters, f"{NODE}/describe_parameters")

    def wait_until(self, condition, what):
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                sys.exit(f"not within {PATIENCE} s: {what}; heard {self.heard[-5:]}")
            self.topics.receive(0.01)

    def call(self, client, request):
        future = client.call_async(request)
        self.wait_until(future.done, "the service answers")
        return future.result()

    def set(self, name, value):
        """Set one parameter; return the reason of a rejection, or None."""
        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        (result,) = self.call(self.setting, request).results
        return None if result.successful else result.reason

    def described(self, name):
        (found,) = self.call(self.describing, DescribeParameters.Request(names=[name])).descriptors
        bounds = [[bound.from_value, bound.to_value] for bound in (*found.floating_point_range, *found.integer_range)]
        return {"description": found.description, "read_only": found.read_only, "bounds": bounds}

    def expect(self, value):
        self.heard.clear()
        self.wait_until(lambda: self.heard[-1:] == [value], f"{value} on /move")

    def hear(self):
        self.expect(0.5)
        self.wait_until(lambda: self.lit, "the lamp is lit")
        return {"lit": self.lit}

    def run(self):
        self.wait_until(lambda: self.setting.service_is_ready() and self.topics.heard(), "the node is there")
        told = {name: self.described(name) for name in ("speed", "least", "reach", "Base.factor", "Lamp.pause")}
        self.expect(-0.2)
        refused = [self.set("speed", 1.5), self.set("speed", "fast"), self.set("reach", math.nan), self.set("least", 9)]
        self.expect(-0.2)
        taken = [self.set("speed", 0.5), self.set("Base.factor", 1.0)]
        self.expect(0.5)
        self.range(data=0.7)
        taken.append(self.set("reach", 1.0))
        self.range(data=0.7)  # near now: the node sends no velocity
        self.topics.receive(0.5)
        self.heard.clear()
        self.topics.receive(0.5)
        silent = list(self.heard)
        self.range(data=1.5)
        self.expect(0.5)
        lit = [self.lit]
        taken.append(self.set("Lamp.pause", 0.02))
        self.range(data=1.5)  # restarts the timer, which is short now
        self.wait_until(lambda: self.lit, "the lamp is lit")
        return {"lit": [*lit, self.lit], "told": told, "refused": refused, "taken": taken, "silent": silent}


if __name__ == "__main__":
    world = World(sys.argv[1])
    Path(sys.argv[2]).write_text(json.dumps(world.run() if "--running" in sys.argv else world.hear()))
