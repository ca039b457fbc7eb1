// The clock that waiting is measured with.
#ifndef ROBOSC_ROS2_CLOCK_HPP_
#define ROBOSC_ROS2_CLOCK_HPP_

#include <chrono>
#include <memory>

#include <rclcpp/rclcpp.hpp>

namespace robosc {
inline namespace v1 {

/// How often something that is waited for is looked at.
inline constexpr std::chrono::milliseconds kLook(20);

/// The steady clock; the time of ROS where `use_sim_time` is set.
inline rclcpp::Clock::SharedPtr waiting_clock(rclcpp::Node& node) {
  if (node.get_parameter("use_sim_time").as_bool()) return node.get_clock();
  return std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME);
}

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS2_CLOCK_HPP_
