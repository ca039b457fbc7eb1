"""The controller as a running node, straight from its models: a core without ROS, and an adapter for each ROS.

`Controller` and `Layer` decide what happens; all that they want of the world outside goes through a `Port`, and all
that happens to them comes one at a time from an `Agenda`. `ros1` and `ros2` implement the port with rospy and rclpy.
"""
