// The program of a supervisory layer.
#ifndef ROBOSC_ROS1_RUN_LAYER_HPP_
#define ROBOSC_ROS1_RUN_LAYER_HPP_

#include <exception>
#include <optional>
#include <string>
#include <utility>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "robosc/version.hpp"
#include "robosc_ros1/interruption.hpp"
#include "robosc_ros1/parameters.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Runs a layer until it is asked to end, and until it is known what becomes of goals that it cancels, not for long.
template <typename Layer>
int run_layer(int argc, char** argv, const std::string& name) {
  Interruption interruption;
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  Interruption::take_requests();
  const std::string master = "a master at " + ros::master::getURI();
  if (!interruption.wait_until([] { return ros::master::check(); }, master)) return 0;
  try {
    const ros::NodeHandle own("~");  // with the last of them, ROS ends
    set_log_level(own);
    std::optional<Layer> layer(std::in_place);
    ros::AsyncSpinner spinner(1);
    spinner.start();
    interruption.wait();
    spinner.stop();
    const ros::SteadyTime until = ros::SteadyTime::now() + ros::WallDuration(kLongestEnd);
    while (layer->waits() && ros::SteadyTime::now() < until) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    }
    layer->leave();
    ros::shutdown();  // callers that still wait for an answer
    layer.reset();
    interruption.let_go();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_RUN_LAYER_HPP_
