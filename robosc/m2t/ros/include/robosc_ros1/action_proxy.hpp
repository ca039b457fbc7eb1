// Hands goals of an action on that the supervisor lets through.
#ifndef ROBOSC_ROS1_ACTION_PROXY_HPP_
#define ROBOSC_ROS1_ACTION_PROXY_HPP_

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <ros/ros.h>
#include <boost/make_shared.hpp>

#include "robosc/goal_proxy.hpp"
#include "robosc/queue_depth.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The five topics of an action towards the controller, behind which stand those of the robot.
template <typename Type>
class ActionProxy : public GoalProxy<Countdown, typename Type::_action_goal_type::_goal_type,
                                     typename Type::_action_feedback_type::_feedback_type,
                                     typename Type::_action_result_type::_result_type> {
 public:
  using ActionGoal = typename Type::_action_goal_type;
  using ActionFeedback = typename Type::_action_feedback_type;
  using ActionResult = typename Type::_action_result_type;
  using Base = GoalProxy<Countdown, typename ActionGoal::_goal_type, typename ActionFeedback::_feedback_type,
                         typename ActionResult::_result_type>;

  ActionProxy(ros::NodeHandle& node, const std::string& controller_side, const std::string& robot_side,
              std::chrono::milliseconds timeout, typename Base::Handlers handlers)
      // There is no answer to a request to cancel in ROS 1, and so no refusal that another one would follow.
      : Base(timeout, std::chrono::milliseconds(0), std::move(handlers), node),
        node_(node),
        timeout_(std::chrono::duration<double>(timeout).count()) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    goal_publisher_ = node_.advertise<ActionGoal>(robot_side + "/goal", kQueueDepth);
    cancel_publisher_ = node_.advertise<actionlib_msgs::GoalID>(robot_side + "/cancel", kQueueDepth);
    status_publisher_ = node_.advertise<actionlib_msgs::GoalStatusArray>(controller_side + "/status", kQueueDepth);
    feedback_publisher_ = node_.advertise<ActionFeedback>(controller_side + "/feedback", kQueueDepth);
    result_publisher_ = node_.advertise<ActionResult>(controller_side + "/result", kQueueDepth);

    goal_subscription_ = node_.subscribe(controller_side + "/goal", kQueueDepth, &ActionProxy::on_goal, this, hints);
    cancel_subscription_ =
        node_.subscribe(controller_side + "/cancel", kQueueDepth, &ActionProxy::on_cancel, this, hints);
    status_subscription_ = node_.subscribe(robot_side + "/status", kQueueDepth, &ActionProxy::on_status, this, hints);
    feedback_subscription_ =
        node_.subscribe(robot_side + "/feedback", kQueueDepth, &ActionProxy::on_feedback, this, hints);
    result_subscription_ = node_.subscribe(robot_side + "/result", kQueueDepth, &ActionProxy::on_result, this, hints);
  }

 private:
  using Status = actionlib_msgs::GoalStatus;

  // From the controller.

  void on_goal(const ActionGoal& message) {
    const bool busy = this->running();
    const bool admitted = this->admit(message.goal, [this, &message] {
      message_ = message;
      status_ = Status::PENDING;
      cancels_before_.clear();
      if (!message.goal_id.id.empty()) return;
      // The server would name it, and the layer would not know it again.
      const ros::Time time = ros::Time::now();
      message_.goal_id.id =
          ros::this_node::getName() + "-" + std::to_string(time.sec) + "." + std::to_string(time.nsec);
    });
    if (admitted) {
      this->look();
    } else {
      const char* why = busy ? "the goal before has not ended" : "the supervisor does not allow it";
      publish_result(message.goal_id, Status::REJECTED, why);
    }
  }

  // The controller's own requests to cancel always pass.
  void on_cancel(const actionlib_msgs::GoalID& message) {
    if (this->running() && !this->sent()) {
      cancels_before_.push_back(message);
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
    bool under_way = false;
    for (const Status& status : message.status_list) {
      if (!ended_.empty() && status.goal_id.id == ended_) {
        known.status_list.push_back(status);
      } else if (is_running(status.goal_id)) {
        if (!is_terminal(status.status)) {
          status_ = status.status;
          under_way = true;
        }
        if (status.status == Status::PREEMPTING || status.status == Status::RECALLING) {
          this->cancel_answered(CancelAnswer::accepted);
        }
        if (status.status != Status::PENDING && status.status != Status::RECALLING &&
            status.status != Status::REJECTED) {
          this->accept();
        }
        known.status_list.push_back(status);
        known.status_list.back().status = status_;
        listed = true;
      }
    }
    if (this->running() && !listed) {
      // Even one that the robot does not know: the controller hears its end.
      known.status_list.emplace_back();
      known.status_list.back().goal_id = message_.goal_id;
      known.status_list.back().status = status_;
    }
    if (under_way) {
      this->resume();
    } else if (this->running() && this->accepted()) {
      this->await_result();
    }
    status_publisher_.publish(known);
  }

  void on_feedback(const ActionFeedback& message) {
    if (!is_running(message.status.goal_id)) return;
    this->hear(message.feedback);
    feedback_publisher_.publish(message);
  }

  void on_result(const ActionResult& message) {
    if (!is_running(message.status.goal_id)) return;
    conclude();
    switch (message.status.status) {
      case Status::SUCCEEDED:
        this->succeed(message.result);
        break;
      case Status::PREEMPTED:
      case Status::RECALLED:
        this->canceled(message.result);
        break;
      case Status::REJECTED:
        this->reject(message.result);
        break;
      case Status::ABORTED:
        this->abort(message.result);
        break;
      default:
        this->lose();
        break;
    }
    result_publisher_.publish(message);
  }

  // Waiting.

  bool is_canceling() override { return false; }  // a robot of ROS 1 has ended a goal where it says so

  bool is_served() override {
    return goal_publisher_.getNumSubscribers() > 0 && cancel_publisher_.getNumSubscribers() > 0 &&
           result_subscription_.getNumPublishers() > 0;
  }

  bool send() override {
    goal_publisher_.publish(message_);
    for (const auto& request : cancels_before_) cancel_publisher_.publish(request);
    return true;
  }

  void send_cancel() override {
    actionlib_msgs::GoalID id;  // without a time, which would cancel other goals, too
    id.id = message_.goal_id.id;
    cancel_publisher_.publish(id);
  }

  void restart(std::chrono::milliseconds more = std::chrono::milliseconds(0)) override {
    end_ = Timer::now() + timeout_ + std::chrono::duration<double>(more).count();
    look_.start();
  }
  bool is_over() override { return Timer::now() >= end_; }

  // A robot that has the goal, or gets it yet, is told to cancel it.
  void abandon(const std::string& why) override {
    if (this->sent()) send_cancel();
    conclude();
    publish_result(message_.goal_id, this->accepted() ? Status::ABORTED : Status::REJECTED, why);
  }

  void conclude() {
    ended_ = message_.goal_id.id;
    this->finish();
    look_.stop();
  }

  void publish_result(const actionlib_msgs::GoalID& goal, std::uint8_t status, const std::string& why) {
    const auto message = boost::make_shared<ActionResult>();
    message->header.stamp = ros::Time::now();
    message->status.goal_id = goal;
    message->status.status = status;
    message->status.text = why;
    result_publisher_.publish(message);
  }

  bool is_running(const actionlib_msgs::GoalID& goal) const {
    return this->running() && message_.goal_id.id == goal.id;
  }

  static bool is_terminal(std::uint8_t status) {
    return status != Status::PENDING && status != Status::ACTIVE && status != Status::PREEMPTING &&
           status != Status::RECALLING;
  }

  ros::NodeHandle node_;
  double timeout_;
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
  Timer look_{node_, std::chrono::milliseconds(20), [this] { this->look(); }};
  double end_ = 0.0;
  ActionGoal message_;
  std::uint8_t status_ = Status::PENDING;
  std::vector<actionlib_msgs::GoalID> cancels_before_;
  std::string ended_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_ACTION_PROXY_HPP_
