// A goal of an action from its start to its one end, without middleware.
#ifndef ROBOSC_GOAL_CLIENT_HPP_
#define ROBOSC_GOAL_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The client of one action, with one goal at a time. A derived class sends the goal and says what its server does.
///
/// Everything runs where the countdowns run, one call after the other. `Countdown` calls a function once, some time
/// after each start.
template <typename Countdown, typename FeedbackType, typename ResultType>
class GoalClient {
 public:
  /// Any number of feedbacks follows a start, then exactly one of the others; never from inside `start`, `cancel` or
  /// `interrupt`.
  struct Handlers {
    std::function<void(const FeedbackType&)> feedback;
    std::function<void(const ResultType&)> response;    ///< The goal has succeeded.
    std::function<void(const std::string& why)> error;  ///< No server, not accepted in time, ended in any other way.
    std::function<void()> ended;  ///< A goal that was cancelled, or not accepted in time, is over.
  };

  GoalClient(const GoalClient&) = delete;
  GoalClient& operator=(const GoalClient&) = delete;
  virtual ~GoalClient() = default;

  /// Whether a goal has not ended, be it one that was given up; until then no other may start.
  bool busy() const { return phase_ != Phase::idle; }

  /// Whether the server may still accept the goal in time; where simulated time stands still, the steady clock bounds
  /// it.
  bool waits() const {
    return phase_ == Phase::sent && deadline_.running() && std::chrono::steady_clock::now() < latest_;
  }

  /// Cancels the goal: where the server does not know it yet, as soon as it does. What it still says is dropped.
  void cancel() {
    if (!busy()) return;
    dropped_ = true;
    interrupt();
  }

  /// Cancels the goal, but hands on what comes of it; that it ends as cancelled is an error.
  void interrupt() {
    if (!busy()) return;
    ending_ = true;
    // Not again while it is to answer: rclcpp_action may be about to tell of the answer, with a lock that asking takes.
    if (known_ && !(asked_ && deadline_.running())) ask_to_cancel();
  }

 protected:
  enum class Phase { idle, waiting, sent, accepted, over };

  /// `timeout`: of the search for a server together with the wait for its acceptance, never of the goal's work; of a
  /// cancel; from the end of a goal to its result. `place`: what a countdown begins with.
  template <typename... Place>
  GoalClient(std::chrono::milliseconds timeout, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        timeout_(timeout),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        deadline_(place..., timeout, [this] { expire(); }),
        poll_(place..., std::chrono::milliseconds(50), [this] { poll(); }),
        until_lost_(place..., std::chrono::seconds(30), [this] { fail("lost"); }) {}

  // What the middleware does.

  /// Whether a server is there; asked again and again while a goal is under way.
  virtual bool is_served() = 0;
  /// Whether the server that has the goal is gone; asked after `is_served`.
  virtual bool is_gone() = 0;
  /// Sends the goal; false: that is not possible now.
  virtual bool send() = 0;
  /// Asks the server to cancel the goal, if that is possible yet.
  virtual void request_cancel() = 0;
  /// Forgets the goal, which is over.
  virtual void reset() = 0;
  virtual void warn(const std::string& text) = 0;
  /// Whether to look for the server also where no goal is under way.
  virtual bool keeps_looking() const { return false; }

  // What the server does.

  /// Begins to look for a server, for a new goal.
  void begin() {
    phase_ = Phase::waiting;
    unsent_ = "no server";
    latest_ = std::chrono::steady_clock::now() + timeout_;
    deadline_.start();
    poll();
  }

  /// The server knows the goal: it can be cancelled.
  void know() {
    if (!std::exchange(known_, true) && ending_) ask_to_cancel();
  }

  void accept() {
    if (phase_ != Phase::sent) return;
    phase_ = Phase::accepted;
    if (!asked_) deadline_.stop();
    until_lost_.stop();
    know();
  }

  /// The server cancels the goal, or refuses to.
  void cancel_answered(bool cancels) {
    deadline_.stop();
    if (!cancels) warn("the server refuses to cancel the goal");
  }

  /// The goal is over, its result is not there yet.
  void await_result() {
    phase_ = Phase::over;
    deadline_.start();
  }

  void succeed(const ResultType& result) {
    dropped_ = false;
    finish([this, &result] { handlers_.response(result); });
  }

  /// The goal has ended as cancelled. `more`: what the server says about it.
  void cancelled(const std::string& more = "") {
    const std::string why =
        (ending_ ? "cancelled by the controller itself, an error to the model" : "cancelled by someone else") + more;
    finish([this, why] { handlers_.error(why); });
  }

  /// The goal has ended, not as it should have.
  void fail(const std::string& why) {
    dropped_ = false;
    finish([this, why] { handlers_.error(why); });
  }

  void forget() {
    ++number_;
    phase_ = Phase::idle;
    dropped_ = ending_ = asked_ = known_ = false;
    deadline_.stop();
    until_lost_.stop();
    reset();
  }

  Phase phase() const { return phase_; }
  /// Which goal this is: what comes of another one has another number.
  std::uint64_t number() const { return number_; }
  /// Whether nobody wants to know what comes of the goal.
  bool dropped() const { return dropped_; }
  const Handlers& handlers() const { return handlers_; }

 private:
  void poll() {
    const bool served = is_served();
    if (phase_ == Phase::waiting && ending_) {
      cancelled();
    } else if (phase_ == Phase::waiting && served) {
      phase_ = Phase::sent;
      if (!send()) {
        phase_ = Phase::waiting;
        unsent_ = "the goal can't be sent";
      }
    } else if (busy() && phase_ != Phase::waiting && is_gone()) {
      fail("the server is gone");
    }
    if (busy() || keeps_looking()) poll_.start();
  }

  void ask_to_cancel() {
    asked_ = true;
    deadline_.start();
    request_cancel();
  }

  void expire() {
    switch (phase_) {
      case Phase::idle:
        break;
      case Phase::waiting:
        fail(unsent_ + within_);
        break;
      case Phase::sent:
        // It may still begin, and is cancelled then. So long after this it is lost.
        until_lost_.start();
        ending_ = true;
        request_cancel();
        if (!std::exchange(dropped_, true)) {
          handlers_.error("not accepted" + within_);
        } else if (asked_) {
          cancel_answered(false);
        }
        break;
      case Phase::accepted:
        cancel_answered(false);
        break;
      case Phase::over:
        fail("no result" + within_ + " of its end");
        break;
    }
  }

  /// The goal is over; `tell` says how, where that matters.
  template <typename Tell>
  void finish(Tell tell) {
    const bool dropped = dropped_;
    forget();
    if (dropped) {
      handlers_.ended();
    } else {
      tell();
    }
  }

  const Handlers handlers_;
  const std::chrono::milliseconds timeout_;
  const std::string within_;
  std::string unsent_;  ///< Why the goal was not sent yet.
  std::chrono::steady_clock::time_point latest_;
  Phase phase_ = Phase::idle;
  bool known_ = false;    ///< To the server.
  bool ending_ = false;   ///< Somebody here wants it to end,
  bool asked_ = false;    ///< and the server was asked to cancel it;
  bool dropped_ = false;  ///< nobody wants to know how.
  std::uint64_t number_ = 0;
  Countdown deadline_;
  Countdown poll_;
  Countdown until_lost_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_CLIENT_HPP_
