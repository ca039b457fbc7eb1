"""The controller, or the supervisory layer, as a running node straight from its models, without generating it.

`core` knows no ROS: `Controller` and `Layer` turn messages into events and events into messages, one at a time from an
`EventLoop`; what they want of the middleware goes through a port, which `ros1` and `ros2` implement with rospy and
rclpy. `node` starts them.
"""
