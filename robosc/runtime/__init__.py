"""The controller, or the supervisory layer, as a running node straight from its models, without generating it.

`core` knows no ROS: `Controller` and `Layer` turn messages into events and events into messages, one at a time from an
`EventLoop`. They reach the middleware through a port, which `ros2` implements with rclpy. `node` starts them.
"""
