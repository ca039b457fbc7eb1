// Program of a controller.
#ifndef ROBOSC_ROS1_RUN_CONTROLLER_HPP_
#define ROBOSC_ROS1_RUN_CONTROLLER_HPP_

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

/// Runs a controller until it receives a request to end. One thread serves the one queue of all messages and calls. The
/// controller ends after the last delivery, while ROS still runs.
template <typename Controller>
int run_controller(int argc, char** argv, const std::string& name) {
  Interruption interruption;
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  Interruption::take_requests();
  const std::string master = "a master at " + ros::master::getURI();
  if (!interruption.wait_until([] { return ros::master::check(); }, master)) return 0;
  ros::CallbackQueue queue;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  if (!interruption.wait_until([] { return ros::Time::isValid(); }, "/clock")) return 0;
  try {
    set_log_level(ros::NodeHandle("~"));
    std::optional<Controller> controller(std::in_place, node);
    ros::AsyncSpinner spinner(1, &queue);
    spinner.start();
    interruption.wait();
    spinner.stop();
    controller->end([&queue] { queue.callAvailable(ros::WallDuration(0.05)); });
    controller.reset();
    interruption.let_go();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_RUN_CONTROLLER_HPP_
