// The timers of a model, independent of the middleware.
#ifndef ROBOSC_TIMEOUTS_HPP_
#define ROBOSC_TIMEOUTS_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Connects the engine's timers to a clock: calls the engine when the next timer expires. A derived class has the clock
/// and one timer on it.
class Timeouts {
 public:
  /// Functions of the engine. They take a time in milliseconds, which wraps.
  struct Engine {
    std::function<void(std::uint32_t)> restart;  ///< Restarts all running timers.
    std::function<std::uint32_t(std::uint32_t)>
        wait;                                   ///< The time until the next timer expires. The largest number: never.
    std::function<bool(std::uint32_t)> expire;  ///< Handles an expired timer. Returns false if there is none.
    /// Handles messages that arrived before the next timer expired. Returns false if timers are ignored now.
    std::function<bool()> hear = [] { return true; };
  };

  Timeouts(const Timeouts&) = delete;
  Timeouts& operator=(const Timeouts&) = delete;
  virtual ~Timeouts() = default;

  /// The time in whole milliseconds, rounded down. It wraps.
  std::uint32_t now() const { return static_cast<std::uint32_t>(nanoseconds() / kMillisecond); }

  /// The time of an event. The late start of a clock restarts all timers.
  std::uint32_t at() {
    const std::uint32_t time = now();
    if (late_ && has_begun()) {
      late_ = false;
      engine_.restart(time);
    }
    return time;
  }

  /// Schedules the next call of the engine, unless an earlier one is scheduled. Call it after each function that may
  /// start a timer.
  void wait() {
    const std::uint32_t left = engine_.wait(now());
    const std::int64_t up = nanoseconds() + left * kMillisecond;
    if (left == std::numeric_limits<std::uint32_t>::max() || (up_ && *up_ <= up)) return;
    up_ = up;
    set(std::chrono::milliseconds(left));
  }

  /// Handles the timers that have expired by now, even if the middleware has not called for them yet.
  void catch_up() {
    if (engine_.wait(now()) == 0) ring();
  }

  /// Restarts all running timers.
  void restart() {
    engine_.restart(now());
    wait();
  }

 protected:
  /// `late`: whether the clock has not begun.
  Timeouts(Engine engine, bool late) : engine_(std::move(engine)), late_(late) {}

  /// The time of the clock.
  virtual std::int64_t nanoseconds() const = 0;
  /// Whether the clock has begun.
  virtual bool has_begun() const = 0;
  /// Calls `ring` once after `left`, in the place of an earlier scheduled call.
  virtual void set(std::chrono::milliseconds left) = 0;

  /// Handles expired timers, if there are any.
  void ring() {
    up_.reset();
    if (!engine_.hear()) return;
    while (engine_.expire(at())) {
    }
    wait();
  }

 private:
  static constexpr std::int64_t kMillisecond = 1000000;

  const Engine engine_;
  bool late_;
  std::optional<std::int64_t> up_;  ///< The scheduled time of the next call.
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_TIMEOUTS_HPP_
