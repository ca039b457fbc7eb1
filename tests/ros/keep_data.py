"""Send data that a node stores, and write all messages of the node to a file, in their order for each topic.

python3 keep_data.py 1|2 FILE
"""

import json
import sys
import time
from pathlib import Path

from topics import connect, fill, type_of

PATIENCE = 120.0


class World:
    """Publisher of joints, poses and images, and listener to the resulting messages."""

    def __init__(self, version):
        self.heard = {"/again": [], "/twist": [], "/stamped": [], "/text": []}
        self.topics = connect(version, "world")
        self.listen("/again", "sensor_msgs/JointState", lambda m: [list(m.name), list(m.position), list(m.effort)])
        self.listen("/twist", "geometry_msgs/Twist", lambda m: [m.linear.x, m.linear.y, m.linear.z])
        self.listen("/stamped", "geometry_msgs/PoseStamped", lambda m: [m.pose.position.x, m.pose.orientation.w])
        self.listen("/text", "std_msgs/String", lambda m: m.data)
        self.unset = {"/seated": set(), "/turn": set()}
        self.topics.listen("/seated", "geometry_msgs/Pose", lambda m: self.unset["/seated"].add(m.orientation.w))
        self.topics.listen("/turn", "std_msgs/Float64", lambda m: self.unset["/turn"].add(m.data))
        self.joints = self.topics.publisher("/joints", "sensor_msgs/JointState")
        self.cloud = self.topics.publisher("/cloud", "geometry_msgs/PoseArray")
        self.image = self.topics.publisher("/image", "sensor_msgs/CompressedImage")

    def listen(self, topic, kind, read):
        self.topics.listen(topic, kind, lambda message: self.heard[topic].append(read(message)))

    def wait(self, topic, value):
        """Wait until a value is the last one on a topic."""
        until = time.monotonic() + PATIENCE
        while self.heard[topic][-1:] != [value]:
            if time.monotonic() > until:
                sys.exit(f"{topic}: not {value} within {PATIENCE} s, but {self.heard[topic]}")
            self.topics.receive(0.01)

    def start(self):
        """Wait until the node is connected in both directions on all topics, then clear the records."""
        until, number = time.monotonic() + PATIENCE, 0
        while not self.topics.heard() or not all([*self.heard.values(), *self.unset.values()]):
            if time.monotonic() > until:
                sys.exit(f"the node is not heard within {PATIENCE} s: {self.heard}")
            number = 1 - number
            self.joints(name=[f"n{number}", "", ""], position=[float(number), 0.0])
            self.poses((float(number), 0.0))
            self.topics.receive(0.1)
        self.joints(name=["ready", "", ""], position=[-1.0, -1.0])
        self.poses((7.0, 0.0))
        self.wait("/text", "ready")
        self.wait("/twist", [7.0, -1.0, 0.0])
        self.poses((7.0, 0.0))
        self.wait("/stamped", [7.0, 1.0])
        for heard in self.heard.values():
            heard.clear()

    def poses(self, *poses):
        made = [{"position": {"x": x}, "orientation": {"w": w}} for x, w in poses]
        self.cloud(poses=[fill(type_of("geometry_msgs/Pose")(), fields) for fields in made])

    def run(self):
        self.joints(name=["a", "b"], position=[])  # has no greatest number
        self.joints(name=["ab", "b", "c"], position=[1.5, -2.0, 9.0])
        self.wait("/twist", [7.0, -2.0, 0.0])
        self.joints(name=["ab", "lift", "lifts"], position=[5.0, -2.0])
        self.wait("/stamped", [7.0, 0.0])
        self.joints(name=["ab", "b", "c"], position=[5.0, 7.9])
        self.wait("/twist", [7.0, -2.0, 9.0])
        self.joints(name=["ab", "b", "c"], position=[0.5])  # the slice ends behind the array
        self.poses()  # has no last pose
        self.image(data=bytes([1, 2, 250]))
        self.poses((1.6, 0.5), (2.5, 0.25))
        self.wait("/stamped", [1.6, 0.5])
        self.wait("/twist", [3.0, -2.0, 9.0])
        self.joints(name=["ab", "b", "c", "d"], position=[1.0, float("nan")])
        self.wait("/twist", [3.0, -2.0, 12.0])
        self.joints(name=["last", "", ""], position=[0.25, 0.25])
        self.wait("/text", "last")
        self.wait("/twist", [3.0, 0.25, 12.0])
        self.wait("/again", [["last", "", ""], [0.5, 0.25], [0.25, 0.25]])
        self.poses((float("nan"), 0.5), (4.0, 0.125))  # the node cannot send this
        self.wait("/twist", [4.0, 0.25, 12.0])
        self.poses((2.0, 0.5), (4.0, 0.125))
        self.wait("/stamped", [2.0, 0.5])
        self.poses((2.5, float("inf")), (5.0, 0.125))
        self.wait("/twist", [5.0, 0.25, 12.0])
        self.poses((2.5, 0.25), (5.0, 0.125))
        self.wait("/stamped", [2.5, 0.25])


if __name__ == "__main__":
    world = World(sys.argv[1])
    world.start()
    world.run()
    Path(sys.argv[2]).write_text(json.dumps(world.heard | {name: list(seen) for name, seen in world.unset.items()}))
