// Handling of SIGHUP.
#ifndef ROBOSC_HANGUP_HPP_
#define ROBOSC_HANGUP_HPP_

#include <csignal>
#include <mutex>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Ends the process on a hangup as on SIGTERM, during the lifetime of this object. A hangup means that the terminal or
/// the connection to the robot is gone. By default it would kill the node without stopping the robot. rclcpp handles
/// SIGTERM. An ignored hangup (nohup) or an existing handler stays.
class Hangup {
 public:
#ifdef SIGHUP
  Hangup() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (++users_ > 1) return;
    struct sigaction action = {};
    sigaction(SIGHUP, nullptr, &action);
    if (!handled_by(action, SIG_DFL)) return;
    action.sa_handler = end;
    action.sa_flags = SA_RESTART;
    sigaction(SIGHUP, &action, nullptr);
  }

  ~Hangup() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--users_ > 0) return;
    struct sigaction action = {};
    sigaction(SIGHUP, nullptr, &action);
    if (!handled_by(action, end)) return;
    action.sa_handler = SIG_DFL;
    sigaction(SIGHUP, &action, nullptr);
  }

  Hangup(const Hangup&) = delete;
  Hangup& operator=(const Hangup&) = delete;

 private:
  static void end(int) { std::raise(SIGTERM); }

  static bool handled_by(const struct sigaction& action, void (*function)(int)) {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == function;
  }

  inline static std::mutex mutex_;
  inline static int users_ = 0;
#endif
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_HANGUP_HPP_
