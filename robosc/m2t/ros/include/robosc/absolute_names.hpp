// Names outside of a node's namespace.
#ifndef ROBOSC_ABSOLUTE_NAMES_HPP_
#define ROBOSC_ABSOLUTE_NAMES_HPP_

#include <string>
#include <utility>
#include <vector>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The names that a node's namespace does not contain, as a text. Each has its name in the ROS graph beside it. Empty
/// for a node without a namespace.
inline std::string names_outside(const std::string& space,
                                 const std::vector<std::pair<std::string, std::string>>& names) {
  std::string outside;
  if (space.empty() || space == "/") return outside;
  for (const auto& [name, resolved] : names) {
    if (resolved.rfind(space + "/", 0) == 0) continue;
    outside += (outside.empty() ? "" : ", ") + name;
  }
  return outside;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ABSOLUTE_NAMES_HPP_
