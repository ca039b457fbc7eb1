"""The supervisory layer (thesis section 4.7): what its targets for ROS 1 and ROS 2 share."""
