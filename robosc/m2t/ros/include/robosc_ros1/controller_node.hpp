// Base class of controllers.
#ifndef ROBOSC_ROS1_CONTROLLER_NODE_HPP_
#define ROBOSC_ROS1_CONTROLLER_NODE_HPP_

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ros/ros.h>

#include "robosc/queue_depth.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/countdown.hpp"
#include "robosc_ros1/graph_monitor.hpp"
#include "robosc_ros1/interruption.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A node that stops its robot at its end.
class ControllerNode {
 public:
  ControllerNode(const ControllerNode&) = delete;
  ControllerNode& operator=(const ControllerNode&) = delete;
  virtual ~ControllerNode() = default;

  /// Stops the robot. Call it while nothing else delivers messages. Then `deliver` handles incoming messages for a
  /// bounded time, until the ends of the goals are known.
  template <typename Deliver>
  void end(Deliver deliver) {
    if (!std::exchange(stopping_, true)) halt();
    const ros::SteadyTime until = ros::SteadyTime::now() + ros::WallDuration(kLongestEnd);
    while (waits() && ros::SteadyTime::now() < until) deliver();
  }

 protected:
  /// One thread serves the callback queue of `node`, which delivers all messages and calls.
  explicit ControllerNode(const ros::NodeHandle& node) : node_(node) {}

  // Functions that depend on the model.

  /// Stops the robot while all triggers are held.
  virtual void halt() = 0;
  /// Whether the end of the node waits for the end of a goal.
  virtual bool waits() const { return false; }
  /// Other steps before the end of the node.
  virtual void finish() {}
  /// Handles the end of a period.
  virtual void tick() = 0;

  // Functions of the node.

  /// Watches for other publishers on a topic of which the node should be the only one.
  template <typename Message>
  void command_alone(const std::string& topic) {
    monitor_.commands<Message>(topic);
  }

  /// A publisher of commands. The node should be the only publisher on its topic.
  template <typename Message>
  ros::Publisher advertise(const std::string& topic) {
    command_alone<Message>(topic);
    return node_.advertise<Message>(topic, kQueueDepth);
  }

  /// A subscription to a topic of the robot.
  template <typename Message>
  ros::Subscriber subscribe(const std::string& topic, std::function<void(const Message&)> heard) {
    monitor_.listens_to<Message>(topic);
    return node_.subscribe<const Message&>(topic, kQueueDepth, boost::function<void(const Message&)>(std::move(heard)),
                                           ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  /// Faults of the ROS graph that concern a topic.
  std::vector<std::string> faults(const std::string& topic) const { return monitor_.faults(topic); }

  /// Starts the ticks.
  void start(std::chrono::milliseconds period) {
    timer_.emplace(node_, period, [this] { tick(); });
    timer_->start();
    monitor_.start();
  }

  /// Stops all deliveries while ROS still runs. Call it first in the destructor of a derived class.
  void stop() {
    if (!std::exchange(stopping_, true)) halt();
    finish();
    ros::WallDuration(0.2).sleep();  // ROS 1 does not report when a message has left the node
  }

  /// The time of the node.
  static double seconds() { return ros::Time::now().toSec(); }

  ros::NodeHandle node_;
  ros::NodeHandle private_{"~"};
  bool stopping_ = false;

 private:
  std::optional<Timer> timer_;
  GraphMonitor monitor_{node_};
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_CONTROLLER_NODE_HPP_
