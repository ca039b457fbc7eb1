// Has an action carried out.
#ifndef ROBOSC_ROS2_ACTION_CLIENT_HPP_
#define ROBOSC_ROS2_ACTION_CLIENT_HPP_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <action_msgs/srv/cancel_goal.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace v1 {

/// One goal at a time, and only goals of its own. Handlers are called by the node's executor, never from inside
/// `start`, `cancel` or `interrupt`.
template <typename Type>
class ActionClient {
 public:
  using Goal = typename Type::Goal;
  using Feedback = typename Type::Feedback;
  using Result = typename Type::Result;

  struct Handlers {
    std::function<void(const Feedback&)> feedback;
    std::function<void(const Result&)> response;
    std::function<void(const std::string& why)> error;
    std::function<void()> ended;
  };

  /// `timeout`: from the start of a goal to its acceptance; the server, too, may appear in this time.
  template <typename Node>
  ActionClient(Node& node, const CallbackGuard& guard, const std::string& name, const rclcpp::QoS& quality,
               std::chrono::milliseconds timeout, Handlers handlers)
      : guard_(guard),
        handlers_(std::move(handlers)),
        name_(name),
        logger_(node.get_logger()),
        timeout_(timeout),
        client_(rclcpp_action::create_client<Type>(&node, name, nullptr, options(quality))),
        heard_(node.template create_subscription<FeedbackMessage>(
            name + "/_action/feedback", quality, guard([this](const FeedbackMessage& message) { hear(message); }))),
        servers_([&node, name] { return node.get_publishers_info_by_topic(name + "/_action/status"); }),
        limit_(" within " + std::to_string(timeout.count()) + " ms"),
        deadline_(node, guard, timeout, [this] { give_up(); }),
        search_(node, guard, std::chrono::milliseconds(20), [this] { send(); }),
        watch_(node, guard, std::chrono::milliseconds(200), [this] { look_for_server(); }),
        lost_(node, guard, std::chrono::seconds(30), [this] { finish([] {}); }) {}

  /// A goal that did not end has to be waited for: see `busy`.
  void start(const Goal& goal) {
    goal_ = goal;
    phase_ = Phase::searching;
    matters_ = true;
    to_cancel_ = false;
    fault_ = "no server";
    patience_ = std::chrono::steady_clock::now() + timeout_;
    deadline_.start();
    send();
  }

  /// The goal is given up: nothing is said of it any more but that it `ended`.
  void cancel() {
    matters_ = false;
    interrupt();
  }

  /// The server is asked to end the goal. What comes of it is said as ever; a goal that ends as cancelled is an error.
  void interrupt() {
    to_cancel_ = phase_ != Phase::idle;
    if (handle_) request_cancel();
  }

  /// Whether a goal has not ended: one that was given up, too, and one that its server might still accept.
  bool busy() const { return phase_ != Phase::idle; }

  /// Whether the server may still accept the goal in time; where simulated time stands still, the steady clock bounds
  /// it.
  bool waits() const {
    return phase_ == Phase::asked && deadline_.running() && std::chrono::steady_clock::now() < patience_;
  }

 private:
  using Client = rclcpp_action::Client<Type>;
  using FeedbackMessage = typename Type::Impl::FeedbackMessage;
  using Handle = typename Client::GoalHandle::SharedPtr;
  enum class Phase { idle, searching, asked, running };

  static rcl_action_client_options_t options(const rclcpp::QoS& quality) {
    rcl_action_client_options_t options = rcl_action_client_get_default_options();
    options.feedback_topic_qos = quality.get_rmw_qos_profile();
    return options;
  }

  void send() {
    if (to_cancel_) {
      finish([this] { handlers_.error(kOwn); });
      return;
    }
    if (!client_->action_server_is_ready()) {
      search_.start();
      return;
    }
    server_ = servers_();
    typename Client::SendGoalOptions options;
    options.goal_response_callback = guard_([this, number = number_](const Handle& handle) {
      if (number == number_) {
        answered(handle);
      } else if (handle) {
        cancel_stray(handle);
      }
    });
    options.result_callback = mine<typename Client::WrappedResult>([this](const auto& result) { ended(result); });
    try {
      client_->async_send_goal(goal_, options);
      phase_ = Phase::asked;
      fault_ = "not accepted";
      watch_.start();
    } catch (const std::exception&) {
      fault_ = "the goal can't be sent";
      search_.start();
    }
  }

  /// A callback that only runs while the goal at hand is this client's.
  template <typename Value, typename Function>
  auto mine(Function function) {
    return guard_([this, function, number = number_](const Value& value) {
      if (number == number_) function(value);
    });
  }

  void answered(const Handle& handle) {
    deadline_.stop();
    lost_.stop();
    if (!handle) {
      finish([this] { handlers_.error("rejected"); });
      return;
    }
    handle_ = handle;
    phase_ = Phase::running;
    if (to_cancel_) request_cancel();
    for (const FeedbackMessage& message : std::exchange(early_, {})) hear(message);
  }

