// Reports on the state of a node.
#ifndef ROBOSC_TRANSITIONS_HPP_
#define ROBOSC_TRANSITIONS_HPP_

#include <cstddef>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "robosc/json.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// `TRANSITIONS_KEPT` of robosc/model/semantics/definition.py.
inline constexpr std::size_t kTransitionsKept = 5000;

/// The events since the last report on the state. With stopped simulated time or a long period, many events precede a
/// report. Then only the last ones are kept.
class Transitions {
 public:
  /// `event`: a name that outlives this object.
  void add(const char* event) {
    events_.push_back(event);
    if (events_.size() > kTransitionsKept) events_.pop_front();
  }

  bool empty() const { return events_.empty(); }
  void clear() { events_.clear(); }

  /// The state and the events that led to it.
  std::string report(const char* robot, double time, const Json& components) const {
    return to_json(reported(robot, time, components));
  }

  /// The same, with the violated assumptions.
  std::string report(const char* robot, double time, const Json& components,
                     const std::vector<std::string>& violated) const {
    Json names = Json::array();
    for (const std::string& name : violated) names.add(name);
    return to_json(reported(robot, time, components).add("violated", names));
  }

 private:
  Json reported(const char* robot, double time, const Json& components) const {
    Json transitions = Json::array();
    for (const char* event : events_) transitions.add(event);
    return Json::object()
        .add("robot", robot)
        .add("time", time)
        .add("components", components)
        .add("transitions", transitions);
  }

  std::deque<const char*> events_;
};

/// The listeners to a report.
class Audience {
 public:
  /// Whether to publish: after each change, and for each new listener.
  bool waits(std::size_t listeners, bool changed) {
    const bool more = listeners > std::exchange(listeners_, listeners);
    return more || (listeners > 0 && changed);
  }

 private:
  std::size_t listeners_ = 0;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_TRANSITIONS_HPP_
