// Protection of destroyed objects from late callbacks.
#ifndef ROBOSC_CALLBACK_GUARD_HPP_
#define ROBOSC_CALLBACK_GUARD_HPP_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
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

  /// The function, without effect if the guard is closed after this call.
  template <typename Function>
  auto operator()(Function function) const {
    return guarded(std::function(std::move(function)));
  }

  /// While you hold this lock, no guarded callback runs in another thread.
  std::unique_lock<std::recursive_mutex> hold() const { return std::unique_lock<std::recursive_mutex>(state_->mutex); }

  void close() {
    ++state_->closed;  // Counts before it locks: new callbacks skip the lock and can't starve this thread.
    const auto lock = hold();
  }

 private:
  struct State {
    std::recursive_mutex mutex;
    std::atomic<std::uint64_t> closed{0};  ///< The number of calls of `close`.
  };

  template <typename... Arguments>
  std::function<void(Arguments...)> guarded(std::function<void(Arguments...)> function) const {
    const auto lock = hold();
    return [state = state_, closed = state_->closed.load(), function = std::move(function)](Arguments... arguments) {
      if (state->closed != closed) return;
      const std::lock_guard<std::recursive_mutex> running(state->mutex);
      if (state->closed == closed) function(std::forward<Arguments>(arguments)...);
    };
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

/// Takes a callback group from its executor for good, once none of its callbacks runs. The services that rclcpp adds to
/// the group (for parameters and the lifecycle) can't be guarded. The group must not become taken while the executor
/// selects a callback: rclcpp asserts that. So the function first lets the executor release the group's services. The
/// executor does so when it learns that the node was removed. Then only their owner and this function refer to them. An
/// executor cannot release them while it runs this function or another callback. So both waits are bounded.
template <typename Group>
void withdraw(Group& group) {
  const auto until = [start = std::chrono::steady_clock::now()](std::chrono::milliseconds patience, auto condition) {
    while (!condition() && std::chrono::steady_clock::now() - start < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  const auto held = [](const auto& service) { return service.use_count() > 2; };
  until(std::chrono::milliseconds(50), [&] { return group.find_service_ptrs_if(held) == nullptr; });
  until(std::chrono::seconds(5), [&] { return group.can_be_taken_from().exchange(false); });
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALLBACK_GUARD_HPP_
