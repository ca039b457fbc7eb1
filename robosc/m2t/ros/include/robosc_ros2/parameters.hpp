// Parameters with their meanings and ranges.
#ifndef ROBOSC_ROS2_PARAMETERS_HPP_
#define ROBOSC_ROS2_PARAMETERS_HPP_

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <rclcpp/rclcpp.hpp>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A parameter that keeps the value with which the node starts.
template <typename Value, typename Node>
Value parameter(Node& node, const std::string& name, const Value& value, const std::string& meaning) {
  if (node.has_parameter(name)) return node.get_parameter(name).template get_value<Value>();
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.description = meaning;
  descriptor.read_only = true;
  return node.template declare_parameter<Value>(name, value, descriptor);
}

/// The same for a whole number between two bounds. Other values are rejected.
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

/// A parameter of the model. It may be set while the node runs.
template <typename Value, typename Node>
Value model_parameter(
    Node& node, const std::string& name, const Value& value, const std::string& meaning,
    rcl_interfaces::msg::ParameterDescriptor descriptor = rcl_interfaces::msg::ParameterDescriptor()) {
  if (node.has_parameter(name)) return node.get_parameter(name).template get_value<Value>();
  descriptor.description = meaning;
  return node.template declare_parameter<Value>(name, value, descriptor);
}

/// The same for a number between two bounds. Other values are rejected.
template <typename Number, typename Node>
Number model_parameter(Node& node, const std::string& name, Number value, const std::string& meaning, Number low,
                       Number high) {
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  const auto bound = [&](auto& range) {
    range.resize(1);
    range[0].from_value = low;
    range[0].to_value = high;
  };
  if constexpr (std::is_floating_point_v<Number>) {
    bound(descriptor.floating_point_range);
  } else {
    bound(descriptor.integer_range);
  }
  return model_parameter<Number>(node, name, value, meaning, descriptor);
}

/// Whether the values may be set: each number is finite.
inline rcl_interfaces::msg::SetParametersResult accepted(const std::vector<rclcpp::Parameter>& given) {
  rcl_interfaces::msg::SetParametersResult result;
  result.successful = true;
  for (const rclcpp::Parameter& parameter : given) {
    if (parameter.get_type() != rclcpp::ParameterType::PARAMETER_DOUBLE || std::isfinite(parameter.as_double()))
      continue;
    result.successful = false;
    result.reason = parameter.get_name() + " is not finite";
  }
  return result;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_PARAMETERS_HPP_
