// Requests to end the node.
#ifndef ROBOSC_ROS1_INTERRUPTION_HPP_
#define ROBOSC_ROS1_INTERRUPTION_HPP_

#include <unistd.h>
#include <csignal>
#include <ctime>
#include <mutex>
#include <string>

#include <ros/console.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The longest wait in seconds at the end of a node for the ends of its goals.
inline constexpr double kLongestEnd = 0.5;

/// Waits for Ctrl-C, SIGTERM, a hangup, `rosnode kill` or a new node of the same name. Keeps ROS available for the last
/// messages. Create it before any thread starts.
class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    struct sigaction hangup = {};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);  // ignored after a start with nohup
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }

  /// Replaces ROS's handler of the master's request to end. Call it between `ros::init` and the first node handle.
  static void take_requests() {
    ros::XMLRPCManager::instance()->bind("shutdown", [](XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
      result = ros::xmlrpc::responseInt(1, "", 0);
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!ending_) kill(getpid(), SIGTERM);
    });
  }

  /// Waits until a condition holds. After a second, warns about `missing`. Returns false if the node has to end before.
  template <typename Condition>
  bool wait_until(Condition condition, const std::string& missing) {
    const timespec pause = {0, 20'000'000};
    for (int rounds = 0; !condition(); ++rounds) {
      if (rounds == 50) ROS_WARN_STREAM("waiting for " << missing);
      if (sigtimedwait(&signals_, nullptr, &pause) > 0) return false;
    }
    return true;
  }

  /// Waits for a request to end the node.
  void wait() {
    int signal = 0;
    sigwait(&signals_, &signal);
  }

  /// Restores the default: from now on, a signal ends the process at once. Discards pending repeated requests.
  void let_go() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
    const timespec now = {};
    while (sigtimedwait(&signals_, nullptr, &now) > 0) {
    }
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  }

 private:
  inline static std::mutex mutex_;
  inline static bool ending_ = false;  ///< Further requests have no effect.
  sigset_t signals_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_INTERRUPTION_HPP_
