// A goal of an action that is handed on, from its start to its one end, without middleware.
#ifndef ROBOSC_GOAL_PROXY_HPP_
#define ROBOSC_GOAL_PROXY_HPP_

#include <functional>
#include <string>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// What stands between a controller and the robot's action. One goal runs at a time; another one is rejected until that
/// has ended. A derived class hands on what both sides say, one by one, so that goals keep their identity.
template <typename Goal, typename Feedback, typename Result>
class GoalProxy {
 public:
  /// What the supervisor has to say and to hear.
  struct Handlers {
    std::function<bool(const Goal&)> goal;            ///< Whether a goal goes on.
    std::function<void()> busy;                       ///< A goal is rejected because another one has not ended.
    std::function<void(const Feedback&)> feedback;    ///< The goal at hand goes on.
    std::function<void(const Result&)> response;      ///< It has succeeded.
    std::function<void(const std::string&)> error;    ///< It has not, and why.
    std::function<void()> canceled;                   ///< It has ended because of a cancel of the supervisor's.
    std::function<void(const std::string&)> refused;  ///< The robot does not cancel it.
  };

  GoalProxy(const GoalProxy&) = delete;
  GoalProxy& operator=(const GoalProxy&) = delete;
  virtual ~GoalProxy() = default;

  /// Cancels the goal at hand, if there is one; before the robot has accepted it, as soon as it does.
  void cancel() {
    if (!running_ || cancelled_) return;
    cancelled_ = true;
    if (accepted_) send_cancel();
  }

 protected:
  /// `within`: the time for acceptance, as " within 5000 ms".
  GoalProxy(std::string within, Handlers handlers) : handlers_(std::move(handlers)), within_(std::move(within)) {}

  // What the middleware does.

  /// Whether the robot can be asked for what comes next.
  virtual bool is_served() = 0;
  /// Hands the goal on to the robot; false: that is not possible now.
  virtual bool send() = 0;
  /// Asks the robot to cancel the goal at hand.
  virtual void send_cancel() = 0;
  /// The time for acceptance, for the answer to a cancel, or for a server that is missing, begins anew.
  virtual void restart() = 0;
  /// Whether that time is over.
  virtual bool is_over() = 0;
  /// That time is over for a goal that is to be cancelled, and whose server is there.
  virtual void cancel_unanswered() = 0;
  /// Nobody waits for the goal any more: the controller is told, and a robot that has it. Calls `finish`.
  virtual void abandon(const std::string& why) = 0;

  // What the controller and the robot do.

  /// The controller has sent a goal that `keep` keeps; false: it is rejected.
  template <typename Keep>
  bool admit(const Goal& goal, Keep keep) {
    if (running_) {
      handlers_.busy();
      return false;
    }
    running_ = true;
    sent_ = accepted_ = cancelled_ = false;
    keep();
    running_ = handlers_.goal(goal);
    if (running_) restart();
    return running_;
  }

  /// To be called again and again while a goal runs.
  void look() {
    if (!running_) return;
    if (cancelled_ && !sent_) return fail("cancelled before it was sent");
    const bool served = is_served();
    if (!sent_ && served) {
      sent_ = send();
      if (sent_) return;
    }
    if (accepted_ && served) {
      if (!cancelled_) {
        restart();
      } else if (is_over()) {
        cancel_unanswered();
      }
    } else if (is_over()) {
      fail(accepted_ ? "the server is gone" : (sent_ ? "not accepted" : "no server") + within_);
    }
  }

  void accept() {
    if (accepted_) return;
    accepted_ = true;
    restart();
    if (cancelled_) send_cancel();
  }

  void hear(const Feedback& feedback) { handlers_.feedback(feedback); }

  /// The robot's goal has ended.
  void succeed(const Result& result) { handlers_.response(result); }

  void end(const std::string& why) {
    if (cancelled_ && why.compare(0, 9, "cancelled") == 0) {
      handlers_.canceled();
    } else {
      handlers_.error(why);
    }
  }

  void fail(const std::string& why) {
    end(why);
    abandon(why);
  }

  /// The goal is over.
  void finish() { running_ = false; }

  bool running() const { return running_; }
  bool sent() const { return sent_; }
  bool accepted() const { return accepted_; }
  const Handlers& handlers() const { return handlers_; }
  const std::string& within() const { return within_; }

 private:
  const Handlers handlers_;
  const std::string within_;
  bool running_ = false;
  bool sent_ = false;
  bool accepted_ = false;   ///< By the robot.
  bool cancelled_ = false;  ///< By the supervisor.
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_PROXY_HPP_
