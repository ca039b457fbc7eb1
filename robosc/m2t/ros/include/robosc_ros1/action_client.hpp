// Client of an action.
#ifndef ROBOSC_ROS1_ACTION_CLIENT_HPP_
#define ROBOSC_ROS1_ACTION_CLIENT_HPP_

#include <chrono>
#include <string>
#include <utility>

#include <actionlib/client/action_client.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include "robosc/goal_client.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A client of one action over actionlib. All functions run in the thread that serves the node's callback queue.
template <typename Type>
class ActionClient : public GoalClient<Countdown, typename Type::_action_feedback_type::_feedback_type,
                                       typename Type::_action_result_type::_result_type> {
 public:
  ACTION_DEFINITION(Type)
  using Base = GoalClient<Countdown, Feedback, Result>;

  ActionClient(ros::NodeHandle& node, const std::string& name, std::chrono::milliseconds timeout,
               typename Base::Handlers handlers)
      // ROS 1 does not answer requests to cancel. So there is no refusal after which to repeat one.
      : Base(timeout, std::chrono::milliseconds(0), std::move(handlers), node),
        name_(node.resolveName(name)),
        client_(node, name, node.getCallbackQueue()) {}

  ~ActionClient() override { stop(); }  // NOLINT(bugprone-exception-escape): locks of boost, should they fail

  /// Sends a goal once there is a server. Gives up a goal that has not ended.
  void start(const Goal& goal) {
    stop();
    waiting_ = goal;
    this->begin();
  }

  /// Gives up the goal: requests its server to cancel it. No handler follows.
  void stop() {
    if (this->busy() && this->phase() != Phase::waiting) goal_.cancel();
    this->forget();
  }

 private:
  using Client = actionlib::ActionClient<Type>;
  using GoalHandle = typename Client::GoalHandle;
  using CommState = actionlib::CommState;
  using TerminalState = actionlib::TerminalState;
  using Phase = typename Base::Phase;

  // Checks that a server may miss: after its restart from a crash, only parts of it are visible for a moment.
  static constexpr int kPatience = 10;

  bool is_served() override {
    const bool connected = client_.isServerConnected();
    missed_ = connected ? 0 : missed_ + 1;
    if (connected && !lost_.isExpired() && lost_.getCommState() != CommState::WAITING_FOR_CANCEL_ACK) lost_.cancel();
    return connected;
  }

  bool is_gone() override {
    if (missed_ <= kPatience) return false;
    lost_ = goal_;  // canceled if the server comes back with it
    return true;
  }

  /// In ROS 1, the end of a goal is final when the server reports it.
  bool is_canceling() override { return false; }

  bool keeps_looking() const override { return !lost_.isExpired(); }

  bool send() override {
    goal_ = client_.sendGoal(
        waiting_, [this](GoalHandle goal) { follow(goal); },
        [this](GoalHandle goal, const FeedbackConstPtr& feedback) { receive(goal, *feedback); });
    return true;
  }

  void request_cancel() override { goal_.cancel(); }
  void reset() override { goal_.reset(); }
  void warn(const std::string& text) override { ROS_WARN("%s: %s", name_.c_str(), text.c_str()); }

  void follow(const GoalHandle& goal) {
    if (goal == lost_ && lost_.getCommState() == CommState::DONE) lost_.reset();
    if (!this->busy() || goal != goal_) return;
    switch (goal_.getCommState().state_) {
      case CommState::PENDING:
        this->know();
        break;
      case CommState::ACTIVE:
        this->accept();
        break;
      case CommState::RECALLING:
      case CommState::PREEMPTING:
        this->cancel_answered(CancelAnswer::accepted);
        break;
      case CommState::WAITING_FOR_RESULT:
        this->await_result();
        break;
      case CommState::DONE:
        finish();
        break;
      default:
        break;
    }
  }

  void receive(const GoalHandle& goal, const Feedback& feedback) {
    if (!this->busy() || goal != goal_) return;
    this->accept();  // feedback may overtake the status
    this->hear(feedback);
  }

  void finish() {
    const TerminalState state = goal_.getTerminalState();
    const ResultConstPtr result = goal_.getResult();
    const std::string text = state.getText().empty() ? "" : " (" + state.getText() + ")";
    const Result ended = result ? *result : Result();
    switch (state.state_) {
      case TerminalState::SUCCEEDED:
        return result ? this->succeed(*result) : this->lose(text);
      case TerminalState::REJECTED:
        return this->fail(Failure::rejected, "rejected" + text);
      case TerminalState::ABORTED:
        return this->abort(text, ended);
      case TerminalState::RECALLED:
      case TerminalState::PREEMPTED:
        return this->canceled(text, ended);
      default:
        return this->lose(text);
    }
  }

  const std::string name_;
  int missed_ = 0;
  Goal waiting_;
  Client client_;
  GoalHandle goal_;
  GoalHandle lost_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_ACTION_CLIENT_HPP_
