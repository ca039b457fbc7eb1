// Something that happens later.
#ifndef ROBOSC_ROS1_COUNTDOWN_HPP_
#define ROBOSC_ROS1_COUNTDOWN_HPP_

#include <chrono>
#include <functional>
#include <utility>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/time.h>
#include <ros/timer.h>

namespace robosc {
inline namespace v1 {

/// Calls a function once, some time after its start: counted on the steady clock or, with use_sim_time, in ROS time.
/// The call comes through the node's callback queue.
class Countdown {
 public:
  Countdown(ros::NodeHandle& node, std::chrono::milliseconds time, std::function<void()> over)
      : over_(std::move(over)) {
    const double seconds = std::chrono::duration<double>(time).count();
    if (ros::Time::isSimTime()) {
      simulated_ = node.createTimer(ros::Duration(seconds), [this](const ros::TimerEvent&) { end(); }, true, false);
    } else {
      steady_ = node.createSteadyTimer(
          ros::WallDuration(seconds), [this](const ros::SteadyTimerEvent&) { end(); }, true, false);
    }
  }

  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;

  /// Counts from the full time, also where it was counting.
  void start() {
    stop();
    running_ = true;
    simulated_.start();
    steady_.start();
  }

  void stop() {
    running_ = false;
    simulated_.stop();
    steady_.stop();
  }

  bool running() const { return running_; }

 private:
  void end() {
    running_ = false;
    over_();
  }

  std::function<void()> over_;
  bool running_ = false;
  ros::Timer simulated_;
  ros::SteadyTimer steady_;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS1_COUNTDOWN_HPP_
