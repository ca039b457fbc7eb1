// Timer for the next timeout of a model.
#ifndef ROBOSC_ROS2_ALARM_HPP_
#define ROBOSC_ROS2_ALARM_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
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
        make_timer_(timer_factory(node, guard([this] {
                                    timer_.reset();
                                    ring();
                                  }))) {
    // Timers run from the start of the clock, even without an event at that moment.
    if (!clock_->started()) {
      begin_ = node.create_wall_timer(kLook, guard([this] {
                                        if (!clock_->started()) return;
                                        begin_.reset();
                                        at();
                                        wait();
                                      }));
    }
  }

  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;

 private:
  std::int64_t nanoseconds() const override { return clock_->now().nanoseconds(); }
  bool has_begun() const override { return clock_->started(); }

  void set(std::chrono::milliseconds left) override { timer_ = make_timer_(left); }

  rclcpp::Clock::SharedPtr clock_;
  std::function<rclcpp::TimerBase::SharedPtr(std::chrono::nanoseconds)> make_timer_;
  rclcpp::TimerBase::SharedPtr timer_;
  rclcpp::TimerBase::SharedPtr begin_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ALARM_HPP_
