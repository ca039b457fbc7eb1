// Parameters with their meaning and their range.
#ifndef ROBOSC_ROS2_PARAMETERS_HPP_
#define ROBOSC_ROS2_PARAMETERS_HPP_

#include <cstdint>
#include <string>

#include <rclcpp/rclcpp.hpp>

namespace robosc {
inline namespace v1 {

/// A parameter that keeps the value with which the node starts.
template <typename Value, typename Node>
Value parameter(Node& node, const std::string& name, const Value& value, const std::string& meaning) {
  if (node.has_parameter(name)) return node.get_parameter(name).template get_value<Value>();
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.description = meaning;
  descriptor.read_only = true;
  return node.template declare_parameter<Value>(name, value, descriptor);
}

/// The same for a whole number between two bounds; another value is refused.
template <typename Node>
int parameter(Node& node, const std::string& name, int value, int low, int high, const std::string& meaning) {
  if (node.has_parameter(name)) return static_cast<int>(node.get_parameter(name).as_int());
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.description = meaning;
  descriptor.read_only = true;
  descriptor.integer_range.resize(1);
  descriptor.integer_range[0].from_value = low;
  descriptor.integer_range[0].to_value = high;
  descriptor.integer_range[0].step = 1;
  return static_cast<int>(node.template declare_parameter<std::int64_t>(name, value, descriptor));
}

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS2_PARAMETERS_HPP_
