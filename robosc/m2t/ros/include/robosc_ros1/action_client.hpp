// Sends goals to an action server.
#ifndef ROBOSC_ROS1_ACTION_CLIENT_HPP_
#define ROBOSC_ROS1_ACTION_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <actionlib/client/action_client.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include "robosc_ros1/countdown.hpp"
#include "robosc_ros1/event_queue.hpp"

namespace robosc {
inline namespace v1 {

/// A client of one action, with one goal at a time. Everything runs on the thread that serves the node's callback
/// queue.
template <typename Type>
class ActionClient {
 public:
  ACTION_DEFINITION(Type)

  /// Any number of feedbacks follows a start, then exactly one of the others; never from inside `start` or `cancel`.
  struct Handlers {
    std::function<void(const Feedback&)> feedback;
    std::function<void(const Result&)> response;        // the goal has succeeded
    std::function<void(const std::string& why)> error;  // no server, not accepted in time, ended in any other way
    std::function<void()> ended;                        // a goal that was cancelled, or not accepted in time, is over
  };

  /// The timeout bounds the search for a server together with the wait for its acceptance, never the goal's work.
  ActionClient(ros::NodeHandle& node, const std::string& name, std::chrono::milliseconds timeout, Handlers handlers)
      : name_(node.resolveName(name)),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        handlers_(std::move(handlers)),
        events_(node),
        deadline_(node, timeout, [this] { expire(); }),
        next_look_(node, std::chrono::milliseconds(50), [this] { look(); }),
        client_(node, name, node.getCallbackQueue()) {}

  ~ActionClient() { stop(); }
  ActionClient(const ActionClient&) = delete;
  ActionClient& operator=(const ActionClient&) = delete;

  /// Whether a goal has not ended yet; until then no other may start.
  bool busy() const { return phase_ != Phase::idle; }

  /// Sends a goal as soon as there is a server. A goal that has not ended is given up.
  void start(const Goal& goal) {
    stop();
    ++number_;
    waiting_ = goal;
    phase_ = Phase::looking;
    deadline_.start();
    look();
  }

  /// Cancels the goal: where the server does not know it yet, as soon as it does. What it still says is dropped.
  void cancel() {
    if (!busy() || cancelled_) return;
    cancelled_ = true;
    interrupt();
  }

  /// Cancels the goal, but hands on what comes of it.
  void interrupt() {
    if (!busy() || interrupted_) return;
    interrupted_ = true;
    if (phase_ == Phase::looking) {
      const std::uint64_t number = number_;
      events_.push([this, number] {
        if (number == number_ && phase_ == Phase::looking) end(kOwn);
      });
    } else if (phase_ != Phase::sent) {
      ask_to_cancel();
    }
  }

  /// Gives up the goal: its server is told to cancel it, and nothing follows.
  void stop() {
    if (phase_ != Phase::idle && phase_ != Phase::looking) goal_.cancel();
    forget();
  }

 private:
  using Client = actionlib::ActionClient<Type>;
  using GoalHandle = typename Client::GoalHandle;
  using CommState = actionlib::CommState;
  using TerminalState = actionlib::TerminalState;

  // Looks in which a server may be missing: one that came back after a crash is seen in parts for a moment.
  static constexpr int kPatience = 10;
  // What a goal comes to that was interrupted: the node has stopped the robot.
  static constexpr const char* kOwn = "cancelled by the controller itself, an error to the model";

  // No goal; one that waits for a server; sent; known to the server; accepted by it; over, but for its result.
  enum class Phase { idle, looking, sent, known, accepted, over };

  void forget() {
    phase_ = Phase::idle;
    cancelled_ = false;
    interrupted_ = false;
    deadline_.stop();
    goal_.reset();
  }

  // Whether the server is there; again and again while it matters.
  void look() {
    const bool connected = client_.isServerConnected();
    missed_ = connected ? 0 : missed_ + 1;
    if (connected && !lost_.isExpired() && lost_.getCommState() != CommState::WAITING_FOR_CANCEL_ACK) lost_.cancel();
    if (phase_ == Phase::looking && connected && !interrupted_) {
      phase_ = Phase::sent;
      goal_ = client_.sendGoal(
          waiting_, [this](GoalHandle goal) { follow(goal); },
          [this](GoalHandle goal, const FeedbackConstPtr& feedback) { receive(goal, *feedback); });
    } else if (busy() && phase_ != Phase::looking && missed_ > kPatience) {
      lost_ = goal_;  // it ends, should the server come back with it
      end("the server is gone");
    }
    if (busy() || !lost_.isExpired()) next_look_.start();
  }

  void follow(const GoalHandle& goal) {
    if (goal == lost_ && lost_.getCommState() == CommState::DONE) lost_.reset();
    if (!busy() || goal != goal_) return;
    switch (goal_.getCommState().state_) {
      case CommState::PENDING:
        advance(Phase::known);
        break;
      case CommState::ACTIVE:
        advance(Phase::accepted);
        break;
      case CommState::RECALLING:
      case CommState::PREEMPTING:
        deadline_.stop();
        break;
      case CommState::WAITING_FOR_RESULT:
        phase_ = Phase::over;
        deadline_.start();
        break;
      case CommState::DONE:
        finish();
        break;
      default:
        break;
    }
  }

  void advance(Phase phase) {
    const bool unknown = phase_ == Phase::sent;
    phase_ = phase;
    if (phase == Phase::accepted && !interrupted_) deadline_.stop();
    if (unknown && interrupted_) ask_to_cancel();
  }

  void ask_to_cancel() {
    deadline_.start();
    goal_.cancel();
  }

  void receive(const GoalHandle& goal, const Feedback& feedback) {
    if (!busy() || goal != goal_) return;
    if (phase_ == Phase::sent || phase_ == Phase::known) advance(Phase::accepted);  // feedback may overtake the status
    if (!cancelled_) handlers_.feedback(feedback);
  }

  void expire() {
    switch (phase_) {
      case Phase::looking:
        end("no server" + within_);
        break;
      case Phase::sent:
      case Phase::known:
        if (!cancelled_) {
          interrupted_ = cancelled_ = true;  // it may still begin
          goal_.cancel();
          handlers_.error("not accepted" + within_);
          break;
        }
        if (phase_ == Phase::sent) goal_.cancel();
        [[fallthrough]];
      case Phase::accepted:
        ROS_WARN("%s: the server refuses to cancel the goal", name_.c_str());
        break;
      case Phase::over:
        end("no result" + within_ + " of its end");
        break;
      case Phase::idle:
        break;
    }
  }

  void finish() {
    const TerminalState state = goal_.getTerminalState();
    const ResultConstPtr result = goal_.getResult();
    if (state == TerminalState::SUCCEEDED && cancelled_) {
      ROS_INFO("%s: cancelled too late, the goal has succeeded", name_.c_str());
    } else if (state == TerminalState::SUCCEEDED && result) {
      forget();
      handlers_.response(*result);
      return;
    }
    const std::string text = state.getText().empty() ? "" : " (" + state.getText() + ")";
    end(why(state) + text);
  }

  std::string why(const TerminalState& state) const {
    switch (state.state_) {
      case TerminalState::REJECTED:
        return "rejected";
      case TerminalState::ABORTED:
        return "aborted";
      case TerminalState::RECALLED:
      case TerminalState::PREEMPTED:
        return interrupted_ ? kOwn : "cancelled by someone else";
      default:
        return "the server has lost the goal";
    }
  }

  // The goal has ended, not as it should have, or cancelled.
  void end(const std::string& why) {
    const bool cancelled = cancelled_;
    forget();
    if (cancelled) {
      handlers_.ended();
    } else {
      handlers_.error(why);
    }
  }

  const std::string name_;
  const std::string within_;
  const Handlers handlers_;
  Phase phase_ = Phase::idle;
  bool interrupted_ = false;  // somebody here wants it to end
  bool cancelled_ = false;    // and nobody wants to know how
  int missed_ = 0;
  std::uint64_t number_ = 0;
  Goal waiting_;
  EventQueue events_;
  Countdown deadline_;
  Countdown next_look_;
  Client client_;
  GoalHandle goal_;
  GoalHandle lost_;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_ROS1_ACTION_CLIENT_HPP_
