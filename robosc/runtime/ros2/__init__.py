"""The node and the layer on ROS 2."""
