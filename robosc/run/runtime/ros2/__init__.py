"""Node on ROS 2 with rclpy, and the builder of Python modules for ROS types without colcon."""
