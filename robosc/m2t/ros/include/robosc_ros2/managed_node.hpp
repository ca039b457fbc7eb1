// Controllers with a lifecycle.
#ifndef ROBOSC_ROS2_MANAGED_NODE_HPP_
#define ROBOSC_ROS2_MANAGED_NODE_HPP_

#include <exception>
#include <string>

#include <lifecycle_msgs/msg/state.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <rclcpp_lifecycle/lifecycle_publisher.hpp>

#include "robosc/version.hpp"
#include "robosc_ros2/controller_node.hpp"
#include "robosc_ros2/lifecycle_services.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A controller that other nodes configure and activate. While inactive, it follows the robot and sends nothing.
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
  ManagedNode(const std::string& name, const rclcpp::NodeOptions& options) : ControllerNode(name, options, false) {
    serve_lifecycle(services_, *this, services_guard_);
  }

  /// Takes the last transition while the node can still send.
  void finalize() override {
    if (get_current_state().id() != lifecycle_msgs::msg::State::PRIMARY_STATE_FINALIZED) shutdown();
  }

  // Functions that depend on the model.

  /// Connects the node to all topics, services and actions of the model.
  virtual void configure() = 0;
  /// Permits the node to send.
  virtual void activate() = 0;
  /// Stops the robot. The node sends nothing afterwards.
  virtual void deactivate() = 0;
  /// Disconnects the node and discards its state.
  virtual void disconnect() = 0;

 private:
  void release() {
    guard_.close();
    ticking_ = false;
    finish();
    disconnect();
    durabilities_.reset();
    monitor_.reset();
    // The events executor of Jazzy takes a new subscription for a destroyed one, unless it looks in between.
    get_node_base_interface()->get_notify_guard_condition().trigger();
  }
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_MANAGED_NODE_HPP_
