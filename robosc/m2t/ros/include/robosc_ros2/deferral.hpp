// Functions to run after the current callback.
#ifndef ROBOSC_ROS2_DEFERRAL_HPP_
#define ROBOSC_ROS2_DEFERRAL_HPP_

#include <functional>
#include <utility>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Runs a function in a callback of its own, once after each request: at the next beat of the guard.
class Deferral {
 public:
  Deferral(const CallbackGuard& guard, std::function<void()> function)
      : function_(std::move(function)), beat_(guard.at_each_beat([this] { look(); })) {}

  Deferral(const Deferral&) = delete;
  Deferral& operator=(const Deferral&) = delete;

  void request() { is_due_ = true; }

 private:
  void look() {
    if (!is_due_) return;
    is_due_ = false;
    function_();
  }

  std::function<void()> function_;
  bool is_due_ = false;
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_DEFERRAL_HPP_
