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
      : Timeouts(std::move(engine), !waiting_clock(node)->started()), clock_(waiting_clock(node)) {
    const auto call = guard([this] {
      cancel();
      ring();
    });
    const bool simulated = clock_ == node.get_clock();
    plan_ = [&node, simulated, call, this](std::chrono::milliseconds left) -> rclcpp::TimerBase::SharedPtr {
      if (simulated) return rclcpp::create_timer(&node, clock_, left, call);
      return node.create_wall_timer(left, call);
    };
    // Timers run from the start of the clock, even without an event at that moment.
    if (!clock_->started()) {
      begin_ = node.create_wall_timer(kLook, guard([this] {
                                        if (!clock_->started()) return;
                                        begin_->cancel();
                                        at();
                                        wait();
                                      }));
    }
  }

  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;
  ~Alarm() override { cancel(); }

 private:
  std::int64_t nanoseconds() const override { return clock_->now().nanoseconds(); }
  bool has_begun() const override { return clock_->started(); }

  void set(std::chrono::milliseconds left) override {
    cancel();
    timer_ = plan_(left);
  }

  void cancel() {
    if (timer_) timer_->cancel();
    timer_.reset();
  }

  rclcpp::Clock::SharedPtr clock_;
  std::function<rclcpp::TimerBase::SharedPtr(std::chrono::milliseconds)> plan_;
  rclcpp::TimerBase::SharedPtr timer_;
  rclcpp::TimerBase::SharedPtr begin_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ALARM_HPP_
