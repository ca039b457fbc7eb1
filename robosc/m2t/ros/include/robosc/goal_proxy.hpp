// One forwarded goal of an action, independent of the middleware.
#ifndef ROBOSC_GOAL_PROXY_HPP_
#define ROBOSC_GOAL_PROXY_HPP_

#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "robosc/cancel_requests.hpp"
#include "robosc/failure.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The part of a layer between a controller and the robot's action. One goal runs at a time. Further goals are rejected
/// until it has ended. A derived class forwards each message of both sides, so that goals keep their identity.
template <typename Countdown, typename Goal, typename Feedback, typename Result>
class GoalProxy {
 public:
  /// The end of a goal without success: the reason and the received result, or a default result.
  using Ended = std::function<void(Failure reason, const std::string& why, const Result& result)>;

  /// Decisions and notifications of the supervisor.
  struct Handlers {
    std::function<bool(const Goal&)> goal;          ///< Returns whether to forward a goal.
    std::function<void()> busy;                     ///< A goal was rejected because another one has not ended.
    std::function<void(const Feedback&)> feedback;  ///< The current goal has feedback.
    std::function<void(const Result&)> response;    ///< The goal has succeeded.
    Ended error;                                    ///< The goal was not executed, was aborted, or is lost.
    Ended canceled;  ///< A cancel has ended the goal. The reason applies if the model did not cancel it.
    std::function<void(const std::string&)> warn;  ///< The current goal has not ended although it should have.
  };

  GoalProxy(const GoalProxy&) = delete;
  GoalProxy& operator=(const GoalProxy&) = delete;
  virtual ~GoalProxy() = default;

  /// Cancels the current goal, if there is one. If the robot has not accepted it, cancels it on acceptance.
  void cancel() {
    if (!running_) return;
    canceling_ = true;
    if (accepted_ && !over_) requests_.ask();
  }

  /// The reason why the current goal has not ended although it should have. Empty without trouble.
  std::string trouble() const { return late_ && !accepted_ ? "not accepted" + within_ : requests_.trouble(); }

  /// Whether the end of the layer waits for the acceptance of a goal that it cancels, for the answer, and for its end.
  bool waits() const { return running_ && canceling_ && !over_ && (requests_.waits() || (!accepted_ && !late_)); }

  /// Reports once a goal that the layer has canceled and that has not ended when the layer ends.
  void leave() {
    if (!running_ || !canceling_ || over_ || std::exchange(left_, true)) return;
    handlers_.warn(left_behind(accepted_, requests_.accepted(), trouble(), "layer"));
  }

