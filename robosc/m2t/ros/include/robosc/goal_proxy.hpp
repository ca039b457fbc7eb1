// A goal of an action that is handed on, from its start to its one end, without middleware.
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

/// What stands between a controller and the robot's action. One goal runs at a time; another one is rejected until that
/// has ended. A derived class hands on what both sides say, one by one, so that goals keep their identity.
template <typename Countdown, typename Goal, typename Feedback, typename Result>
class GoalProxy {
 public:
  /// Why a goal has ended without success, and the result that came with its end, else a default one.
  using Ended = std::function<void(Failure reason, const std::string& why, const Result& result)>;

  /// What the supervisor has to say and to hear.
  struct Handlers {
    std::function<bool(const Goal&)> goal;          ///< Whether a goal goes on.
    std::function<void()> busy;                     ///< A goal is rejected because another one has not ended.
    std::function<void(const Feedback&)> feedback;  ///< The goal at hand goes on.
    std::function<void(const Result&)> response;    ///< It has succeeded.
    Ended error;                                    ///< It was not carried out, aborted or lost.
    Ended canceled;  ///< It has ended because of a cancel; the reason counts where the model did not cancel it.
    std::function<void(const std::string&)> warn;  ///< The goal at hand has not ended though it should have.
  };

  GoalProxy(const GoalProxy&) = delete;
  GoalProxy& operator=(const GoalProxy&) = delete;
  virtual ~GoalProxy() = default;

  /// Cancels the goal at hand, if there is one; before the robot has accepted it, as soon as it does.
  void cancel() {
    if (!running_) return;
    canceling_ = true;
    if (accepted_ && !over_) requests_.ask();
  }

  /// Why the goal at hand has not ended though it should have; empty where nothing is wrong.
  std::string trouble() const { return late_ && !accepted_ ? "not accepted" + within_ : requests_.trouble(); }

  /// Whether the end of the layer waits: for the acceptance of a goal that it cancels, for the answer, for its end.
  bool waits() const { return running_ && canceling_ && !over_ && (requests_.waits() || (!accepted_ && !late_)); }

  /// Reports a goal that the layer has canceled and that has not ended when the layer ends, once.
  void leave() {
    if (!running_ || !canceling_ || over_ || std::exchange(left_, true)) return;
    handlers_.warn(left_behind(accepted_, requests_.accepted(), trouble(), "layer"));
  }

 protected:
  /// `timeout`: for acceptance, for the answer to a cancel, which is repeated after `retry`, for a server that is
  /// missing, and for the result of a goal that has ended. `place`: what a countdown begins with.
  template <typename... Place>
  GoalProxy(std::chrono::milliseconds timeout, std::chrono::milliseconds retry, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        requests_(timeout, retry,
                  typename CancelRequests<Countdown>::Actions{
                      [this] { send_cancel(); }, [this](const std::string& text) { handlers_.warn(text); }},
                  place...) {}

  // What the middleware does.

  /// Whether the robot can be asked for what comes next.
  virtual bool is_served() = 0;
  /// Whether the robot says that the goal at hand is being canceled.
  virtual bool is_canceling() = 0;
  /// Hands the goal on to the robot; false: that is not possible now.
  virtual bool send() = 0;
  /// Asks the robot to cancel the goal at hand.
  virtual void send_cancel() = 0;
  /// The time for acceptance, for a result, or for a server that is missing, begins anew; `more` is added to it.
  virtual void restart(std::chrono::milliseconds more = std::chrono::milliseconds(0)) = 0;
  /// Whether that time is over.
  virtual bool is_over() = 0;
  /// Tells the controller that the goal has ended without a result.
  virtual void abandon() = 0;

  // What the controller and the robot do.

  /// The controller has sent a goal that `keep` keeps; false: it is rejected.
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

  /// To be called again and again while a goal runs.
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

  /// The robot has answered a request of the layer's to cancel the goal at hand.
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

  /// The goal at hand has ended, its result is not there yet.
  void await_result() {
    if (std::exchange(over_, true)) return;
    requests_.stop();
    restart();
  }

  void hear(const Feedback& feedback) { handlers_.feedback(feedback); }

  // The robot's goal has ended; `finish` comes before.

  void succeed(const Result& result) { handlers_.response(result); }
  void canceled(const Result& result) {
    handlers_.canceled(late_ ? Failure::timeout : Failure::canceled, "canceled", result);
  }
  void abort(const Result& result) { handlers_.error(late_ ? Failure::timeout : Failure::aborted, "aborted", result); }
  /// The server does not know the goal any more, or its end: the robot may still move.
  void lose() { handlers_.error(Failure::lost, kLostGoal, Result()); }

  /// It has ended without a result, or nobody knows what becomes of it.
  void fail(Failure reason, const std::string& why) {
    finish();
    handlers_.error(reason, why, Result());
    abandon();
  }

  /// The goal is over.
  void finish() {
    running_ = false;
    requests_.stop();
  }

  bool running() const { return running_; }
  bool accepted() const { return accepted_; }

 private:
  void expire() {
    if (over_ && is_canceling()) {
      // Somebody else had it canceled before: a server calls that terminated, too.
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
      // The robot might still accept it: then it is canceled.
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
  bool accepted_ = false;   ///< By the robot.
  bool canceling_ = false;  ///< By the layer.
  bool late_ = false;       ///< It was not accepted in time.
  bool left_ = false;       ///< It was reported as left behind.
  bool over_ = false;       ///< It has ended, its result is not there yet.
  CancelRequests<Countdown> requests_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_PROXY_HPP_
