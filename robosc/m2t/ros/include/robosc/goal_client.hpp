// One goal of an action, independent of the middleware.
#ifndef ROBOSC_GOAL_CLIENT_HPP_
#define ROBOSC_GOAL_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "robosc/cancel_requests.hpp"
#include "robosc/failure.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The client of one action, with one goal at a time. A derived class sends the goal and reports the server's actions.
///
/// All functions run sequentially, in the thread of the countdowns. `Countdown` calls a function once, a given time
/// after each start.
template <typename Countdown, typename FeedbackType, typename ResultType>
class GoalClient {
 public:
  /// The end of a goal without success: the reason and the received result, or a default result.
  using Ended = std::function<void(Failure reason, const std::string& why, const ResultType& result)>;

  /// Any number of feedbacks follows a start, then exactly one other handler. None runs inside `start` or `cancel`.
  struct Handlers {
    std::function<void(const FeedbackType&)> feedback;
    std::function<void(const ResultType&)> response;  ///< The goal has succeeded.
    Ended error;                                      ///< The goal was not executed, was aborted, or is lost.
    Ended canceled;  ///< A cancel has ended the goal. The reason applies if the model did not cancel it.
  };

  GoalClient(const GoalClient&) = delete;
  GoalClient& operator=(const GoalClient&) = delete;
  virtual ~GoalClient() = default;

  /// Whether there is a goal without a known end. No other goal may start until then.
  bool busy() const { return phase_ != Phase::idle; }

  /// Whether the end of the node waits for the goal's acceptance, for the answer to a cancel, and then briefly for the
  /// goal's end. The steady clock bounds the wait because simulated time may stand still.
  bool waits() const {
    const bool undecided = busy() && phase_ != Phase::accepted;
    return requests_.waits() || (undecided && std::chrono::steady_clock::now() < until_);
  }

  /// The reason why the goal has not ended although it should have. Empty without trouble.
  std::string trouble() const { return late_ && phase_ == Phase::sent ? not_accepted_ : requests_.trouble(); }

  /// Cancels the goal. If the server does not know it yet, cancels it once it does.
  void cancel() {
    if (!busy()) return;
    canceling_ = true;
    if (known_ && phase_ != Phase::over) requests_.ask();
    requests_.extend();
  }

  /// Reports once a goal that has not ended when the node ends.
  void leave() {
    if ((phase_ != Phase::sent && phase_ != Phase::accepted) || std::exchange(left_, true)) return;
    warn(left_behind(phase_ == Phase::accepted, requests_.accepted(), trouble(), "node"));
  }

 protected:
  enum class Phase { idle, waiting, sent, accepted, over };

