"""The node on ROS 1, with rospy and actionlib."""
