"""The node on ROS 1, with rospy and actionlib."""

#: Where Debian has the Python of ROS 1; appended, so that nothing of this Python's own is hidden.
DEBIAN = "/usr/lib/python3/dist-packages"