  /// `timeout` bounds three waits: for a server and its acceptance, for the answer to a cancel, and from the end of a
  /// goal to its result. It never bounds the goal's execution. A cancel is repeated after `retry`, or never if `retry`
  /// is 0. `place`: first arguments of a countdown.
  template <typename... Place>
  GoalClient(std::chrono::milliseconds timeout, std::chrono::milliseconds retry, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        timeout_(timeout),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        not_accepted_("not accepted" + within_),
        deadline_(place..., timeout, [this] { expire(); }),
        poll_(place..., std::chrono::milliseconds(50), [this] { poll(); }),
        until_lost_(place..., std::chrono::seconds(30),
                    [this] { fail(Failure::lost, "neither accepted nor rejected"); }),
        requests_(timeout, retry,
                  typename CancelRequests<Countdown>::Actions{[this] { request_cancel(); },
                                                              [this](const std::string& text) { warn(text); }},
                  place...) {}

  // Functions that the middleware implements.

  /// Whether a server is available. Called repeatedly during a goal.
  virtual bool is_served() = 0;
  /// Whether the server of the goal is gone. Called after `is_served`.
  virtual bool is_gone() = 0;
  /// Whether the server reports that the goal is being canceled.
  virtual bool is_canceling() = 0;
  /// Sends the goal. Returns false if that is not possible now.
  virtual bool send() = 0;
  /// Requests the server to cancel the goal, if possible yet.
  virtual void request_cancel() = 0;
  /// Forgets the goal after its end.
  virtual void reset() = 0;
  virtual void warn(const std::string& text) = 0;
  /// Whether to look for the server without a goal, too.
  virtual bool keeps_looking() const { return false; }

  // Functions that the derived class calls.

  /// Begins the search for a server for a new goal.
  void begin() {
    phase_ = Phase::waiting;
    left_ = false;
    unsent_ = "no server";
    until_ = std::chrono::steady_clock::now() + timeout_;
    requests_.reset();
    deadline_.start();
    poll();
  }

  /// The server knows the goal, so that it can be canceled.
  void know() {
    if (!std::exchange(known_, true) && canceling_) requests_.ask();
  }

  void accept() {
    if (phase_ != Phase::sent) return;
    phase_ = Phase::accepted;
    deadline_.stop();
    until_lost_.stop();
    know();
  }

  void cancel_answered(CancelAnswer answer) {
    if (answer == CancelAnswer::accepted) {
      if (!busy()) return;
      requests_.accept();
      accept();
    } else if (phase_ == Phase::accepted && !requests_.accepted()) {
      if (answer == CancelAnswer::refused) requests_.refuse();
      if (answer == CancelAnswer::terminated) await_result();
      if (answer == CancelAnswer::unknown) fail(Failure::lost, "the server does not know the goal");
    }
  }

  void hear(const FeedbackType& feedback) { handlers_.feedback(feedback); }

  /// The goal has ended. Its result has not arrived yet.
  void await_result() {
    phase_ = Phase::over;
    until_ = std::chrono::steady_clock::now() + kFarewell;
    until_lost_.stop();
    requests_.stop();
    deadline_.start();
  }

  void succeed(const ResultType& result) {
    forget();
    handlers_.response(result);
  }

  /// The goal has ended as canceled. `more`: details from the server.
  void canceled(const std::string& more = "", const ResultType& result = ResultType()) {
    const std::string by =
        canceling_ ? "canceled by the controller itself, an error to the model" : "canceled by someone else";
    finish(handlers_.canceled, Failure::canceled, late_ ? "canceled" : by + more, result);
  }

  void abort(const std::string& more = "", const ResultType& result = ResultType()) {
    finish(handlers_.error, Failure::aborted, "aborted" + more, result);
  }

  /// The server no longer knows the goal or its end. The robot may still move.
  void lose(const std::string& more = "") { fail(Failure::lost, kLostGoal + more); }

  /// Reports a failure without a result.
  void fail(Failure reason, const std::string& why) { finish(handlers_.error, reason, why, ResultType()); }

  void forget() {
    ++number_;
    phase_ = Phase::idle;
    canceling_ = known_ = late_ = false;
    deadline_.stop();
    until_lost_.stop();
    requests_.stop();
    reset();
  }

  Phase phase() const { return phase_; }
  /// The number of the current goal. Answers for another goal have another number.
  std::uint64_t number() const { return number_; }

 private:
  void poll() {
    const bool served = is_served();
    if (phase_ == Phase::waiting && canceling_) {
      finish(handlers_.canceled, Failure::canceled, "canceled before it was sent", ResultType());
    } else if (phase_ == Phase::waiting && served) {
      phase_ = Phase::sent;
      if (!send()) {
        phase_ = Phase::waiting;
        unsent_ = "the goal cannot be sent";
      }
    } else if (busy() && phase_ != Phase::waiting && is_gone()) {
      fail(Failure::lost, "the server is gone");
    }
    if (busy() || keeps_looking()) poll_.start();
  }

  void expire() {
    switch (phase_) {
      case Phase::waiting:
        fail(Failure::unavailable, unsent_ + within_);
        break;
      case Phase::sent:
        // The goal may still begin. Then it is canceled.
        warn(not_accepted_);
        late_ = canceling_ = true;
        until_lost_.start();
        request_cancel();
        break;
      case Phase::over:
        if (is_canceling()) {
          // Another client canceled the goal before: a server reports that as terminated, too.
          phase_ = Phase::accepted;
          requests_.reset();
          requests_.accept();
        } else {
          fail(Failure::lost, "the goal has ended, but its result did not come" + within_);
        }
        break;
      case Phase::idle:
      case Phase::accepted:
        break;
    }
  }

  /// Reports the end of the goal.
  void finish(const Ended& told, Failure reason, const std::string& why, const ResultType& result) {
    const bool late = late_ && (reason == Failure::canceled || reason == Failure::aborted);
    const std::string text = late ? "accepted too late, then " + why : why;
    forget();
    told(late ? Failure::timeout : reason, text, result);
  }

  const Handlers handlers_;
  const std::chrono::milliseconds timeout_;
  const std::string within_;
  const std::string not_accepted_;
  std::string unsent_;  ///< The reason why the goal was not sent yet.
  std::chrono::steady_clock::time_point until_;
  Phase phase_ = Phase::idle;
  bool known_ = false;      ///< The server knows the goal.
  bool canceling_ = false;  ///< This client cancels the goal.
  bool late_ = false;       ///< The goal was not accepted in time.
  bool left_ = false;       ///< The goal was reported as left behind.
  std::uint64_t number_ = 0;
  Countdown deadline_;
  Countdown poll_;
  Countdown until_lost_;
  CancelRequests<Countdown> requests_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_CLIENT_HPP_
