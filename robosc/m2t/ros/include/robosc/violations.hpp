// Violations of the model's assumptions about the robot.
#ifndef ROBOSC_VIOLATIONS_HPP_
#define ROBOSC_VIOLATIONS_HPP_

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "robosc/throttle.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The assumptions that the robot has violated since the start, in the order of their first violation.
template <typename Event>
class Violations {
 public:
  /// Adds a violation by an event of a component. `name`: the name of the assumption, or its text if it has none.
  void add(const std::string& component, const std::string& name, const std::string& text) {
    add_once(names_, name);
    add_once(texts_, text);
    add_once(by_component_[component], name);
  }

  /// Whether to log a violation by this event now.
  bool due(const Event& event) { return throttle_.due(event); }

  bool empty() const { return names_.empty(); }

  /// Returns whether to stop the robot now. The answer is positive once, after the first violation.
  bool take_halt() { return !empty() && !std::exchange(halted_, true); }

  /// Whether there are more assumptions than at the last call.
  bool changed() { return std::exchange(reported_, names_.size()) < names_.size(); }

  const std::vector<std::string>& texts() const { return texts_; }

  const std::vector<std::string>& names() const { return names_; }

  /// The names of the assumptions that events of a component have violated.
  std::vector<std::string> of(const std::string& component) const {
    const auto violated = by_component_.find(component);
    return violated == by_component_.end() ? std::vector<std::string>() : violated->second;
  }

 private:
  static void add_once(std::vector<std::string>& list, const std::string& text) {
    if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
  }

  std::vector<std::string> names_;
  std::vector<std::string> texts_;
  std::map<std::string, std::vector<std::string>> by_component_;
  Throttle<Event> throttle_;
  std::size_t reported_ = 0;
  bool halted_ = false;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_VIOLATIONS_HPP_
