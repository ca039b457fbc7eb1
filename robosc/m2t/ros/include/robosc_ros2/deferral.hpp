// Functions to run after the current callback.
#ifndef ROBOSC_ROS2_DEFERRAL_HPP_
#define ROBOSC_ROS2_DEFERRAL_HPP_

#include <chrono>
#include <functional>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Runs a function in a callback of its own, once after each request.
class Deferral {
 public:
  template <typename Node>
  Deferral(Node& node, const CallbackGuard& guard, std::function<void()> function) {
    const auto run = [this, function = std::move(function)] {
      if (timer_->is_canceled()) return;  // An events executor had this call in its queue.
      timer_->cancel();
      function();
    };
    // On the wall clock, as time may stand still in a simulation.
    timer_ = node.create_wall_timer(std::chrono::milliseconds(1), guard(run));
    timer_->cancel();
  }

  Deferral(const Deferral&) = delete;
  Deferral& operator=(const Deferral&) = delete;
  ~Deferral() { timer_->cancel(); }

  void request() { timer_->reset(); }

 private:
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_DEFERRAL_HPP_
