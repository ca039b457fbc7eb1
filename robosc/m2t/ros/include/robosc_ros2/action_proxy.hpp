// Hands goals of an action on that the supervisor lets through.
#ifndef ROBOSC_ROS2_ACTION_PROXY_HPP_
#define ROBOSC_ROS2_ACTION_PROXY_HPP_

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <action_msgs/msg/goal_status.hpp>
#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc_ros2/clock.hpp"

namespace robosc {
inline namespace v1 {

/// An action for the controller behind which stands the robot's one: its three services and two topics, one by one, so
/// that goals keep their identity. One goal runs at a time; another one is rejected until that has ended.
template <typename Type>
class ActionProxy {
 public:
  using Goal = typename Type::Goal;
  using Feedback = typename Type::Feedback;
  using Result = typename Type::Result;

  /// What the supervisor has to say and to hear. After `cancel` it hears no more of that goal.
  struct Handlers {
    std::function<bool(const Goal&)> goal;            ///< Whether a goal goes on.
    std::function<void()> busy;                       ///< A goal is rejected because another one has not ended.
    std::function<void(const Feedback&)> feedback;    ///< The goal at hand goes on.
    std::function<void(const Result&)> response;      ///< It has succeeded.
    std::function<void(const std::string&)> error;    ///< It has not, and why.
    std::function<void(const std::string&)> refused;  ///< The robot does not cancel it.
  };

  /// `quality`: of the feedback that the robot sends.
  ActionProxy(rclcpp::Node& node, const CallbackGuard& guard, const std::string& controller_side,
              const std::string& robot_side, const rclcpp::QoS& quality, std::chrono::milliseconds timeout,
              Handlers handlers)
      : guard_(guard),
        clock_(waiting_clock(node)),
        timeout_(timeout),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        handlers_(std::move(handlers)) {
    const std::string inside = controller_side + "/_action/", outside = robot_side + "/_action/";
    const rclcpp::QoS lasting = rclcpp::QoS(1).transient_local();

    goal_client_ = node.create_client<SendGoal>(outside + "send_goal");
    result_client_ = node.create_client<GetResult>(outside + "get_result");
    cancel_client_ = node.create_client<CancelGoal>(outside + "cancel_goal");
    feedback_publisher_ = node.create_publisher<FeedbackMessage>(inside + "feedback", rclcpp::QoS(quality.depth()));
    status_publisher_ = node.create_publisher<StatusArray>(inside + "status", lasting);

    feedback_subscription_ = node.create_subscription<FeedbackMessage>(
        outside + "feedback", quality,
        guard([this](std::shared_ptr<const FeedbackMessage> message) { on_feedback(*message); }));
    status_subscription_ = node.create_subscription<StatusArray>(
        outside + "status", lasting,
        guard([this](std::shared_ptr<const StatusArray> message) { on_status(*message); }));
    goal_service_ = node.create_service<SendGoal>(
        inside + "send_goal",
        guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<typename SendGoal::Request> request) {
          on_goal(*caller, std::move(request));
        }));
    result_service_ = node.create_service<GetResult>(
        inside + "get_result",
        guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<typename GetResult::Request> request) {
          on_result_wanted(*caller, request->goal_id.uuid);
        }));
    cancel_service_ = node.create_service<CancelGoal>(
        inside + "cancel_goal",
        guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<typename CancelGoal::Request> request) {
          on_cancel(*caller, std::move(request));
        }));
    timer_ = rclcpp::create_timer(&node, clock_, kLook, guard([this] { look(); }));
    timer_->cancel();
  }

  /// Cancels the goal at hand, if there is one; before the robot has accepted it, as soon as it does.
  void cancel() {
    if (!goal_ || goal_->cancelled) return;
    goal_->cancelled = true;
    if (goal_->accepted) send_cancel(goal_->id);
  }

 private:
  using SendGoal = typename Type::Impl::SendGoalService;
  using GetResult = typename Type::Impl::GetResultService;
  using CancelGoal = typename Type::Impl::CancelGoalService;
  using FeedbackMessage = typename Type::Impl::FeedbackMessage;
  using StatusArray = typename Type::Impl::GoalStatusMessage;
  using Status = action_msgs::msg::GoalStatus;
  using Id = std::array<std::uint8_t, 16>;

  struct Running {
    Id id;
    rmw_request_id_t caller;
    std::shared_ptr<typename SendGoal::Request> request;
    rclcpp::Time deadline;
    bool sent = false;
    bool accepted = false;
    bool cancelled = false;
    std::vector<rmw_request_id_t> waiting_for_result = {};
  };

  struct Ended {
    Id id;
    typename GetResult::Response result;
  };

  /// A request to cancel that the robot has not answered; of the controller where there is a `caller`.
  struct Cancelling {
    std::uint64_t number;
    std::int64_t request;
    std::optional<rmw_request_id_t> caller;
    rclcpp::Time deadline;
  };

  // From the controller.

  void on_goal(const rmw_request_id_t& caller, std::shared_ptr<typename SendGoal::Request> request) {
    if (goal_) {
      handlers_.busy();
      answer_goal(caller, typename SendGoal::Response());
      return;
    }
    goal_ = Running{request->goal_id.uuid, caller, request, clock_->now() + timeout_};
    if (handlers_.goal(request->goal)) {
      timer_->reset();
      look();
    } else {
      goal_.reset();
      answer_goal(caller, typename SendGoal::Response());
    }
  }

  void on_result_wanted(const rmw_request_id_t& caller, const Id& id) {
    if (is_running(id)) {
      goal_->waiting_for_result.push_back(caller);
    } else if (ended_ && ended_->id == id) {
      answer_result(caller, ended_->result);
    } else {
      answer_result(caller, typename GetResult::Response());  // status: unknown
    }
  }

  // The controller's own requests to cancel always pass.
  void on_cancel(const rmw_request_id_t& caller, std::shared_ptr<typename CancelGoal::Request> request) {
    if (!cancel_client_->service_is_ready() || !ask_to_cancel(request, caller)) reject_cancel(caller);
  }

  // From the robot.

  void on_accepted(const Id& id, const typename SendGoal::Response& response) {
    if (!is_running(id) || goal_->accepted) {
      if (response.accepted) send_cancel(id);  // too late: nobody waits for it
      return;
    }
    if (!response.accepted) {
      fail("rejected");
      return;
    }
    answer_goal(goal_->caller, response);
    goal_->accepted = true;
    goal_->deadline = clock_->now() + timeout_;
    auto request = std::make_shared<typename GetResult::Request>();
    request->goal_id.uuid = id;
    const auto asked =
        ask<GetResult>(*result_client_, request, [this, id](const typename GetResult::Response& response) {
          if (is_running(id)) on_result(response);
        });
    if (goal_->cancelled || !asked) send_cancel(id);
    if (!asked) fail("its result can't be asked for");
  }

  void on_feedback(const FeedbackMessage& message) {
    if (!is_running(message.goal_id.uuid)) return;
    if (!goal_->cancelled) handlers_.feedback(message.feedback);
    feedback_publisher_->publish(message);
  }

  void on_result(const typename GetResult::Response& response) {
    if (!goal_->cancelled) {
      if (response.status == Status::STATUS_SUCCEEDED) {
        handlers_.response(response.result);
      } else {
        handlers_.error(response.status == Status::STATUS_CANCELED ? "cancelled" : "aborted");
      }
    }
    finish(response);
  }

  // That a goal has ended is told with its result, not before: the supervisor knows first.
  void on_status(const StatusArray& message) {
    statuses_.status_list.clear();
    for (const auto& status : message.status_list) {
      const Id& id = status.goal_info.goal_id.uuid;
      if (ended_ && ended_->id == id) {
        statuses_.status_list.push_back(status);
      } else if (is_running(id)) {
        statuses_.status_list.push_back(status);
        if (status.status > Status::STATUS_CANCELING) statuses_.status_list.back().status = Status::STATUS_EXECUTING;
      }
    }
    status_publisher_->publish(statuses_);
  }

  // Waiting.

  void look() {
    const rclcpp::Time now = clock_->now();
    forget_cancels(now);
    if (!goal_) {
      if (cancels_.empty()) timer_->cancel();
      return;
    }
    if (goal_->cancelled && !goal_->sent) {
      fail("cancelled before it was sent");
      return;
    }
    if (!goal_->sent && goal_client_->service_is_ready()) {
      const Id id = goal_->id;
      goal_->sent =
          ask<SendGoal>(*goal_client_, goal_->request, [this, id](const typename SendGoal::Response& response) {
            on_accepted(id, response);
          }).has_value();
      if (goal_->sent) return;
    }
    if (goal_->accepted && result_client_->service_is_ready()) goal_->deadline = now + timeout_;
    if (now < goal_->deadline) return;
    fail(goal_->accepted ? "the server is gone" : (goal_->sent ? "not accepted" : "no server") + within_);
  }

  void fail(const std::string& why) {
    if (!goal_->cancelled) handlers_.error(why);
    if (!goal_->accepted) answer_goal(goal_->caller, typename SendGoal::Response());
    typename GetResult::Response response;
    response.status = Status::STATUS_ABORTED;
    finish(response);
  }

  void finish(const typename GetResult::Response& response) {
    const Running goal = *goal_;
    goal_.reset();
    result_client_->prune_pending_requests();
    // One that is accepted late is cancelled; so long after its time for acceptance is over it is taken for lost.
    const auto patience = timeout_.to_chrono<std::chrono::milliseconds>() + std::chrono::seconds(30);
    goal_client_->prune_requests_older_than(std::chrono::system_clock::now() - patience);
    ended_ = Ended{goal.id, response};
    for (auto& status : statuses_.status_list) {
      if (caller.goal_info.goal_id.uuid == goal.id) caller.status = response.status;
    }
    if (goal.accepted) status_publisher_->publish(statuses_);
    for (const rmw_request_id_t& caller : goal.waiting_for_result) answer_result(caller, response);
  }

  void send_cancel(const Id& id) {
    auto request = std::make_shared<typename CancelGoal::Request>();
    request->goal_info.goal_id.uuid = id;
    if (!ask_to_cancel(request, std::nullopt)) handlers_.refused("the request to cancel the goal can't be sent");
  }

  bool ask_to_cancel(std::shared_ptr<typename CancelGoal::Request> request, std::optional<rmw_request_id_t> caller) {
    const auto sent = ask<CancelGoal>(
        *cancel_client_, request,
        [this, caller, number = ++cancel_number_](const typename CancelGoal::Response& response) {
          cancels_.erase(std::remove_if(cancels_.begin(), cancels_.end(),
                                        [number](const Cancelling& waiting) { return waiting.number == number; }),
                         cancels_.end());
          if (caller) {
            answer_cancel(*caller, response);
          } else {
            on_cancelling(response);
          }
        });
    if (!sent) return false;
    cancels_.push_back({cancel_number_, *sent, caller, clock_->now() + timeout_});
    timer_->reset();
    return true;
  }

  void on_cancelling(const typename CancelGoal::Response& response) {
    using Answer = typename CancelGoal::Response;
    // A goal that has ended meanwhile needs none.
    const bool none = response.return_code == Answer::ERROR_NONE && response.goals_canceling.empty();
    if (none || response.return_code == Answer::ERROR_REJECTED) {
      handlers_.refused("the server refuses to cancel the goal");
    }
  }

  /// Nobody waits longer for what the robot does not answer.
  void forget_cancels(const rclcpp::Time& now) {
    while (!cancels_.empty() && cancels_.front().deadline <= now) {
      const Cancelling late = cancels_.front();
      cancels_.pop_front();
      cancel_client_->remove_pending_request(late.request);
      if (late.caller) {
        reject_cancel(*late.caller);
      } else {
        handlers_.refused("the server does not answer the request to cancel the goal" + within_);
      }
    }
  }

  void reject_cancel(const rmw_request_id_t& caller) {
    typename CancelGoal::Response response;
    response.return_code = CancelGoal::Response::ERROR_REJECTED;
    answer_cancel(caller, response);
  }

  /// Sends a request; its number for rclcpp, or nothing where it can't be sent.
  template <typename Service, typename Answered>
  std::optional<std::int64_t> ask(rclcpp::Client<Service>& client, std::shared_ptr<typename Service::Request> request,
                                  Answered answered) {
    try {
      return client
          .async_send_request(request, guard_([answered](typename rclcpp::Client<Service>::SharedFuture answer) {
                                answered(*answer.get());
                              }))
          .request_id;
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

  bool is_running(const Id& id) const { return goal_ && goal_->id == id; }

  void answer_goal(rmw_request_id_t caller, typename SendGoal::Response response) {
    goal_service_->send_response(caller, response);
  }
  void answer_result(rmw_request_id_t caller, typename GetResult::Response response) {
    result_service_->send_response(caller, response);
  }
  void answer_cancel(rmw_request_id_t caller, typename CancelGoal::Response response) {
    cancel_service_->send_response(caller, response);
  }

  const CallbackGuard& guard_;
  rclcpp::Clock::SharedPtr clock_;
  rclcpp::Duration timeout_;
  std::string within_;
  Handlers handlers_;
  std::shared_ptr<rclcpp::Client<SendGoal>> goal_client_;
  std::shared_ptr<rclcpp::Client<GetResult>> result_client_;
  std::shared_ptr<rclcpp::Client<CancelGoal>> cancel_client_;
  std::shared_ptr<rclcpp::Publisher<FeedbackMessage>> feedback_publisher_;
  std::shared_ptr<rclcpp::Publisher<StatusArray>> status_publisher_;
  std::shared_ptr<rclcpp::Subscription<FeedbackMessage>> feedback_subscription_;
  std::shared_ptr<rclcpp::Subscription<StatusArray>> status_subscription_;
  std::shared_ptr<rclcpp::Service<SendGoal>> goal_service_;
  std::shared_ptr<rclcpp::Service<GetResult>> result_service_;
  std::shared_ptr<rclcpp::Service<CancelGoal>> cancel_service_;
  rclcpp::TimerBase::SharedPtr timer_;
  std::optional<Running> goal_;
  std::optional<Ended> ended_;
  std::deque<Cancelling> cancels_;  ///< The oldest first.
  std::uint64_t cancel_number_ = 0;
  StatusArray statuses_;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_PROXY_HPP_
