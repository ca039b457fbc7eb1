// What a message says where the model says nothing.
#ifndef ROBOSC_ROS2_DEFAULTS_HPP_
#define ROBOSC_ROS2_DEFAULTS_HPP_

#include <string>
#include <type_traits>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Message, typename = void>
struct has_header : std::false_type {};
template <typename Message>
struct has_header<Message, std::void_t<decltype(std::declval<Message&>().header.stamp)>> : std::true_type {};

template <typename Part>
void set_header([[maybe_unused]] const rclcpp::Time& time, [[maybe_unused]] const std::string& frame,
                [[maybe_unused]] Part& part) {
  if constexpr (has_header<Part>::value) {
    part.header.stamp = time;
    part.header.frame_id = frame;
  }
}

/// Gives the headers of parts of a message, where they have one, the time and the frame.
template <typename Message, typename... Parts>
void set_defaults(Message&, const rclcpp::Time& time, const std::string& frame, Parts&... parts) {
  (set_header(time, frame, parts), ...);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_DEFAULTS_HPP_
