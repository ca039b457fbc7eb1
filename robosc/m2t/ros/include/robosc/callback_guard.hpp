// Protection of destroyed objects from late callbacks.
#ifndef ROBOSC_CALLBACK_GUARD_HPP_
#define ROBOSC_CALLBACK_GUARD_HPP_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Prevents callbacks on an object during and after its destruction. A multi-threaded container unloads a
/// component in one thread while another thread runs or starts its callbacks. Guarded callbacks run one at a time.
/// `close` waits for the running callback, and no callback begins after it.
class CallbackGuard {
 public:
  CallbackGuard() = default;
  CallbackGuard(const CallbackGuard&) = delete;
  CallbackGuard& operator=(const CallbackGuard&) = delete;
  ~CallbackGuard() { close(); }

  /// A guard to close on its own. Its callbacks and those of this guard exclude each other.
  CallbackGuard sibling() const { return CallbackGuard(state_->mutex); }

  /// The function, without effect if the guard is closed after this call.
  template <typename Function>
  auto operator()(Function function) const {
    return guarded(std::function(std::move(function)));
  }

  /// While you hold this lock, no guarded callback runs in another thread.
  std::unique_lock<std::recursive_mutex> hold() const { return std::unique_lock<std::recursive_mutex>(*state_->mutex); }

  void close() {
    ++state_->closed;  // Counts before it locks: new callbacks skip the lock and can't starve this thread.
    const auto lock = hold();
  }

 private:
  struct State {
    std::shared_ptr<std::recursive_mutex> mutex = std::make_shared<std::recursive_mutex>();
    std::atomic<std::uint64_t> closed{0};  ///< The number of calls of `close`.
  };

  explicit CallbackGuard(std::shared_ptr<std::recursive_mutex> mutex) { state_->mutex = std::move(mutex); }

  template <typename... Arguments>
  std::function<void(Arguments...)> guarded(std::function<void(Arguments...)> function) const {
    const auto lock = hold();
    return [state = state_, closed = state_->closed.load(), function = std::move(function)](Arguments... arguments) {
      if (state->closed != closed) return;
      const std::lock_guard<std::recursive_mutex> running(*state->mutex);
      if (state->closed == closed) function(std::forward<Arguments>(arguments)...);
    };
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALLBACK_GUARD_HPP_
