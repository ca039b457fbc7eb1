// Wakes a node when the next time of its model is up.
#ifndef ROBOSC_ROS1_ALARM_HPP_
#define ROBOSC_ROS1_ALARM_HPP_

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/time.h>
#include <ros/timer.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A clock and one timer on it, which calls a function: the steady clock or, with use_sim_time, ROS time. The calls
/// come through the node's callback queue, behind the messages that came before.
class Alarm {
 public:
  Alarm(ros::NodeHandle& node, std::function<void()> ring) : ring_(std::move(ring)) {
    if (ros::Time::isSimTime()) {
      late_ = nanoseconds() == 0;
      simulated_ = node.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { call(); }, true, false);
    } else {
      steady_ =
          node.createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) { call(); }, true, false);
    }
  }

  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;

  /// The time in whole milliseconds, rounded down; it wraps.
  std::uint32_t now() const { return static_cast<std::uint32_t>(nanoseconds() / kMillisecond); }

  /// Whether the clock, which had not begun, has begun: true once.
  bool began() {
    const bool was_late = std::exchange(late_, late_ && nanoseconds() == 0);
    return was_late && !late_;
  }

  /// Calls in so many milliseconds, unless it does before; the largest number means never.
  void set(std::uint32_t left) {
    const std::int64_t up = nanoseconds() + left * kMillisecond;
    if (left == std::numeric_limits<std::uint32_t>::max() || (set_ && up_ <= up)) return;
    set_ = true;
    up_ = up;
    const double seconds = left / 1000.0;
    simulated_.stop();
    simulated_.setPeriod(ros::Duration(seconds));
    simulated_.start();
    steady_.stop();
    steady_.setPeriod(ros::WallDuration(seconds));
    steady_.start();
  }

 private:
  static constexpr std::int64_t kMillisecond = 1000000;

  static std::int64_t nanoseconds() {
    return static_cast<std::int64_t>(ros::Time::isSimTime() ? ros::Time::now().toNSec()
                                                            : ros::SteadyTime::now().toNSec());
  }

  void call() {
    set_ = false;
    ring_();
  }

  std::function<void()> ring_;
  bool late_ = false;
  bool set_ = false;
  std::int64_t up_ = 0;
  ros::Timer simulated_;
  ros::SteadyTimer steady_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_ALARM_HPP_