 protected:
  /// `timeout` bounds the waits for acceptance, for the answer to a cancel, for a missing server, and for the result of
  /// an ended goal. A cancel is repeated after `retry`. `place`: first arguments of a countdown.
  template <typename... Place>
  GoalProxy(std::chrono::milliseconds timeout, std::chrono::milliseconds retry, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        requests_(timeout, retry,
                  typename CancelRequests<Countdown>::Actions{
                      [this] { send_cancel(); }, [this](const std::string& text) { handlers_.warn(text); }},
                  place...) {}

  // Functions that the middleware implements.

  /// Whether the robot's server for the next step is available.
  virtual bool is_served() = 0;
  /// Whether the robot reports that the current goal is being canceled.
  virtual bool is_canceling() = 0;
  /// Forwards the goal to the robot. Returns false if that is not possible now.
  virtual bool send() = 0;
  /// Requests the robot to cancel the current goal.
  virtual void send_cancel() = 0;
  /// Restarts the deadline for acceptance, for a result, or for a missing server, with `more` time.
  virtual void restart(std::chrono::milliseconds more = std::chrono::milliseconds(0)) = 0;
  /// Whether the deadline has passed.
  virtual bool is_over() = 0;
  /// Reports to the controller that the goal has ended without a result.
  virtual void abandon() = 0;

  // Functions that the derived class calls.

  /// Handles a goal of the controller, which `keep` stores. Returns false if the goal is rejected.
  template <typename Keep>
  bool admit(const Goal& goal, Keep keep) {
    if (running_) {
      handlers_.busy();
      return false;
    }
    running_ = true;
    sent_ = accepted_ = canceling_ = late_ = over_ = left_ = false;
    requests_.reset();
    keep();
    running_ = handlers_.goal(goal);
    if (running_) restart();
    return running_;
  }

  /// Checks the current goal. Call it repeatedly.
  void look() {
    if (!running_) return;
    if (canceling_ && !sent_) {
      finish();
      handlers_.canceled(Failure::canceled, "canceled before it was sent", Result());
      return abandon();
    }
    const bool served = is_served();
    if (!sent_ && served) {
      sent_ = send();
      if (sent_) return;
    }
    if (accepted_ && served && !over_) {
      restart();
    } else if (is_over()) {
      expire();
    }
  }

  void accept() {
    if (std::exchange(accepted_, true)) return;
    restart();
    if (canceling_) requests_.ask();
  }

  /// Handles the robot's answer to the layer's request to cancel the current goal.
  void cancel_answered(CancelAnswer answer) {
    if (!running_) return;
    if (answer == CancelAnswer::accepted) {
      requests_.accept();
    } else if (accepted_ && !over_ && !requests_.accepted()) {
      if (answer == CancelAnswer::refused) requests_.refuse();
      if (answer == CancelAnswer::terminated) await_result();
      if (answer == CancelAnswer::unknown) fail(Failure::lost, "the server does not know the goal");
    }
  }

  /// The current goal has ended. Its result has not arrived yet.
  void await_result() {
    if (std::exchange(over_, true)) return;
    requests_.stop();
    restart();
  }

  void hear(const Feedback& feedback) { handlers_.feedback(feedback); }

  // Ends of the robot's goal. Call `finish` first.

  void succeed(const Result& result) { handlers_.response(result); }
  void canceled(const Result& result) {
    handlers_.canceled(late_ ? Failure::timeout : Failure::canceled, "canceled", result);
  }
  void abort(const Result& result) { handlers_.error(late_ ? Failure::timeout : Failure::aborted, "aborted", result); }
  /// The server no longer knows the goal or its end. The robot may still move.
  void lose() { handlers_.error(Failure::lost, kLostGoal, Result()); }

  /// The goal has ended without a result, or its end is unknown.
  void fail(Failure reason, const std::string& why) {
    finish();
    handlers_.error(reason, why, Result());
    abandon();
  }

  /// Ends the current goal.
  void finish() {
    running_ = false;
    requests_.stop();
  }

  bool running() const { return running_; }
  bool accepted() const { return accepted_; }

 private:
  void expire() {
    if (over_ && is_canceling()) {
      // Another client canceled the goal before: a server reports that as terminated, too.
      over_ = false;
      requests_.reset();
      requests_.accept();
    } else if (over_) {
      fail(Failure::lost, "the goal has ended, but its result did not come" + within_);
    } else if (accepted_) {
      fail(Failure::lost, "the server is gone");
    } else if (late_) {
      fail(Failure::lost, "neither accepted nor rejected");
    } else if (sent_) {
      // The robot might still accept the goal. Then it is canceled.
      handlers_.warn("not accepted" + within_);
      late_ = canceling_ = true;
      restart(std::chrono::seconds(30));
      send_cancel();
    } else {
      fail(Failure::unavailable, "no server" + within_);
    }
  }

  const Handlers handlers_;
  const std::string within_;
  bool running_ = false;
  bool sent_ = false;
  bool accepted_ = false;   ///< The robot has accepted the goal.
  bool canceling_ = false;  ///< The layer cancels the goal.
  bool late_ = false;       ///< The goal was not accepted in time.
  bool left_ = false;       ///< The goal was reported as left behind.
  bool over_ = false;       ///< The goal has ended. Its result has not arrived yet.
  CancelRequests<Countdown> requests_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_PROXY_HPP_
