// What each node of ROS 1 includes, whatever its model.
#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <std_msgs/String.h>
