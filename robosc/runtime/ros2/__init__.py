"""The node on ROS 2, with rclpy, and the tool that builds the modules of types without colcon."""
