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

/// Milliseconds between the beats of a node, in which its countdowns expire.
inline constexpr int kBeat = 10;
/// The same for a node without countdowns, which only looks at the ROS graph. Each beat costs as much as a message.
inline constexpr int kSlowBeat = 50;
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
/// It expires at a beat of the guard, and has no timer of its own. The events executor of Jazzy delays other timers
/// when one is reset or canceled, and may never call a timer that takes the place of a destroyed one.
class Countdown {
 public:
  template <typename Node>
  Countdown(Node& node, const CallbackGuard& guard, std::chrono::milliseconds time, std::function<void()> over)
      : Countdown(waiting_clock(node), guard, time, std::move(over)) {}
  /// The same on another clock.
  Countdown(rclcpp::Clock::SharedPtr clock, const CallbackGuard& guard, std::chrono::milliseconds time,
            std::function<void()> over)
      : over_(std::move(over)), time_(time), clock_(std::move(clock)), beat_(guard.at_each_beat([this] { look(); })) {}

  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;

  /// Starts or restarts with the full time.
  void start() { start(time_); }
  /// The same with another time.
  void start(std::chrono::nanoseconds time) {
    running_ = true;
    current_ = time;
    began_ = clock_->started();
    started_ = clock_->now().nanoseconds();
  }
  void stop() { running_ = false; }
  bool running() const { return running_; }

 private:
  void look() {
    if (!running_) return;
    const std::int64_t now = clock_->now().nanoseconds();
    // The first message starts a clock of simulated time. No time elapses before it, or when the clock jumps back.
    if (now < started_ || (!began_ && clock_->started())) return start(current_);
    if (!began_ || now - started_ < current_.count()) return;
    stop();
    over_();
  }

  std::function<void()> over_;
  std::chrono::nanoseconds time_;
  std::chrono::nanoseconds current_ = time_;
  rclcpp::Clock::SharedPtr clock_;
  bool running_ = false;
  bool began_ = true;
  std::int64_t started_ = 0;  ///< In nanoseconds.
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_COUNTDOWN_HPP_
