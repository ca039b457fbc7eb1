// Clocks for timeouts, and a timer for one call.
#ifndef ROBOSC_ROS2_COUNTDOWN_HPP_
#define ROBOSC_ROS2_COUNTDOWN_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The interval between checks of a condition.
inline constexpr std::chrono::milliseconds kLook(20);

/// The steady clock, or the time of ROS if `use_sim_time` is set.
template <typename Node>
rclcpp::Clock::SharedPtr waiting_clock(Node& node) {
  if (node.get_parameter("use_sim_time").as_bool()) return node.get_clock();
  return std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME);
}

/// Calls a function once, a given time after each start: on the steady clock, or in ROS time with `use_sim_time`.
///
/// An events executor queues the calls of timers that have expired. Such a call may run after the countdown was stopped
/// or started again. Then it has no effect.
class Countdown {
 public:
  template <typename Node>
  Countdown(Node& node, const CallbackGuard& guard, std::chrono::milliseconds time, std::function<void()> over)
      : over_(std::move(over)), time_(time), clock_(waiting_clock(node)) {
    const auto expire = guard([this] {
      if (!running() || is_early()) return;
      stop();
      if (began_) {
        over_();
      } else {
        start();
      }
    });
    if (node.get_parameter("use_sim_time").as_bool()) {
      timer_ = rclcpp::create_timer(&node, clock_, time, expire);
    } else {
      timer_ = node.create_wall_timer(time, expire);
    }
    stop();
  }

  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;
  ~Countdown() { stop(); }

  /// Starts or restarts with the full time.
  void start() {
    began_ = clock_->started();
    started_ = clock_->now().nanoseconds();
    timer_->reset();
  }
  void stop() { timer_->cancel(); }
  bool running() const { return !timer_->is_canceled(); }

 private:
  /// Whether the time since the last start has not elapsed. After a backward jump of the clock, only the timer decides.
  bool is_early() const {
    const std::int64_t passed = clock_->now().nanoseconds() - started_;
    return passed >= 0 && passed < std::chrono::nanoseconds(time_).count();
  }

  std::function<void()> over_;
  std::chrono::milliseconds time_;
  rclcpp::Clock::SharedPtr clock_;
  std::int64_t started_ = 0;  ///< In nanoseconds.
  bool began_ = true;         ///< The first message starts a clock of simulated time. No time elapses before it.
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_COUNTDOWN_HPP_
