// Base class of controllers and layers.
#ifndef ROBOSC_ROS2_GUARDED_NODE_HPP_
#define ROBOSC_ROS2_GUARDED_NODE_HPP_

#include <string>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/hangup.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A node without callbacks after its end.
template <typename Node>
class GuardedNode : public Node {
 public:
  /// The name of the node with its namespace. Managed nodes of Humble have no such function.
  std::string get_fully_qualified_name() const {
    const std::string space = this->get_namespace();
    return (space == "/" ? "" : space) + "/" + this->get_name();
  }

 protected:
  using Node::Node;

  /// Closes the node. Call it first in the destructor of a derived class: executors may call back until this returns.
  void close() {
    guard_.close();
    withdraw(*this->get_node_base_interface()->get_default_callback_group());
  }

  /// The time of the node.
  double seconds() const { return this->now().seconds(); }

  Hangup hangup_;
  CallbackGuard guard_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_GUARDED_NODE_HPP_
