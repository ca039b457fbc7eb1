// Looks after something that is waited for.
#ifndef ROBOSC_ROS1_DEADLINE_HPP_
#define ROBOSC_ROS1_DEADLINE_HPP_

#include <functional>
#include <utility>

#include <ros/ros.h>

namespace robosc {
inline namespace v1 {

/// Calls a function again and again while it is started, and says whether the time that it was given is over. It counts
/// the steady clock; the time of ROS where that is simulated.
class Deadline {
 public:
  explicit Deadline(std::function<void()> look) : look_(std::move(look)) {
    const double period = 0.02;
    if (ros::Time::isSimTime()) {
      timer_ = node_.createTimer(ros::Duration(period), [this](const ros::TimerEvent&) { look_(); }, false, false);
    } else {
      steady_timer_ = node_.createSteadyTimer(
          ros::WallDuration(period), [this](const ros::SteadyTimerEvent&) { look_(); }, false, false);
    }
  }

  /// Begins to count anew.
  void start(double seconds) {
    end_ = now() + seconds;
    timer_.start();
    steady_timer_.start();
  }

  void stop() {
    timer_.stop();
    steady_timer_.stop();
  }

  bool over() const { return now() >= end_; }

 private:
  static double now() { return ros::Time::isSimTime() ? ros::Time::now().toSec() : ros::SteadyTime::now().toSec(); }

  ros::NodeHandle node_;
  std::function<void()> look_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;
  double end_ = 0.0;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS1_DEADLINE_HPP_
