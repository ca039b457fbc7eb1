// Hands goals of an action on that the supervisor lets through.
#ifndef ROBOSC_ROS1_ACTION_PROXY_HPP_
#define ROBOSC_ROS1_ACTION_PROXY_HPP_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <ros/ros.h>
#include <boost/make_shared.hpp>

#include "robosc_ros1/deadline.hpp"

namespace robosc {
inline namespace v1 {

/// An action for the controller behind which stands the robot's one: its five topics, one by one, so that goals keep
/// their identity. One goal runs at a time; another one is rejected until that has ended.
template <typename Type>
class ActionProxy {
 public:
  using ActionGoal = typename Type::_action_goal_type;
  using ActionFeedback = typename Type::_action_feedback_type;
  using ActionResult = typename Type::_action_result_type;
  using Goal = typename ActionGoal::_goal_type;
  using Feedback = typename ActionFeedback::_feedback_type;
  using Result = typename ActionResult::_result_type;

  /// What the supervisor has to say and to hear. After `cancel` it hears no more of that goal.
  struct Handlers {
    std::function<bool(const Goal&)> goal;            ///< Whether a goal goes on.
    std::function<void()> busy;                       ///< A goal is rejected because another one has not ended.
    std::function<void(const Feedback&)> feedback;    ///< The goal at hand goes on.
    std::function<void(const Result&)> response;      ///< It has succeeded.
    std::function<void(const std::string&)> error;    ///< It has not, and why.
    std::function<void(const std::string&)> refused;  ///< The robot does not cancel it.
  };

  ActionProxy(const std::string& controller_side, const std::string& robot_side, int timeout_ms, Handlers handlers)
      : timeout_(timeout_ms / 1000.0),
        within_(" within " + std::to_string(timeout_ms) + " ms"),
        handlers_(std::move(handlers)) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    goal_publisher_ = node_.advertise<ActionGoal>(robot_side + "/goal", 10);
    cancel_publisher_ = node_.advertise<actionlib_msgs::GoalID>(robot_side + "/cancel", 10);
    status_publisher_ = node_.advertise<actionlib_msgs::GoalStatusArray>(controller_side + "/status", 10);
    feedback_publisher_ = node_.advertise<ActionFeedback>(controller_side + "/feedback", 10);
    result_publisher_ = node_.advertise<ActionResult>(controller_side + "/result", 10);

    goal_subscription_ = node_.subscribe(controller_side + "/goal", 10, &ActionProxy::on_goal, this, hints);
    cancel_subscription_ = node_.subscribe(controller_side + "/cancel", 10, &ActionProxy::on_cancel, this, hints);
    status_subscription_ = node_.subscribe(robot_side + "/status", 10, &ActionProxy::on_status, this, hints);
    feedback_subscription_ = node_.subscribe(robot_side + "/feedback", 10, &ActionProxy::on_feedback, this, hints);
    result_subscription_ = node_.subscribe(robot_side + "/result", 10, &ActionProxy::on_result, this, hints);
  }

  /// Cancels the goal at hand, if there is one; before the robot has accepted it, as soon as it does.
  void cancel() {
    if (!goal_ || goal_->cancelled) return;
    goal_->cancelled = true;
    if (goal_->accepted) send_cancel(goal_->message.goal_id);
  }

 private:
  using Status = actionlib_msgs::GoalStatus;

  struct Running {
    explicit Running(const ActionGoal& received) : message(received) {}

    ActionGoal message;
    std::uint8_t status = Status::PENDING;
    bool sent = false;
    bool accepted = false;
    bool cancelled = false;
    bool refused = false;
    std::vector<actionlib_msgs::GoalID> cancels_before = {};
  };

  // From the controller.

  void on_goal(const ActionGoal& message) {
    if (goal_) {
      handlers_.busy();
      publish_result(message.goal_id, Status::REJECTED, "the goal before has not ended");
      return;
    }
    goal_ = std::make_unique<Running>(message);
    if (message.goal_id.id.empty()) {
      // The server would name it, and the layer would not know it again.
      const ros::Time time = ros::Time::now();
      goal_->message.goal_id.id =
          ros::this_node::getName() + "-" + std::to_string(time.sec) + "." + std::to_string(time.nsec);
    }
    if (handlers_.goal(message.goal)) {
      deadline_.start(timeout_);
      look();
    } else {
      goal_.reset();
      publish_result(message.goal_id, Status::REJECTED, "the supervisor does not allow it");
    }
  }

  // The controller's own requests to cancel always pass.
  void on_cancel(const actionlib_msgs::GoalID& message) {
    if (goal_ && !goal_->sent) {
      goal_->cancels_before.push_back(message);
    } else {
      cancel_publisher_.publish(message);
    }
  }

  // From the robot.

  // That a goal has ended is told with its result, not before: the supervisor knows first.
  void on_status(const actionlib_msgs::GoalStatusArray& message) {
    actionlib_msgs::GoalStatusArray known;
    known.header = message.header;
    bool listed = false;
    for (const Status& status : message.status_list) {
      if (!ended_.empty() && status.goal_id.id == ended_) {
        known.status_list.push_back(status);
      } else if (is_running(status.goal_id)) {
        if (!is_terminal(status.status)) goal_->status = status.status;
        if (status.status != Status::PENDING && status.status != Status::RECALLING &&
            status.status != Status::REJECTED) {
          accept();
        }
        known.status_list.push_back(status);
        known.status_list.back().status = goal_->status;
        listed = true;
      }
    }
    if (goal_ && !goal_->accepted && !listed) {
      // One that the robot has not heard of yet is not lost.
      known.status_list.emplace_back();
      known.status_list.back().goal_id = goal_->message.goal_id;
    }
    status_publisher_.publish(known);
  }

  void on_feedback(const ActionFeedback& message) {
    if (!is_running(message.status.goal_id)) return;
    if (!goal_->cancelled) handlers_.feedback(message.feedback);
    feedback_publisher_.publish(message);
  }

  void on_result(const ActionResult& message) {
    if (!is_running(message.status.goal_id)) return;
    if (goal_->cancelled) {
      // The supervisor counts it as over already.
    } else if (message.status.status == Status::SUCCEEDED) {
      handlers_.response(message.result);
    } else {
      handlers_.error(ending(message.status.status));
    }
    finish();
    result_publisher_.publish(message);
  }

  // Waiting.

  void look() {
    if (!goal_) return;
    const bool there = goal_publisher_.getNumSubscribers() > 0 && cancel_publisher_.getNumSubscribers() > 0 &&
                       result_subscription_.getNumPublishers() > 0;
    if (goal_->cancelled && !goal_->sent) {
      give_up("cancelled before it was sent");
    } else if (!goal_->sent && there) {
      goal_->sent = true;
      goal_publisher_.publish(goal_->message);
      for (const auto& request : goal_->cancels_before) cancel_publisher_.publish(request);
    } else if (goal_->accepted && there) {
      if (!goal_->cancelled) {
        deadline_.start(timeout_);
      } else if (deadline_.over() && !goal_->refused && goal_->status == Status::ACTIVE) {
        goal_->refused = true;
        handlers_.refused("the server refuses to cancel the goal");
      }
    } else if (deadline_.over()) {
      give_up(goal_->accepted ? "the server is gone" : (goal_->sent ? "not accepted" : "no server") + within_);
    }
  }

  // Nobody waits for the goal any more: a robot that has it, or gets it yet, is told to cancel it.
  void give_up(const std::string& why) {
    const actionlib_msgs::GoalID id = goal_->message.goal_id;
    if (goal_->sent) send_cancel(id);
    if (!goal_->cancelled) handlers_.error(why);
    const bool accepted = goal_->accepted;
    finish();
    publish_result(id, accepted ? Status::ABORTED : Status::REJECTED, why);
  }

  void accept() {
    if (goal_->accepted) return;
    goal_->accepted = true;
    deadline_.start(timeout_);
    if (goal_->cancelled) send_cancel(goal_->message.goal_id);
  }

  void finish() {
    ended_ = goal_->message.goal_id.id;
    goal_.reset();
    deadline_.stop();
  }

  void send_cancel(const actionlib_msgs::GoalID& goal) {
    actionlib_msgs::GoalID id;  // without a time, which would cancel other goals, too
    id.id = goal.id;
    deadline_.start(timeout_);
    cancel_publisher_.publish(id);
  }

  void publish_result(const actionlib_msgs::GoalID& goal, std::uint8_t status, const std::string& why) {
    const auto message = boost::make_shared<ActionResult>();
    message->header.stamp = ros::Time::now();
    message->status.goal_id = goal;
    message->status.status = status;
    message->status.text = why;
    result_publisher_.publish(message);
  }

  bool is_running(const actionlib_msgs::GoalID& goal) const { return goal_ && goal_->message.goal_id.id == goal.id; }

  static bool is_terminal(std::uint8_t status) {
    return status != Status::PENDING && status != Status::ACTIVE && status != Status::PREEMPTING &&
           status != Status::RECALLING;
  }

  static std::string ending(std::uint8_t status) {
    switch (status) {
      case Status::REJECTED:
        return "rejected";
      case Status::PREEMPTED:
      case Status::RECALLED:
        return "cancelled";
      default:
        return "aborted";
    }
  }

  ros::NodeHandle node_;
  double timeout_;
  std::string within_;
  Handlers handlers_;
  ros::Publisher goal_publisher_;
  ros::Publisher cancel_publisher_;
  ros::Publisher status_publisher_;
  ros::Publisher feedback_publisher_;
  ros::Publisher result_publisher_;
  ros::Subscriber goal_subscription_;
  ros::Subscriber cancel_subscription_;
  ros::Subscriber status_subscription_;
  ros::Subscriber feedback_subscription_;
  ros::Subscriber result_subscription_;
  Deadline deadline_{[this] { look(); }};
  std::unique_ptr<Running> goal_;
  std::string ended_;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS1_ACTION_PROXY_HPP_
