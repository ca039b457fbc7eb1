// Requests of a service that the controller serves, independent of the middleware.
#ifndef ROBOSC_CALL_SERVER_HPP_
#define ROBOSC_CALL_SERVER_HPP_

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "robosc/throttle.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The number of requests that may wait for their turn.
inline constexpr std::size_t kWaitingRequests = 10;

/// The requests of one service. One is open at a time, the next ones wait.
///
/// `Caller` identifies a request that waits for its response.
template <typename Caller, typename Request, typename Response>
class CallServer {
 public:
  struct Handlers {
    std::function<bool()> ready;                  ///< Whether the controller takes a request now.
    std::function<bool(const Request&)> request;  ///< Takes a request. Returns false to refuse it.
    std::function<void(const std::string& text)> warn;
  };

  CallServer(const CallServer&) = delete;
  CallServer& operator=(const CallServer&) = delete;
  virtual ~CallServer() = default;

  /// Takes the next request if none is open.
  void look() {
    while (!open_ && !waiting_.empty() && handlers_.ready()) {
      const Call next = std::move(waiting_.front());
      waiting_.pop_front();
      open_ = next.caller;
      if (handlers_.request(next.request)) continue;
      open_.reset();
      refuse(next.caller);
    }
  }

  /// Responds to the open request. The next one follows in a callback of its own: events of the model may call this.
  void respond(const Response& response) {
    if (!open_) return;
    const Caller caller = *std::exchange(open_, std::nullopt);
    answer(caller, response);
    if (!waiting_.empty()) defer();
  }

  /// Refuses all requests at the end of the node.
  void leave() {
    const std::size_t number = waiting_.size() + (open_ ? 1 : 0);
    if (number > 0) handlers_.warn("requests without a response at the end of this node: " + std::to_string(number));
    if (open_) refuse(*std::exchange(open_, std::nullopt));
    for (const Call& call : std::exchange(waiting_, {})) refuse(call.caller);
  }

 protected:
  /// `fate`: the effect of a refusal on a request, in words.
  CallServer(const char* fate, Handlers handlers) : fate_(fate), handlers_(std::move(handlers)) {}

  virtual void answer(const Caller& caller, const Response& response) = 0;
  virtual void refuse(const Caller& caller) = 0;
  /// Calls `look` soon, from the node's executor.
  virtual void defer() = 0;

  /// Handles a new request.
  void called(const Caller& caller, const Request& request) {
    waiting_.push_back({caller, request});
    look();
    if (waiting_.size() <= kWaitingRequests) return;
    if (drops_.due(0)) {
      handlers_.warn("more than " + std::to_string(kWaitingRequests) + " requests wait: the oldest one is " + fate_);
    }
    const Caller oldest = waiting_.front().caller;
    waiting_.pop_front();
    refuse(oldest);
  }

  void warn(const std::string& text) const { handlers_.warn(text); }

 private:
  struct Call {
    Caller caller;
    Request request;
  };

  const char* const fate_;
  const Handlers handlers_;
  std::optional<Caller> open_;
  std::deque<Call> waiting_;  ///< The oldest first.
  Throttle<int> drops_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALL_SERVER_HPP_
