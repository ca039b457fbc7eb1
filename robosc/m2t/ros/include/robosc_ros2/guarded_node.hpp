// Base class of controllers and layers.
#ifndef ROBOSC_ROS2_GUARDED_NODE_HPP_
#define ROBOSC_ROS2_GUARDED_NODE_HPP_

#include <chrono>
#include <string>
#include <thread>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/hangup.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/countdown.hpp"
#include "robosc_ros2/node_services.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Gives the executors time to let go of a node that was removed from them. rclcpp's own subscription to changes of
/// parameters has no guard, and an executor in another thread may still run its callback. An executor in this thread
/// holds the subscription until the end of the function that it runs. So the wait is short.
template <typename Group>
void part(Group& group) {
  const auto held = [](const auto& entity) { return entity.use_count() > 2; };
  for (int left = 50; left > 0 && group.find_subscription_ptrs_if(held) != nullptr; --left) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// A node without callbacks after its end. `Beat`: milliseconds between the beats of its guards.
template <typename Node, int Beat = kBeat>
class GuardedNode : public Node {
 public:
  /// The name of the node with its namespace. Managed nodes of Humble have no such function.
  std::string get_fully_qualified_name() const {
    const std::string space = this->get_namespace();
    return (space == "/" ? "" : space) + "/" + this->get_name();
  }

 protected:
  /// `more`: further arguments of the node's constructor.
  template <typename... More>
  GuardedNode(const std::string& name, const rclcpp::NodeOptions& options, More... more)
      : Node(name, rclcpp::NodeOptions(options).start_parameter_services(false), more...) {
    if (options.start_parameter_services()) serve_parameters(services_, *this, services_guard_);
    beats_ = this->create_wall_timer(std::chrono::milliseconds(Beat), services_guard_([this] { guard_.beat(); }));
  }

  /// Closes the node. Call it first in the destructor of a derived class: executors may call back until this returns.
  void close() {
    guard_.close();
    services_guard_.close();
    services_.close();
    part(*this->get_node_base_interface()->get_default_callback_group());
  }

  /// The time of the node.
  double seconds() const { return this->now().seconds(); }

  Hangup hangup_;
  CallbackGuard guard_;
  CallbackGuard services_guard_ = guard_.sibling();
  NodeServices services_;
  rclcpp::TimerBase::SharedPtr beats_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_GUARDED_NODE_HPP_
