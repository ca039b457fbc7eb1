// Received messages that were not handled yet.
#ifndef ROBOSC_ROS2_ARRIVALS_HPP_
#define ROBOSC_ROS2_ARRIVALS_HPP_

#include <rclcpp/rclcpp.hpp>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Handles received messages before an expired timer. Necessary because an executor checks timers first.
template <typename Message, typename Handle>
void hear_all(rclcpp::Subscription<Message>& subscription, Handle handle) {
  Message message;
  rclcpp::MessageInfo info;
  for (int left = 1000; left > 0 && subscription.take(message, info); --left) handle(message);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ARRIVALS_HPP_
