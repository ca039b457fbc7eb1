// The goal of an action that the controller serves, independent of the middleware.
#ifndef ROBOSC_GOAL_SERVER_HPP_
#define ROBOSC_GOAL_SERVER_HPP_

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "robosc/throttle.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The goals of one action. One goal is open at a time, further ones are rejected.
///
/// `Handle`: the middleware's handle of a goal.
template <typename Handle, typename Goal, typename Feedback, typename Result>
class GoalServer {
 public:
  struct Handlers {
    std::function<bool(const Goal&)> permits;  ///< Whether the controller accepts a goal now.
    std::function<bool(const Goal&)> goal;     ///< Handles an accepted goal. Returns false if the goal can't begin.
    std::function<void()> cancel;              ///< Handles a request to cancel the goal. Without it, none is accepted.
    std::function<void(const std::string& text)> warn;
  };

  GoalServer(const GoalServer&) = delete;
  GoalServer& operator=(const GoalServer&) = delete;
  virtual ~GoalServer() = default;

  void publish(const Feedback& feedback) {
    if (handle_) send(*handle_, feedback);
  }

  // Ends of the open goal.

  void succeed(const Result& result) {
    if (const auto handle = take()) conclude(*handle, result);
  }
  void abort(const Result& result) {
    if (const auto handle = take()) fail(*handle, result, "aborted");
  }
  void canceled(const Result& result) {
    if (const auto handle = take()) conclude_cancel(*handle, result);
  }

  /// Aborts the open goal at the end of the node.
  void leave() {
    const auto handle = take();
    if (!handle) return;
    handlers_.warn("the goal is aborted because this node ends");
    fail(*handle, Result(), "the controller has ended");
  }

 protected:
  explicit GoalServer(Handlers handlers) : handlers_(std::move(handlers)) {}

  virtual void send(Handle& handle, const Feedback& feedback) = 0;
  virtual void conclude(Handle handle, const Result& result) = 0;
  virtual void conclude_cancel(Handle handle, const Result& result) = 0;
  virtual void fail(Handle handle, const Result& result, const char* why) = 0;

  /// Whether a new goal is accepted now. Reports a rejection.
  bool permits(const Goal& goal) {
    const bool permitted = !handle_ && handlers_.permits(goal);
    if (!permitted && rejections_.due(0)) {
      handlers_.warn("a goal is rejected: its data or the present state does not permit it");
    }
    return permitted;
  }

  /// Handles an accepted goal. The controller may end the goal at once.
  void begin(const Handle& handle, const Goal& goal) {
    handle_ = handle;
    if (handlers_.goal(goal)) return;
    if (const auto unused = take()) fail(*unused, Result(), "the goal cannot begin");
  }

  bool accepts_cancels() const { return static_cast<bool>(handlers_.cancel); }
  bool is_open(const Handle& handle) const { return handle_ && *handle_ == handle; }
  const std::optional<Handle>& open() const { return handle_; }
  void cancel() const { handlers_.cancel(); }
  void warn(const std::string& text) const { handlers_.warn(text); }

 private:
  std::optional<Handle> take() { return std::exchange(handle_, std::nullopt); }

  const Handlers handlers_;
  std::optional<Handle> handle_;  ///< The open goal.
  Throttle<int> rejections_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_GOAL_SERVER_HPP_
