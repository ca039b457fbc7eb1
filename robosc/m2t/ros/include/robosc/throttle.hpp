// A limit on the rate of reports.
#ifndef ROBOSC_THROTTLE_HPP_
#define ROBOSC_THROTTLE_HPP_

#include <chrono>
#include <map>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Passes one report of each kind in five seconds of the steady clock.
template <typename Kind>
class Throttle {
 public:
  /// Whether a report of this kind may pass now.
  bool due(const Kind& kind) {
    const auto now = std::chrono::steady_clock::now();
    const auto last = last_.find(kind);
    if (last != last_.end() && now - last->second < std::chrono::seconds(5)) return false;
    last_.insert_or_assign(kind, now);
    return true;
  }

 private:
  std::map<Kind, std::chrono::steady_clock::time_point> last_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_THROTTLE_HPP_
