// Client of an action.
#ifndef ROBOSC_ROS2_ACTION_CLIENT_HPP_
#define ROBOSC_ROS2_ACTION_CLIENT_HPP_

#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <action_msgs/msg/goal_status.hpp>
#include <action_msgs/srv/cancel_goal.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/goal_client.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/action_servers.hpp"
#include "robosc_ros2/cancel_answer.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A client of one action over rclcpp_action, for its own goals only. The node's executor calls the handlers.
template <typename Type>
class ActionClient : public GoalClient<Countdown, typename Type::Feedback, typename Type::Result> {
 public:
  using Goal = typename Type::Goal;
  using Base = GoalClient<Countdown, typename Type::Feedback, typename Type::Result>;

  /// `quality`: quality of service of the feedback. A refused cancel is repeated after `retry`.
  template <typename Node>
  ActionClient(Node& node, const CallbackGuard& guard, const std::string& name, const rclcpp::QoS& quality,
               std::chrono::milliseconds timeout, std::chrono::milliseconds retry, typename Base::Handlers handlers)
      : Base(timeout, retry, std::move(handlers), node, guard),
        guard_(guard),
        name_(name),
        logger_(node.get_logger()),
        client_(rclcpp_action::create_client<Type>(&node, name, nullptr, options(quality))),
        heard_(node.template create_subscription<FeedbackMessage>(
            name + "/_action/feedback", quality, guard([this](const FeedbackMessage& message) { hear(message); }))),
        servers_(node, name) {}

  /// Sends a goal. The previous goal must have ended: see `busy`.
  void start(const Goal& goal) {
    goal_ = goal;
    this->begin();
  }

 private:
  using Client = rclcpp_action::Client<Type>;
  using FeedbackMessage = typename Type::Impl::FeedbackMessage;
  using Handle = typename Client::GoalHandle::SharedPtr;
  using Phase = typename Base::Phase;

  static constexpr std::size_t kEarly = 10;

  static rcl_action_client_options_t options(const rclcpp::QoS& quality) {
    rcl_action_client_options_t options = rcl_action_client_get_default_options();
    options.feedback_topic_qos = quality.get_rmw_qos_profile();
    return options;
  }

  bool is_canceling() override {
    return handle_ && handle_->get_status() == action_msgs::msg::GoalStatus::STATUS_CANCELING;
  }

  bool is_served() override { return this->phase() != Phase::waiting || client_->action_server_is_ready(); }

  bool send() override {
    servers_.remember();
    typename Client::SendGoalOptions options;
    options.goal_response_callback = guard_([this, number = this->number()](const Handle& handle) {
      if (number == this->number()) {
        answered(handle);
      } else if (handle) {
        cancel_stray(handle);
      }
    });
    options.result_callback = mine<typename Client::WrappedResult>([this](const auto& result) { ended(result); });
    try {
      client_->async_send_goal(goal_, options);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }

  /// A callback that runs only while this goal is the current one.
  template <typename Value, typename Function>
  auto mine(Function function) {
    return guard_([this, function, number = this->number()](const Value& value) {
      if (number == this->number()) function(value);
    });
  }

  void answered(const Handle& handle) {
    if (!handle) return this->fail(Failure::rejected, "rejected");
    handle_ = handle;
    this->accept();
    for (const FeedbackMessage& message : std::exchange(early_, {})) hear(message);
  }

  /// Handles feedback. It may overtake the answer to the goal, which rclcpp_action does not expect: then it is kept
  /// until the answer arrives.
  void hear(const FeedbackMessage& message) {
    if (this->phase() == Phase::sent) {
      early_.push_back(message);
      if (early_.size() > kEarly) early_.pop_front();
    } else if (handle_ && message.goal_id.uuid == handle_->get_goal_id()) {
      Base::hear(message.feedback);
    }
  }

  void ended(const typename Client::WrappedResult& result) {
    switch (result.code) {
      case rclcpp_action::ResultCode::SUCCEEDED:
        return this->succeed(*result.result);
      case rclcpp_action::ResultCode::CANCELED:
        return this->canceled("", *result.result);
      case rclcpp_action::ResultCode::ABORTED:
        return this->abort("", *result.result);
      default:
        return this->lose();
    }
  }

  void request_cancel() override {
    using action_msgs::srv::CancelGoal;
    if (!handle_) return;
    try {
      client_->async_cancel_goal(handle_, mine<CancelGoal::Response::SharedPtr>([this](const auto& answer) {
                                   this->cancel_answered(cancel_answer(*answer, handle_->get_goal_id()));
                                 }));
    } catch (const rclcpp_action::exceptions::UnknownGoalHandleError&) {
      this->await_result();  // The goal has ended. Its result will arrive.
    }
  }

  /// Cancels a goal that was given up as lost and then accepted.
  void cancel_stray(const Handle& handle) {
    try {
      client_->async_cancel_goal(handle);
    } catch (const rclcpp_action::exceptions::UnknownGoalHandleError&) {
      // The goal has ended.
    }
  }

  bool is_gone() override { return servers_.are_gone(); }

  void reset() override {
    handle_.reset();
    early_.clear();
  }

  void warn(const std::string& text) override { RCLCPP_WARN(logger_, "%s: %s", name_.c_str(), text.c_str()); }

  const CallbackGuard& guard_;
  std::string name_;
  rclcpp::Logger logger_;
  typename Client::SharedPtr client_;
  typename rclcpp::Subscription<FeedbackMessage>::SharedPtr heard_;
  std::deque<FeedbackMessage> early_;
  ActionServers servers_;
  Goal goal_;
  Handle handle_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_CLIENT_HPP_
