// The topics that commands wait for.
#ifndef ROBOSC_UNHEARD_HPP_
#define ROBOSC_UNHEARD_HPP_

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Topics that were not heard yet.
class Unheard {
 public:
  Unheard() = default;
  explicit Unheard(std::vector<std::string> topics) : topics_(std::move(topics)) {}

  /// A message came. True: it was the last topic that was not heard.
  bool hear(const std::string& topic) {
    const auto found = std::find(topics_.begin(), topics_.end(), topic);
    if (found == topics_.end()) return false;
    topics_.erase(found);
    return topics_.empty();
  }

  bool empty() const { return topics_.empty(); }
  bool has(const std::string& topic) const { return std::count(topics_.begin(), topics_.end(), topic) > 0; }

  /// Their names, with commas between them.
  std::string names() const {
    std::string names;
    for (const std::string& topic : topics_) names += (names.empty() ? "" : ", ") + topic;
    return names;
  }

 private:
  std::vector<std::string> topics_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_UNHEARD_HPP_
