"""Controller and layer without any ROS: what becomes of messages, when, and what is sent."""
