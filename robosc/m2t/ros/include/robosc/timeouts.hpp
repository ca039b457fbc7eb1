// The times of a model, without middleware.
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

/// Tells the engine what time it is, and has it look when the next time of the model is up. A derived class has the
/// clock and one timer on it.
class Timeouts {
 public:
  /// What the engine does at a time in milliseconds, which wraps.
  struct Engine {
    std::function<void(std::uint32_t)> restart;  ///< All times that run begin anew.
    std::function<std::uint32_t(std::uint32_t)>
        wait;                                   ///< How long until the next one is up; the largest number: never.
    std::function<bool(std::uint32_t)> expire;  ///< Handles one that is up; false: none is.
    /// Takes in what came before the next one was up; false: times do not count now.
    std::function<bool()> hear = [] { return true; };
  };

  Timeouts(const Timeouts&) = delete;
  Timeouts& operator=(const Timeouts&) = delete;
  virtual ~Timeouts() = default;

  /// The time in whole milliseconds, rounded down; it wraps.
  std::uint32_t now() const { return static_cast<std::uint32_t>(nanoseconds() / kMillisecond); }

  /// The same for an event that happens. A clock that begins late starts all times.
  std::uint32_t at() {
    const std::uint32_t time = now();
    if (late_ && has_begun()) {
      late_ = false;
      engine_.restart(time);
    }
    return time;
  }

  /// Looks when the next time is up, unless it does before. To be called after whatever may start one.
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

  /// All times that run begin anew.
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
  /// Calls `ring` once in so many milliseconds, and not when it was to be called.
  virtual void set(std::chrono::milliseconds left) = 0;

  /// Some time may be up.
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
  std::optional<std::int64_t> up_;  ///< When it looks.
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_TIMEOUTS_HPP_
