// Parameters with their types and ranges.
#ifndef ROBOSC_ROS1_PARAMETERS_HPP_
#define ROBOSC_ROS1_PARAMETERS_HPP_

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <ros/console.h>
#include <ros/node_handle.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The value of a parameter, or `value` if it is not set. Throws std::invalid_argument for another type. The last
/// argument documents its meaning in the code.
template <typename Value>
Value parameter(const ros::NodeHandle& node, const std::string& name, const Value& value, const char* = "") {
  Value found = value;
  if (node.getParam(name, found) || !node.hasParam(name)) return found;
  const char* type = std::is_same_v<Value, bool>     ? "true or false"
                     : std::is_same_v<Value, int>    ? "a whole number"
                     : std::is_same_v<Value, double> ? "a number"
                                                     : "a text";
  throw std::invalid_argument("the parameter " + node.resolveName(name) + " must be " + type);
}

/// The same for a whole number between two bounds.
inline int parameter(const ros::NodeHandle& node, const std::string& name, int value, int low, int high,
                     const char* = "") {
  const int found = parameter(node, name, value);
  if (found >= low && found <= high) return found;
  throw std::invalid_argument("the parameter " + node.resolveName(name) + " is " + std::to_string(found) +
                              ", not between " + std::to_string(low) + " and " + std::to_string(high));
}

/// A parameter of the model. It keeps the value with which the node starts. Throws std::invalid_argument for another
/// type or a value that is not finite.
template <typename Value>
Value model_parameter(const ros::NodeHandle& node, const std::string& name, const Value& value, const char* meaning) {
  const Value found = parameter(node, name, value, meaning);
  if constexpr (std::is_same_v<Value, double>) {
    if (!std::isfinite(found)) {
      throw std::invalid_argument("the parameter " + node.resolveName(name) + " is not finite");
    }
  }
  return found;
}

/// The same for a number between two bounds.
template <typename Number>
Number model_parameter(const ros::NodeHandle& node, const std::string& name, Number value, const char* meaning,
                       Number low, Number high) {
  const Number found = model_parameter(node, name, value, meaning);
  if (found >= low && found <= high) return found;
  throw std::invalid_argument("the parameter " + node.resolveName(name) + " is " + std::to_string(found) +
                              ", not between " + std::to_string(low) + " and " + std::to_string(high));
}

/// Sets the verbosity of the node to the value of the parameter `log_level`.
inline void set_log_level(const ros::NodeHandle& node) {
  const std::string wanted = parameter<std::string>(node, "log_level", "");
  if (wanted.empty()) return;
  const char* const names[] = {"debug", "info", "warn", "error", "fatal"};
  for (std::size_t level = 0; level < std::size(names); ++level) {
    if (wanted != names[level]) continue;
    if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, static_cast<ros::console::Level>(level))) {
      ros::console::notifyLoggerLevelsChanged();
    }
    return;
  }
  throw std::invalid_argument("the parameter " + node.resolveName("log_level") + " is " + wanted +
                              ", not debug, info, warn, error or fatal");
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_PARAMETERS_HPP_
