// Timer for the next timeout of a model.
#ifndef ROBOSC_ROS1_ALARM_HPP_
#define ROBOSC_ROS1_ALARM_HPP_

#include <chrono>
#include <cstdint>
#include <utility>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/time.h>
#include <ros/timer.h>

#include "robosc/timeouts.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Timers on the steady clock or, with use_sim_time, in ROS time. Each expires after the messages that precede it in
/// the node's callback queue.
class Alarm final : public Timeouts {
 public:
  Alarm(ros::NodeHandle& node, Engine engine)
      : Timeouts(std::move(engine), ros::Time::isSimTime() && ros::Time::now().isZero()) {
    if (ros::Time::isSimTime()) {
      simulated_ = node.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { ring(); }, true, false);
    } else {
      steady_ =
          node.createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) { ring(); }, true, false);
    }
  }

 private:
  std::int64_t nanoseconds() const override {
    return static_cast<std::int64_t>(ros::Time::isSimTime() ? ros::Time::now().toNSec()
                                                            : ros::SteadyTime::now().toNSec());
  }

  bool has_begun() const override { return nanoseconds() != 0; }

  void set(std::chrono::milliseconds left) override {
    const double seconds = std::chrono::duration<double>(left).count();
    simulated_.stop();
    simulated_.setPeriod(ros::Duration(seconds));
    simulated_.start();
    steady_.stop();
    steady_.setPeriod(ros::WallDuration(seconds));
    steady_.start();
  }

  ros::Timer simulated_;
  ros::SteadyTimer steady_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_ALARM_HPP_
