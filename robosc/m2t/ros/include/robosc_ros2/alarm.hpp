// Timer for the next timeout of a model.
#ifndef ROBOSC_ROS2_ALARM_HPP_
#define ROBOSC_ROS2_ALARM_HPP_

#include <chrono>
#include <cstdint>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/timeouts.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Timers on the steady clock or, with `use_sim_time`, in the time of ROS.
class Alarm final : public Timeouts {
 public:
  template <typename Node>
  Alarm(Node& node, const CallbackGuard& guard, Engine engine)
      : Timeouts(std::move(engine), !waiting_clock(node)->started()),
        clock_(waiting_clock(node)),
        begun_(clock_->started()),
        next_(node, guard, std::chrono::milliseconds(0), [this] { ring(); }),
        beat_(guard.at_each_beat([this] {
          // Timers run from the start of the clock, even without an event at that moment.
          if (begun_ || !clock_->started()) return;
          begun_ = true;
          at();
          wait();
        })) {}

  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;

 private:
  std::int64_t nanoseconds() const override { return clock_->now().nanoseconds(); }
  bool has_begun() const override { return clock_->started(); }

  void set(std::chrono::milliseconds left) override { next_.start(left); }

  rclcpp::Clock::SharedPtr clock_;
  bool begun_;
  Countdown next_;
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ALARM_HPP_
