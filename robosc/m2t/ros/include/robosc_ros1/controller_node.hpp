// What controllers have in common.
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

/// A node that stops its robot when it goes.
class ControllerNode {
 public:
  ControllerNode(const ControllerNode&) = delete;
  ControllerNode& operator=(const ControllerNode&) = delete;
  virtual ~ControllerNode() = default;

  /// Stops the robot, while nobody else delivers; then `deliver` hands on what comes in until it is known what becomes
  /// of the goals, not for long.
  template <typename Deliver>
  void end(Deliver deliver) {
    if (!std::exchange(stopping_, true)) halt();
    const ros::SteadyTime until = ros::SteadyTime::now() + ros::WallDuration(kLongestEnd);
    while (waits() && ros::SteadyTime::now() < until) deliver();
  }

 protected:
  /// All that happens comes through the queue of `node`, which one thread serves.
  explicit ControllerNode(const ros::NodeHandle& node) : node_(node) {}

  // What the model decides.

  /// Stops the robot while all triggers are held.
  virtual void halt() = 0;
  /// Whether the end waits for what becomes of a goal.
  virtual bool waits() const { return false; }
  /// What else there is to do before the node ends.
  virtual void finish() {}
  /// A period is over.
  virtual void tick() = 0;

  // What the node does.

  /// A publisher of commands, of which it is the only one as far as it knows.
  template <typename Message>
  ros::Publisher advertise(const std::string& topic) {
    monitor_.commands<Message>(topic);
    return node_.advertise<Message>(topic, kQueueDepth);
  }

  /// A subscription to what the robot tells.
  template <typename Message>
  ros::Subscriber subscribe(const std::string& topic, std::function<void(const Message&)> heard) {
    monitor_.listens_to<Message>(topic);
    return node_.subscribe<const Message&>(topic, kQueueDepth, boost::function<void(const Message&)>(std::move(heard)),
                                           ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  /// What is wrong around the node with a topic.
  std::vector<std::string> faults(const std::string& topic) const { return monitor_.faults(topic); }

  /// Ticks from now on.
  void start(std::chrono::milliseconds period) {
    timer_.emplace(node_, period, [this] { tick(); });
    timer_->start();
    monitor_.start();
  }

  /// The first thing that the destructor of a derived class does: nothing is delivered any more, but ROS still runs.
  void stop() {
    if (!std::exchange(stopping_, true)) halt();
    finish();
    ros::WallDuration(0.2).sleep();  // nothing tells when a message has left the node
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
