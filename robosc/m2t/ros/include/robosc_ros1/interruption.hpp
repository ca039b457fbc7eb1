// How the node is asked to end.
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

/// Seconds that the end of a node waits for what becomes of its goals.
inline constexpr double kLongestEnd = 0.5;

/// Waits for Ctrl-C, SIGTERM, a hangup, `rosnode kill` or a new node of the same name, so that ROS is still there for
/// the last messages. To be made before any thread starts.
class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    struct sigaction hangup = {};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);  // else it was started with nohup
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }

  /// Takes the master's request to end in the place of ROS; between `ros::init` and the first node handle.
  static void take_requests() {
    ros::XMLRPCManager::instance()->bind("shutdown", [](XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
      result = ros::xmlrpc::responseInt(1, "", 0);
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!ending_) kill(getpid(), SIGTERM);
    });
  }

  /// Waits until a condition holds, and says after a second what is missing; false: the node shall end before.
  template <typename Condition>
  bool wait_until(Condition condition, const std::string& missing) {
    const timespec pause = {0, 20'000'000};
    for (int rounds = 0; !condition(); ++rounds) {
      if (rounds == 50) ROS_WARN_STREAM("waiting for " << missing);
      if (sigtimedwait(&signals_, nullptr, &pause) > 0) return false;
    }
    return true;
  }

  /// Waits until the node shall end.
  void wait() {
    int signal = 0;
    sigwait(&signals_, &signal);
  }

  /// From now on signals end the process at once, as usual; not those that meanwhile asked for the same once more.
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
  inline static bool ending_ = false;  ///< Requests have nothing left to ask for.
  sigset_t signals_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_INTERRUPTION_HPP_
