"""The C++ of a ROS node: what its targets for ROS 1 and ROS 2 share."""
