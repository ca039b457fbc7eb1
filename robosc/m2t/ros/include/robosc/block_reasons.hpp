// The causes of a blocked command.
#ifndef ROBOSC_BLOCK_REASONS_HPP_
#define ROBOSC_BLOCK_REASONS_HPP_

#include <string>
#include <vector>

#include "robosc/json.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The causes of a blocked command. Only the first kind that has any is reported: another execution that has not ended
/// (busy), violated assumptions, data that cannot be sent, failed requirements, states without a transition for the
/// command, or else consequences that synthesis prevents.
class BlockReasons {
 public:
  static BlockReasons busy() {
    BlockReasons reasons;
    reasons.busy_ = true;
    return reasons;
  }

  static BlockReasons violated(const std::vector<std::string>& assumptions) {
    BlockReasons reasons;
    reasons.assumptions_ = assumptions;
    return reasons;
  }

  static BlockReasons unsendable(const std::string& why) {
    BlockReasons reasons;
    reasons.data_ = {why};
    return reasons;
  }

  void add_requirement(const std::string& text) { requirements_.push_back(text); }

  void add_state(const std::string& text) { states_.push_back(text); }

  void add_consequence(const std::string& text) { consequences_.push_back(text); }

  const char* kind() const {
    if (!assumptions_.empty()) return "assumption";
    if (!data_.empty()) return "data";
    return busy_ ? "busy" : !requirements_.empty() ? "requirement" : !states_.empty() ? "state" : "synthesis";
  }

  /// The texts of the reported kind.
  Json texts() const {
    Json list = Json::array();
    for (const std::string& text : told()) list.add(text);
    return list;
  }

  /// The report on a blocked event.
  std::string report(const char* robot, double time, const char* name, const char* event,
                     const Json& components) const {
    return to_json(Json::object()
                       .add("robot", robot)
                       .add("time", time)
                       .add("name", name)
                       .add("event", event)
                       .add("reason", kind())
                       .add("because", texts())
                       .add("components", components));
  }

  /// All reported texts in one sentence.
  std::string sentence() const {
    const bool possible = states_.empty() || !requirements_.empty();
    std::string said = !possible ? "not possible" : requirements_.empty() ? "forbidden by synthesis" : "forbidden";
    const char* joint = possible ? ": " : " in ";
    for (const std::string& text : told()) {
      said += joint + text;
      joint = possible ? "; " : ", ";
    }
    return said;
  }

 private:
  const std::vector<std::string>& told() const {
    if (!assumptions_.empty()) return assumptions_;
    if (!data_.empty()) return data_;
    return !requirements_.empty() ? requirements_ : !states_.empty() ? states_ : consequences_;
  }

  bool busy_ = false;
  std::vector<std::string> assumptions_;
  std::vector<std::string> data_;
  std::vector<std::string> requirements_;
  std::vector<std::string> states_;
  std::vector<std::string> consequences_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_BLOCK_REASONS_HPP_
