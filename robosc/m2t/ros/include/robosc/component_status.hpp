// The status of components on /diagnostics.
#ifndef ROBOSC_COMPONENT_STATUS_HPP_
#define ROBOSC_COMPONENT_STATUS_HPP_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "robosc/data.hpp"
#include "robosc/json.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A value as readable text, also for plots.
inline std::string plain_text(double value) {
  return std::isnan(value) ? "nan" : std::isinf(value) ? (value < 0 ? "-inf" : "inf") : to_json(value);
}
inline std::string plain_text(const std::string& value) { return value; }
inline std::string plain_text(const char* value) { return value; }
inline std::string plain_text(bool value) { return to_json(value); }
inline std::string plain_text(Integer value) { return to_json(value); }

/// Selects the ticks that a report follows: the first one, then one per `wanted` milliseconds. None if `wanted` is 0.
class ReportPace {
 public:
  void open(std::chrono::milliseconds wanted, std::chrono::milliseconds period) {
    every_ = wanted.count() == 0 ? 0 : std::max<std::chrono::milliseconds::rep>(1, wanted / period);
    passed_ = 0;
  }

  /// Counts a tick. Returns whether to report.
  bool due() {
    if (every_ == 0) return false;
    const bool due = passed_ == 0;
    passed_ = (passed_ + 1) % every_;
    return due;
  }

 private:
  std::chrono::milliseconds::rep every_ = 0;
  std::chrono::milliseconds::rep passed_ = 0;
};

/// Builder of a component's status. `Status` is the type of diagnostic_msgs in ROS 1 or ROS 2.
template <typename Status>
class ComponentStatus {
 public:
  ComponentStatus(const std::string& node, const char* robot, const char* component, const std::string& message) {
    status_.level = Status::OK;
    status_.name = node.substr(std::min(node.find_first_not_of('/'), node.size())) + ": " + component;
    status_.hardware_id = robot;
    status_.message = message;
  }

  template <typename Value>
  void add(const char* key, const Value& value) {
    status_.values.emplace_back();
    status_.values.back().key = key;
    status_.values.back().value = plain_text(value);
  }

  /// Adds a warning.
  void warn(const std::string& what) {
    if (status_.level == Status::OK) status_.level = Status::WARN;
    status_.message += "; " + what;
  }

  /// Adds an error.
  void fail(const std::string& what) {
    status_.level = Status::ERROR;
    status_.message += "; " + what;
  }

  const Status& made() const { return status_; }

 private:
  Status status_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_COMPONENT_STATUS_HPP_
