// Detection of silent topics.
#ifndef ROBOSC_WATCHDOG_HPP_
#define ROBOSC_WATCHDOG_HPP_

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Watches the messages of a topic. The wait for the first one begins at `start`.
template <typename Countdown>
class Watchdog {
 public:
  /// `patience`: the longest allowed silence in milliseconds, 0 for any. `fell_silent` is called once for each longer
  /// silence. `place`: first arguments of a countdown.
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

  /// Records a message. Returns true if it ended a silence.
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
