// Protection of destroyed objects from late callbacks.
#ifndef ROBOSC_CALLBACK_GUARD_HPP_
#define ROBOSC_CALLBACK_GUARD_HPP_

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
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
  CallbackGuard sibling() const { return CallbackGuard(shared_); }

  /// The function, without effect if the guard is closed after this call.
  template <typename Function>
  auto operator()(Function function) const {
    return guarded(std::function(std::move(function)));
  }

  /// While you hold this lock, no guarded callback runs in another thread.
  std::unique_lock<std::recursive_mutex> hold() const { return std::unique_lock<std::recursive_mutex>(shared_->mutex); }

  void close() {
    ++*closed_;  // Counts before it locks: new callbacks skip the lock and can't starve this thread.
    const auto lock = hold();
  }

  /// A function that each `beat` calls. It ends with the last copy of this pointer, or when the guard is closed.
  using Beat = std::shared_ptr<const std::function<void()>>;
  Beat at_each_beat(std::function<void()> function) const {
    const auto lock = hold();
    const auto beat = std::make_shared<const std::function<void()>>((*this)(std::move(function)));
    shared_->beats.push_back(beat);
    return beat;
  }

  /// Calls the functions of this guard and its siblings.
  void beat() const {
    const auto lock = hold();
    auto& beats = shared_->beats;
    for (auto next = beats.begin(); next != beats.end();) {
      if (const Beat beat = next->lock()) {
        (*beat)();
        ++next;
      } else {
        next = beats.erase(next);
      }
    }
  }

 private:
  struct Shared {
    std::recursive_mutex mutex;
    std::list<std::weak_ptr<const std::function<void()>>> beats;
  };

  explicit CallbackGuard(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

  template <typename... Arguments>
  std::function<void(Arguments...)> guarded(std::function<void(Arguments...)> function) const {
    const auto lock = hold();
    return [shared = shared_, closed = closed_, open = closed_->load(),
            function = std::move(function)](Arguments... arguments) {
      if (*closed != open) return;
      const std::lock_guard<std::recursive_mutex> running(shared->mutex);
      if (*closed == open) function(std::forward<Arguments>(arguments)...);
    };
  }

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  /// The number of calls of `close`.
  std::shared_ptr<std::atomic<std::uint64_t>> closed_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALLBACK_GUARD_HPP_
