// A controller with a life cycle.
#ifndef ROBOSC_ROS2_MANAGED_NODE_HPP_
#define ROBOSC_ROS2_MANAGED_NODE_HPP_

#include <exception>

#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <rclcpp_lifecycle/lifecycle_publisher.hpp>

#include "robosc/version.hpp"
#include "robosc_ros2/controller_node.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A controller that others configure and activate. While it is not active, it follows what the robot does and sends
/// nothing.
class ManagedNode : public ControllerNode<rclcpp_lifecycle::LifecycleNode> {
 public:
  using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;

  CallbackReturn on_configure(const rclcpp_lifecycle::State&) override {
    try {
      configure();
      return CallbackReturn::SUCCESS;
    } catch (const std::exception& error) {
      RCLCPP_ERROR(get_logger(), "not configured: %s", error.what());
      release();
      return CallbackReturn::FAILURE;
    }
  }

  CallbackReturn on_activate(const rclcpp_lifecycle::State& state) override {
    if (busy()) {
      RCLCPP_ERROR(get_logger(), "not activated: a goal of this node has not ended");
      return CallbackReturn::FAILURE;
    }
    const CallbackReturn done = LifecycleNode::on_activate(state);
    if (done == CallbackReturn::SUCCESS) activate();
    return done;
  }

  CallbackReturn on_deactivate(const rclcpp_lifecycle::State& state) override {
    deactivate();
    return LifecycleNode::on_deactivate(state);
  }

  CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) override {
    if (busy()) {
      RCLCPP_ERROR(get_logger(), "not cleaned up: a goal of this node has not ended");
      return CallbackReturn::FAILURE;
    }
    release();
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_error(const rclcpp_lifecycle::State&) override {
    if (active_) deactivate();
    if (busy()) return CallbackReturn::FAILURE;
    release();
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_shutdown(const rclcpp_lifecycle::State&) override {
    if (active_) deactivate();
    if (!busy()) release();
    return CallbackReturn::SUCCESS;
  }

 protected:
  using ControllerNode::ControllerNode;

  // What the model decides.

  /// Connects the node to everything that the model names.
  virtual void configure() = 0;
  /// It may send from now on.
  virtual void activate() = 0;
  /// Stops the robot; nothing is sent any more.
  virtual void deactivate() = 0;
  /// Lets go of all that it was connected to, and keeps nothing.
  virtual void disconnect() = 0;

 private:
  void release() {
    guard_.close();
    timer_.reset();
    finish();
    disconnect();
    durabilities_.reset();
    monitor_.reset();
  }
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_MANAGED_NODE_HPP_
