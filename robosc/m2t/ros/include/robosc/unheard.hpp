// Topics that must be heard before the first command.
#ifndef ROBOSC_UNHEARD_HPP_
#define ROBOSC_UNHEARD_HPP_

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The topics without a message yet.
class Unheard {
 public:
  Unheard() = default;
  explicit Unheard(std::vector<std::string> topics) : topics_(std::move(topics)) {}

  /// Records a message. Returns true for the first message of the last unheard topic.
  bool hear(const std::string& topic) {
    const auto found = std::find(topics_.begin(), topics_.end(), topic);
    if (found == topics_.end()) return false;
    topics_.erase(found);
    return topics_.empty();
  }

  bool empty() const { return topics_.empty(); }
  bool has(const std::string& topic) const { return std::count(topics_.begin(), topics_.end(), topic) > 0; }

  /// The names of the topics, separated by commas.
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
