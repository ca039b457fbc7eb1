// Why something is blocked.
#ifndef ROBOSC_BLOCK_REASONS_HPP_
#define ROBOSC_BLOCK_REASONS_HPP_

#include <string>

#include "robosc/json.hpp"

namespace robosc {
inline namespace v1 {

/// The reasons for which something is blocked; the first of these kinds is told: another one is under way (busy),
/// requirements that fail, states without a transition for it, and else what synthesis prevents.
class BlockReasons {
 public:
  static BlockReasons busy() {
    BlockReasons reasons;
    reasons.busy_ = true;
    return reasons;
  }

  void add_requirement(const std::string& text) {
    requirements_.add(text);
    fails_ = true;
  }

  void add_state(const std::string& text) {
    states_.add(text);
    missing_ = true;
  }

  void add_consequence(const std::string& text) { consequences_.add(text); }

  const char* kind() const { return busy_ ? "busy" : fails_ ? "requirement" : missing_ ? "state" : "synthesis"; }

  /// The texts of that kind.
  const Json& texts() const { return fails_ ? requirements_ : missing_ ? states_ : consequences_; }

 private:
  bool busy_ = false;
  bool fails_ = false;
  bool missing_ = false;
  Json requirements_ = Json::array();
  Json states_ = Json::array();
  Json consequences_ = Json::array();
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_BLOCK_REASONS_HPP_
