// Requests to cancel a goal, independent of the middleware.
#ifndef ROBOSC_CANCEL_REQUESTS_HPP_
#define ROBOSC_CANCEL_REQUESTS_HPP_

#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A server's answer to a request to cancel one goal. `terminated`: the goal has ended or is being canceled. `unknown`:
/// the server does not know the goal.
enum class CancelAnswer { accepted, refused, terminated, unknown };

/// The reason for a goal whose result has no known end.
inline constexpr const char* kLostGoal = "the server has lost the goal";
/// The time that a node waits at its end for the end of a goal whose cancel the server has accepted.
inline constexpr std::chrono::milliseconds kFarewell(500);

/// The report on a goal that has not ended when its node ends. `trouble` is empty if the server cancels the goal.
inline std::string left_behind(bool accepted, bool canceling, const std::string& trouble, const std::string& node) {
  const std::string running = accepted ? "the goal has not ended" : "the goal may still begin";
  const std::string why = !trouble.empty() ? trouble : "the server has not answered";
  return running + " when this " + node + " ends: " + (canceling ? "the server cancels the goal" : why);
}

/// The requests to cancel successive goals. Each request is repeated until the server accepts it.
///
/// `Countdown` calls a function once, a given time after each start.
template <typename Countdown>
class CancelRequests {
 public:
  struct Actions {
    std::function<void()> send;                         ///< Sends one request.
    std::function<void(const std::string& text)> warn;  ///< Reports each kind of refusal once per goal.
  };

  /// A refused request is repeated after `retry`, or never if `retry` is 0. No answer within `timeout` counts as a
  /// refusal. `place`: first arguments of a countdown.
  template <typename... Place>
  CancelRequests(std::chrono::milliseconds timeout, std::chrono::milliseconds retry, Actions actions, Place&... place)
      : actions_(std::move(actions)),
        timeout_(timeout),
        repeats_(retry.count() > 0),
        unanswered_("the server does not answer the request to cancel the goal within " +
                    std::to_string(timeout.count()) + " ms"),
        answer_(place..., timeout, [this] { refuse(unanswered_); }),
        retry_(place..., repeats_ ? retry : timeout, [this] { send(); }) {}

  CancelRequests(const CancelRequests&) = delete;
  CancelRequests& operator=(const CancelRequests&) = delete;

  /// Prepares for a new goal.
  void reset() {
    stop();
    stopped_ = sent_ = accepted_ = false;
    reported_.clear();
  }

  /// Sends the first request. Does nothing if one was sent.
  void ask() {
    if (sent_ || accepted_ || stopped_) return;
    sent_ = true;
    extend();
    send();
  }

  /// Extends the wait for an answer at the end of the node, as after a first request.
  void extend() {
    if (!accepted_) until_ = std::chrono::steady_clock::now() + timeout_;
  }

  /// The server has accepted to cancel the goal.
  void accept() {
    answer_.stop();
    retry_.stop();
    accepted_ = true;
    trouble_.clear();
    until_ = std::chrono::steady_clock::now() + kFarewell;
  }

  /// The server does not cancel the goal. Reports `why`.
  void refuse(const std::string& why = "the server refuses to cancel the goal") {
    if (accepted_ || stopped_) return;
    answer_.stop();
    if (repeats_) retry_.start();
    trouble_ = why;
    if (reported_.insert(why).second) actions_.warn(why);
  }

  /// Stops sending: the goal has ended, or its end is certain.
  void stop() {
    answer_.stop();
    retry_.stop();
    stopped_ = true;
    trouble_.clear();
  }

  bool sent() const { return sent_; }
  bool accepted() const { return accepted_; }
  /// The reason why the goal is not being canceled. Empty if the server has accepted the request or still may.
  const std::string& trouble() const { return trouble_; }
  /// Whether the end of the node waits for an answer and then briefly for the end of the goal.
  bool waits() const { return sent_ && !stopped_ && std::chrono::steady_clock::now() < until_; }

 private:
  void send() {
    answer_.start();
    actions_.send();
  }

  const Actions actions_;
  const std::chrono::milliseconds timeout_;
  const bool repeats_;
  const std::string unanswered_;
  bool sent_ = false;
  bool accepted_ = false;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point until_;
  std::string trouble_;
  std::set<std::string> reported_;
  Countdown answer_;
  Countdown retry_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CANCEL_REQUESTS_HPP_
