// Clocks that waiting is measured with, and a timer that runs once.
#ifndef ROBOSC_ROS2_COUNTDOWN_HPP_
#define ROBOSC_ROS2_COUNTDOWN_HPP_

#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// How often something that is waited for is looked at.
inline constexpr std::chrono::milliseconds kLook(20);

/// The steady clock; the time of ROS where `use_sim_time` is set.
template <typename Node>
rclcpp::Clock::SharedPtr waiting_clock(Node& node) {
  if (node.get_parameter("use_sim_time").as_bool()) return node.get_clock();
  return std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME);
}

/// Calls a function once, some time after each start: on the steady clock, or in ROS time with `use_sim_time`.
class Countdown {
 public:
  template <typename Node>
  Countdown(Node& node, const CallbackGuard& guard, std::chrono::milliseconds time, std::function<void()> over)
      : over_(std::move(over)) {
    const auto expire = guard([this] {
      stop();
      if (began_) {
        over_();
      } else {
        start();
      }
    });
    if (node.get_parameter("use_sim_time").as_bool()) {
      clock_ = node.get_clock();
      timer_ = rclcpp::create_timer(&node, node.get_clock(), time, expire);
    } else {
      timer_ = node.create_wall_timer(time, expire);
    }
    stop();
  }

  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;
  ~Countdown() { stop(); }

  /// Begins, or begins again, with the full time.
  void start() {
    began_ = !clock_ || clock_->started();
    timer_->reset();
  }
  void stop() { timer_->cancel(); }
  bool running() const { return !timer_->is_canceled(); }

 private:
  std::function<void()> over_;
  rclcpp::Clock::SharedPtr clock_;  ///< Of simulated time only.
  bool began_ = true;               ///< Its first message sets the clock to any time: until then none has passed.
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_COUNTDOWN_HPP_
