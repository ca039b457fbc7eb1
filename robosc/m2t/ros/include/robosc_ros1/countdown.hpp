// Timers, periodic or for one call.
#ifndef ROBOSC_ROS1_COUNTDOWN_HPP_
#define ROBOSC_ROS1_COUNTDOWN_HPP_

#include <chrono>
#include <functional>
#include <utility>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/time.h>
#include <ros/timer.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Calls a function at the end of each period, or `once` after each start: on the steady clock or, with use_sim_time,
/// in ROS time. The node's callback queue delivers the calls.
class Timer {
 public:
  Timer(ros::NodeHandle& node, std::chrono::milliseconds period, std::function<void()> function, bool once = false)
      : function_(std::move(function)) {
    const double seconds = std::chrono::duration<double>(period).count();
    if (ros::Time::isSimTime()) {
      simulated_ =
          node.createTimer(ros::Duration(seconds), [this](const ros::TimerEvent&) { function_(); }, once, false);
    } else {
      steady_ = node.createSteadyTimer(
          ros::WallDuration(seconds), [this](const ros::SteadyTimerEvent&) { function_(); }, once, false);
    }
  }

  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void start() {
    simulated_.start();
    steady_.start();
  }

  void stop() {
    simulated_.stop();
    steady_.stop();
  }

 private:
  std::function<void()> function_;
  ros::Timer simulated_;
  ros::SteadyTimer steady_;
};

/// Calls a function once, a given time after its start.
class Countdown {
 public:
  Countdown(ros::NodeHandle& node, std::chrono::milliseconds time, std::function<void()> over)
      : over_(std::move(over)),
        timer_(
            node, time,
            [this] {
              running_ = false;
              over_();
            },
            true) {}

  /// Restarts with the full time.
  void start() {
    stop();
    running_ = true;
    timer_.start();
  }

  void stop() {
    running_ = false;
    timer_.stop();
  }

  bool running() const { return running_; }

 private:
  std::function<void()> over_;
  bool running_ = false;
  Timer timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_COUNTDOWN_HPP_
