// Wakes a node when the next time of its model is up.
#ifndef ROBOSC_ROS2_ALARM_HPP_
#define ROBOSC_ROS2_ALARM_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A clock and one timer on it, which calls a function: the steady clock or, with `use_sim_time`, the time of ROS.
class Alarm {
 public:
  template <typename Node>
  Alarm(Node& node, const CallbackGuard& guard, std::function<void()> ring)
      : ring_(std::move(ring)),
        simulated_(node.get_parameter("use_sim_time").as_bool()),
        clock_(simulated_ ? node.get_clock() : std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME)),
        late_(simulated_ && !clock_->started()) {
    const auto call = guard([this] {
      cancel();
      ring_();
    });
    plan_ = [&node, call, this](std::chrono::nanoseconds left) -> rclcpp::TimerBase::SharedPtr {
      if (simulated_) return rclcpp::create_timer(&node, clock_, rclcpp::Duration(left), call);
      return node.create_wall_timer(left, call);
    };
  }

  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;
  ~Alarm() { cancel(); }

  /// The time in whole milliseconds, rounded down; it wraps.
  std::uint32_t now() const { return static_cast<std::uint32_t>(clock_->now().nanoseconds() / kMillisecond); }

  /// Whether the clock, which had not begun, has begun: true once.
  bool began() {
    const bool was_late = std::exchange(late_, late_ && !clock_->started());
    return was_late && !late_;
  }

  /// Calls in so many milliseconds, unless it does before; the largest number means never.
  void set(std::uint32_t left) {
    const std::int64_t up = clock_->now().nanoseconds() + left * kMillisecond;
    if (left == std::numeric_limits<std::uint32_t>::max() || (timer_ && up_ <= up)) return;
    cancel();
    up_ = up;
    timer_ = plan_(std::chrono::milliseconds(left));
  }

 private:
  static constexpr std::int64_t kMillisecond = 1000000;

  void cancel() {
    if (timer_) timer_->cancel();
    timer_.reset();
  }

  std::function<void()> ring_;
  bool simulated_;
  rclcpp::Clock::SharedPtr clock_;
  bool late_;
  std::function<rclcpp::TimerBase::SharedPtr(std::chrono::nanoseconds)> plan_;
  std::int64_t up_ = 0;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ALARM_HPP_
