// Callbacks that end with what they belong to.
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

/// Keeps callbacks off what is being destroyed. A multi-threaded container unloads a component in one thread while
/// another one still calls back, or is about to. Guarded callbacks run one at a time; none begins after `close`, which
/// waits for the one that runs.
class CallbackGuard {
 public:
  CallbackGuard() = default;
  CallbackGuard(const CallbackGuard&) = delete;
  CallbackGuard& operator=(const CallbackGuard&) = delete;
  ~CallbackGuard() { close(); }

  /// The function, doing nothing once the guard was closed after this.
  template <typename Function>
  auto operator()(Function function) const {
    return guarded(std::function(std::move(function)));
  }

  /// While this is held, no guarded callback runs in another thread.
  std::unique_lock<std::recursive_mutex> hold() const { return std::unique_lock<std::recursive_mutex>(state_->mutex); }

  void close() {
    ++state_->closed;  // Before it waits: who comes now does not take the lock, else they could keep it from us.
    const auto lock = hold();
  }

 private:
  struct State {
    std::recursive_mutex mutex;
    std::atomic<std::uint64_t> closed{0};  ///< How often.
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

/// Takes a callback group from its executor for good, as soon as nothing of it runs: what rclcpp itself has in it (the
/// services of parameters, of a managed node) can't be guarded. The executor must not find the group taken while it
/// chooses what to run: rclcpp asserts that it does not. So it may first let go of the group's services, as it does
/// once it hears that the node was removed; then only their owner and who looks here point to them. An executor that
/// runs this can't, and one that is busy does not for now: neither is waited for long.
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
