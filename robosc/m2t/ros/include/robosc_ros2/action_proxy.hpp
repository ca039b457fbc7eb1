// Forwarded goals of an action that the supervisor permits.
#ifndef ROBOSC_ROS2_ACTION_PROXY_HPP_
#define ROBOSC_ROS2_ACTION_PROXY_HPP_

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <action_msgs/msg/goal_status.hpp>
#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/goal_proxy.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/action_servers.hpp"
#include "robosc_ros2/cancel_answer.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The three services and two topics of an action for the controller, which forward to those of the robot.
template <typename Type>
class ActionProxy : public GoalProxy<Countdown, typename Type::Goal, typename Type::Feedback, typename Type::Result> {
 public:
  using Base = GoalProxy<Countdown, typename Type::Goal, typename Type::Feedback, typename Type::Result>;

  /// `quality`: quality of service of the robot's feedback.
  ActionProxy(rclcpp::Node& node, const CallbackGuard& guard, const std::string& controller_side,
              const std::string& robot_side, const rclcpp::QoS& quality, std::chrono::milliseconds timeout,
              typename Base::Handlers handlers)
      : Base(timeout, timeout, std::move(handlers), node, guard),
        guard_(guard),
        clock_(waiting_clock(node)),
        timeout_(timeout),
        servers_(node, robot_side),
        look_(node, guard, kLook, [this] { look_after(); }) {
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
  }

 private:
  using SendGoal = typename Type::Impl::SendGoalService;
  using GetResult = typename Type::Impl::GetResultService;
  using CancelGoal = typename Type::Impl::CancelGoalService;
  using FeedbackMessage = typename Type::Impl::FeedbackMessage;
  using StatusArray = typename Type::Impl::GoalStatusMessage;
  using Status = action_msgs::msg::GoalStatus;
  using Id = std::array<std::uint8_t, 16>;

  struct Ended {
    Id id;
    typename GetResult::Response result;
  };

  /// A request of the controller to cancel without an answer of the robot.
  struct Cancelling {
    std::uint64_t number;
    std::int64_t request;
    rmw_request_id_t caller;
    rclcpp::Time deadline;
  };

  // Messages from the controller.

  void on_goal(const rmw_request_id_t& caller, std::shared_ptr<typename SendGoal::Request> request) {
    const bool admitted = this->admit(request->goal, [this, &caller, &request] {
      id_ = request->goal_id.uuid;
      caller_ = caller;
      request_ = request;
      waiting_for_result_.clear();
    });
    if (admitted) {
      look_.start();
      this->look();
    } else {
      answer_goal(caller, typename SendGoal::Response());
    }
  }