  /// Feedback may overtake the answer to the goal, which rclcpp_action does not expect: here it waits.
  void hear(const FeedbackMessage& message) {
    if (phase_ == Phase::asked) {
      early_.push_back(message);
      if (early_.size() > kEarly) early_.pop_front();
    } else if (phase_ == Phase::running && matters_ && message.goal_id.uuid == handle_->get_goal_id()) {
      handlers_.feedback(message.feedback);
    }
  }

  void ended(const typename Client::WrappedResult& result) {
    switch (result.code) {
      case rclcpp_action::ResultCode::SUCCEEDED:
        return finish([this, &result] { handlers_.response(*result.result); });
      case rclcpp_action::ResultCode::CANCELED:
        return finish([this, ours = to_cancel_] { handlers_.error(ours ? kOwn : "cancelled by someone else"); });
      default:
        return finish([this] { handlers_.error("aborted"); });
    }
  }

  void request_cancel() {
    using action_msgs::srv::CancelGoal;
    try {
      client_->async_cancel_goal(handle_, mine<CancelGoal::Response::SharedPtr>([this](const auto& answer) {
                                   const bool accepted = answer->return_code == CancelGoal::Response::ERROR_NONE;
                                   if (answer->return_code == CancelGoal::Response::ERROR_REJECTED ||
                                       (accepted && answer->goals_canceling.empty())) {
                                     RCLCPP_WARN(logger_, "%s: the server refuses to cancel the goal", name_.c_str());
                                   }
                                 }));
    } catch (const rclcpp_action::exceptions::UnknownGoalHandleError&) {
      // It has ended; its result is on the way.
    }
  }

  /// A goal that was taken for lost, accepted after all.
  void cancel_stray(const Handle& handle) {
    try {
      client_->async_cancel_goal(handle);
    } catch (const rclcpp_action::exceptions::UnknownGoalHandleError&) {
      // It has ended.
    }
  }

  /// The time for acceptance is over. A goal that is accepted after it is cancelled at once. One that a server never
  /// got, since it was still being discovered, is waited for no longer than it takes to miss a server.
  void give_up() {
    if (phase_ == Phase::searching) {
      finish([this] { handlers_.error(fault_ + limit_); });
      return;
    }
    to_cancel_ = true;
    lost_.start();
    if (std::exchange(matters_, false)) handlers_.error(fault_ + limit_);
  }

  /// A server that dies can't say so: it has died when none of those that were there for the goal is left.
  void look_for_server() {
    const auto is_left = [this](const rclcpp::TopicEndpointInfo& now) {
      return std::any_of(server_.begin(), server_.end(), [&now](const rclcpp::TopicEndpointInfo& then) {
        return now.endpoint_gid() == then.endpoint_gid();
      });
    };
    std::vector<rclcpp::TopicEndpointInfo> now;
    try {
      now = servers_();
    } catch (const rclcpp::exceptions::RCLError&) {
      return;  // The context is closed: the node is at its end.
    }
    if (std::any_of(now.begin(), now.end(), is_left)) {
      watch_.start();
    } else {
      finish([this] { handlers_.error("the server is gone"); });
    }
  }

  /// The goal is over; `tell` says how, where that matters.
  template <typename Tell>
  void finish(Tell tell) {
    ++number_;
    phase_ = Phase::idle;
    handle_.reset();
    early_.clear();
    deadline_.stop();
    search_.stop();
    watch_.stop();
    lost_.stop();
    if (std::exchange(matters_, false)) {
      tell();
    } else {
      handlers_.ended();
    }
  }

  static constexpr std::size_t kEarly = 10;
  // What a goal comes to that was interrupted: the node has stopped the robot.
  static constexpr const char* kOwn = "cancelled by the controller itself, an error to the model";

  const CallbackGuard& guard_;
  Handlers handlers_;
  std::string name_;
  rclcpp::Logger logger_;
  std::chrono::milliseconds timeout_;
  std::chrono::steady_clock::time_point patience_;
  typename Client::SharedPtr client_;
  typename rclcpp::Subscription<FeedbackMessage>::SharedPtr heard_;
  std::deque<FeedbackMessage> early_;
  std::function<std::vector<rclcpp::TopicEndpointInfo>()> servers_;
  std::vector<rclcpp::TopicEndpointInfo> server_;
  std::string limit_;
  std::string fault_;
  Goal goal_;
  Handle handle_;
  Phase phase_ = Phase::idle;
  bool matters_ = false;
  bool to_cancel_ = false;
  std::uint64_t number_ = 0;
  Countdown deadline_;
  Countdown search_;
  Countdown watch_;
  Countdown lost_;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_CLIENT_HPP_
