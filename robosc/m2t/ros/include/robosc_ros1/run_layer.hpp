// The program of a supervisory layer.
#ifndef ROBOSC_ROS1_RUN_LAYER_HPP_
#define ROBOSC_ROS1_RUN_LAYER_HPP_

#include <exception>
#include <string>

#include <ros/ros.h>

#include "robosc/version.hpp"
#include "robosc_ros1/parameters.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Runs a layer until ROS ends.
template <typename Layer>
int run_layer(int argc, char** argv, const std::string& name) {
  ros::init(argc, argv, name);
  try {
    const ros::NodeHandle own("~");  // with the last of them, ROS ends
    set_log_level(own);
    Layer layer;
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_RUN_LAYER_HPP_
