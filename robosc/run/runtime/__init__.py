"""The controller or supervisory layer as a running node, interpreted from its models without generated code.

`core` is independent of ROS: `Controller` and `Layer` turn messages into events and events into messages, one at a
time from an `EventLoop`. They reach the middleware through a port, which `ros2` implements with rclpy. `node` starts
them.
"""
