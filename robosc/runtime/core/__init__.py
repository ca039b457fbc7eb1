"""The node without any ROS: what becomes of messages, when, and what goes out."""
