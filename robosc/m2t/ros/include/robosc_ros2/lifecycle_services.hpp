// Services for the lifecycle of a node.
#ifndef ROBOSC_ROS2_LIFECYCLE_SERVICES_HPP_
#define ROBOSC_ROS2_LIFECYCLE_SERVICES_HPP_

#include <string>

#include <lifecycle_msgs/msg/state.hpp>
#include <lifecycle_msgs/msg/transition.hpp>
#include <lifecycle_msgs/msg/transition_description.hpp>
#include <lifecycle_msgs/srv/change_state.hpp>
#include <lifecycle_msgs/srv/get_available_states.hpp>
#include <lifecycle_msgs/srv/get_available_transitions.hpp>
#include <lifecycle_msgs/srv/get_state.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/node_services.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

inline lifecycle_msgs::msg::State state_message(const rclcpp_lifecycle::State& state) {
  lifecycle_msgs::msg::State message;
  message.id = state.id();
  message.label = state.label();
  return message;
}

/// Takes a transition, by its label or else by its number. Returns whether it succeeded.
inline bool take_transition(rclcpp_lifecycle::LifecycleNode& node, const lifecycle_msgs::msg::Transition& wanted) {
  using rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface;
  for (const auto& transition : node.get_available_transitions()) {
    if (wanted.label.empty() ? transition.id() != wanted.id : transition.label() != wanted.label) continue;
    auto result = LifecycleNodeInterface::CallbackReturn::FAILURE;
    node.trigger_transition(transition.id(), result);
    return result == LifecycleNodeInterface::CallbackReturn::SUCCESS;
  }
  const std::string name = wanted.label.empty() ? std::to_string(wanted.id) : wanted.label;
  RCLCPP_ERROR(node.get_logger(), "no transition %s from the state %s", name.c_str(),
               node.get_current_state().label().c_str());
  return false;
}

/// Adds the services for the lifecycle, with the answers of those of rclcpp_lifecycle.
inline void serve_lifecycle(NodeServices& services, rclcpp_lifecycle::LifecycleNode& node, const CallbackGuard& guard) {
  namespace srv = lifecycle_msgs::srv;
  const auto describe = [](const auto& transitions, auto& response) {
    for (const auto& transition : transitions) {
      lifecycle_msgs::msg::TransitionDescription description;
      description.transition.id = transition.id();
      description.transition.label = transition.label();
      description.start_state = state_message(transition.start_state());
      description.goal_state = state_message(transition.goal_state());
      response.available_transitions.push_back(description);
    }
  };
  services.serve<srv::ChangeState>(node, guard, "change_state", [&node](const auto& request, auto& response) {
    response.success = take_transition(node, request.transition);
  });
  services.serve<srv::GetState>(node, guard, "get_state", [&node](const auto&, auto& response) {
    response.current_state = state_message(node.get_current_state());
  });
  services.serve<srv::GetAvailableStates>(node, guard, "get_available_states", [&node](const auto&, auto& response) {
    for (const auto& state : node.get_available_states()) response.available_states.push_back(state_message(state));
  });
  services.serve<srv::GetAvailableTransitions>(
      node, guard, "get_available_transitions",
      [&node, describe](const auto&, auto& response) { describe(node.get_available_transitions(), response); });
  services.serve<srv::GetAvailableTransitions>(
      node, guard, "get_transition_graph",
      [&node, describe](const auto&, auto& response) { describe(node.get_transition_graph(), response); });
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_LIFECYCLE_SERVICES_HPP_