  void on_result_wanted(const rmw_request_id_t& caller, const Id& id) {
    if (is_running(id)) {
      waiting_for_result_.push_back(caller);
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

  // Messages from the robot.

  void on_accepted(const Id& id, const typename SendGoal::Response& response) {
    if (!is_running(id) || this->accepted()) {
      if (response.accepted) cancel_goal(id);  // too late: the controller no longer waits for it
      return;
    }
    if (!response.accepted) return this->fail(Failure::rejected, "rejected");
    answer_goal(caller_, response);
    auto request = std::make_shared<typename GetResult::Request>();
    request->goal_id.uuid = id;
    const auto asked =
        ask<GetResult>(*result_client_, request, [this, id](const typename GetResult::Response& response) {
          if (is_running(id)) on_result(response);
        });
    this->accept();
    if (asked) return;
    send_cancel();
    this->fail(Failure::lost, "its result cannot be requested");
  }

  void on_feedback(const FeedbackMessage& message) {
    if (!is_running(message.goal_id.uuid)) return;
    this->hear(message.feedback);
    feedback_publisher_->publish(message);
  }

  void on_result(const typename GetResult::Response& response) {
    this->finish();
    switch (response.status) {
      case Status::STATUS_SUCCEEDED:
        this->succeed(response.result);
        break;
      case Status::STATUS_CANCELED:
        this->canceled(response.result);
        break;
      case Status::STATUS_ABORTED:
        this->abort(response.result);
        break;
      default:
        this->lose();
        break;
    }
    conclude(response);
  }

  // Reports the end of a goal only with its result, so that the supervisor handles it first.
  void on_status(const StatusArray& message) {
    statuses_.status_list.clear();
    for (const auto& status : message.status_list) {
      const Id& id = status.goal_info.goal_id.uuid;
      if (ended_ && ended_->id == id) {
        statuses_.status_list.push_back(status);
      } else if (is_running(id)) {
        status_ = status.status;
        statuses_.status_list.push_back(status);
        if (status.status > Status::STATUS_CANCELING) statuses_.status_list.back().status = Status::STATUS_EXECUTING;
      }
    }
    status_publisher_->publish(statuses_);
  }

  // Deadlines.

  void look_after() {
    forget_cancels(clock_->now());
    this->look();
    if (this->running() || !cancels_.empty()) look_.start();
  }

  bool is_canceling() override { return status_ == Status::STATUS_CANCELING; }

  /// Checks `servers_`, too, because the services of a restarted server do not differ from those of the previous one.
  bool is_served() override { return this->accepted() ? !servers_.are_gone() : goal_client_->service_is_ready(); }

  bool send() override {
    servers_.remember();
    status_ = Status::STATUS_UNKNOWN;
    const auto answered = [this, id = id_](const typename SendGoal::Response& response) { on_accepted(id, response); };
    return ask<SendGoal>(*goal_client_, request_, answered).has_value();
  }

  void send_cancel() override { cancel_goal(id_); }
  void restart(std::chrono::milliseconds more = std::chrono::milliseconds(0)) override {
    deadline_ = clock_->now() + timeout_ + rclcpp::Duration(more);
  }
  bool is_over() override { return clock_->now() >= deadline_; }

  void abandon() override {
    if (!this->accepted()) answer_goal(caller_, typename SendGoal::Response());
    typename GetResult::Response response;
    response.status = Status::STATUS_ABORTED;
    conclude(response);
  }

  void conclude(const typename GetResult::Response& response) {
    this->finish();
    result_client_->prune_pending_requests();
    // A goal that is accepted late is canceled. After this time past the deadline for acceptance, it counts as lost.
    const auto patience = timeout_.to_chrono<std::chrono::milliseconds>() + std::chrono::seconds(30);
    goal_client_->prune_requests_older_than(std::chrono::system_clock::now() - patience);
    cancel_client_->prune_requests_older_than(std::chrono::system_clock::now() - patience);
    ended_ = Ended{id_, response};
    for (auto& status : statuses_.status_list) {
      if (status.goal_info.goal_id.uuid == id_) status.status = response.status;
    }
    if (this->accepted()) status_publisher_->publish(statuses_);
    for (const rmw_request_id_t& caller : std::exchange(waiting_for_result_, {})) answer_result(caller, response);
  }

  void cancel_goal(const Id& id) {
    auto request = std::make_shared<typename CancelGoal::Request>();
    request->goal_info.goal_id.uuid = id;
    ask<CancelGoal>(*cancel_client_, request, [this, id](const typename CancelGoal::Response& response) {
      if (is_running(id)) this->cancel_answered(cancel_answer(response, id));
    });
  }

  bool ask_to_cancel(std::shared_ptr<typename CancelGoal::Request> request, const rmw_request_id_t& caller) {
    const auto sent = ask<CancelGoal>(
        *cancel_client_, request,
        [this, caller, number = ++cancel_number_](const typename CancelGoal::Response& response) {
          cancels_.erase(std::remove_if(cancels_.begin(), cancels_.end(),
                                        [number](const Cancelling& waiting) { return waiting.number == number; }),
                         cancels_.end());
          answer_cancel(caller, response);
        });
    if (!sent) return false;
    cancels_.push_back({cancel_number_, *sent, caller, clock_->now() + timeout_});
    look_.start();
    return true;
  }

  /// Rejects the controller's requests to cancel that the robot does not answer in time.
  void forget_cancels(const rclcpp::Time& now) {
    while (!cancels_.empty() && cancels_.front().deadline <= now) {
      const Cancelling late = cancels_.front();
      cancels_.pop_front();
      cancel_client_->remove_pending_request(late.request);
      reject_cancel(late.caller);
    }
  }

  void reject_cancel(const rmw_request_id_t& caller) {
    typename CancelGoal::Response response;
    response.return_code = CancelGoal::Response::ERROR_REJECTED;
    answer_cancel(caller, response);
  }

  /// Sends a request. Returns its number in rclcpp, or nothing if it can't be sent.
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

  bool is_running(const Id& id) const { return this->running() && id_ == id; }

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
  ActionServers servers_;
  Countdown look_;
  std::int8_t status_ = Status::STATUS_UNKNOWN;  ///< Status of the current goal, as the robot reports it.
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
  Id id_ = {};
  rmw_request_id_t caller_ = {};
  std::shared_ptr<typename SendGoal::Request> request_;
  rclcpp::Time deadline_;
  std::vector<rmw_request_id_t> waiting_for_result_;
  std::optional<Ended> ended_;
  std::deque<Cancelling> cancels_;  ///< The oldest first.
  std::uint64_t cancel_number_ = 0;
  StatusArray statuses_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_PROXY_HPP_
