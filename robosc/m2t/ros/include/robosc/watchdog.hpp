// Notices when a topic falls silent.
#ifndef ROBOSC_WATCHDOG_HPP_
#define ROBOSC_WATCHDOG_HPP_

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Waits for the messages of a topic; the first one counts from `start` on.
template <typename Countdown>
class Watchdog {
 public:
  /// `patience` is the longest silence in milliseconds, 0 any; `fell_silent` is called once for each longer one.
  /// `place`: what a countdown begins with.
  template <typename... Place>
  Watchdog(int patience, std::function<void(const Watchdog&)> fell_silent, Place&... place)
      : patience_(patience), fell_silent_(std::move(fell_silent)) {
    if (patience == 0) return;
    countdown_.emplace(place..., std::chrono::milliseconds(patience), [this] {
      silent_ = true;
      fell_silent_(*this);
    });
  }

  void start() {
    watching_ = countdown_.has_value();
    if (watching_) countdown_->start();
  }

  void stop() {
    if (watching_) countdown_->stop();
    watching_ = false;
    silent_ = false;
  }

  /// A message came. True: it ended a silence.
  bool hear() {
    if (watching_) countdown_->start();
    return std::exchange(silent_, false);
  }

  bool silent() const { return silent_; }
  int patience() const { return patience_; }

 private:
  int patience_;
  std::function<void(const Watchdog&)> fell_silent_;
  std::optional<Countdown> countdown_;
  bool watching_ = false;
  bool silent_ = false;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_WATCHDOG_HPP_
