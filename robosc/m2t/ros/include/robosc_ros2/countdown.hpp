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

/// Creates timers on the steady clock or, with `use_sim_time`, in the time of ROS.
///
/// Never reset or cancel a timer. Some executors sort their timers only when one is added or has expired. After a
/// reset, they call the others late or never. Some queue the calls of expired timers: a call may follow a cancel. So a
/// timer is dropped instead, and its callback checks whether it is due.
template <typename Node>
std::function<rclcpp::TimerBase::SharedPtr(std::chrono::nanoseconds)> timer_factory(Node& node,
                                                                                    std::function<void()> call) {
  const rclcpp::Clock::SharedPtr clock = waiting_clock(node);
  const bool simulated = clock == node.get_clock();
  return [&node, clock, simulated, call = std::move(call)](std::chrono::nanoseconds period) {
    if (simulated) return rclcpp::TimerBase::SharedPtr(rclcpp::create_timer(&node, clock, period, call));
    return rclcpp::TimerBase::SharedPtr(node.create_wall_timer(period, call));
  };
}

/// Calls a function once, a given time after each start: on the steady clock, or in ROS time with `use_sim_time`.
///
/// A timer that expires before the countdown is due is replaced by one for the rest of the time.
class Countdown {
 public:
  template <typename Node>
  Countdown(Node& node, const CallbackGuard& guard, std::chrono::milliseconds time, std::function<void()> over)
      : over_(std::move(over)),
        time_(time),
        clock_(waiting_clock(node)),
        make_timer_(timer_factory(node, guard([this] { look(); }))) {}

  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;

  /// Starts or restarts with the full time.
  void start() {
    running_ = true;
    began_ = clock_->started();
    started_ = clock_->now().nanoseconds();
    if (!timer_) wait(time_);
  }
  void stop() { running_ = false; }
  bool running() const { return running_; }

 private:
  void wait(std::chrono::nanoseconds time) {
    waited_ = time;
    timer_ = make_timer_(time);
  }

  void look() {
    timer_.reset();
    if (!running_) return;
    const std::int64_t now = clock_->now().nanoseconds();
    if (now < started_) started_ = now - waited_.count();  // The clock has jumped back. The timer has expired since.
    const std::chrono::nanoseconds left = time_ - std::chrono::nanoseconds(now - started_);
    if (left.count() > 0) return wait(left);
    stop();
    if (began_) {
      over_();
    } else {
      start();
    }
  }

  std::function<void()> over_;
  std::chrono::nanoseconds time_;
  rclcpp::Clock::SharedPtr clock_;
  std::function<rclcpp::TimerBase::SharedPtr(std::chrono::nanoseconds)> make_timer_;
  bool running_ = false;
  bool began_ = true;                        ///< The first message starts a clock of simulated time.
  std::int64_t started_ = 0;                 ///< In nanoseconds.
  std::chrono::nanoseconds waited_ = time_;  ///< The time of the last timer.
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_COUNTDOWN_HPP_
