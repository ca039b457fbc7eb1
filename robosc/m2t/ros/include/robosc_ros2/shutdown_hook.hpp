// Functions to run before ROS closes.
#ifndef ROBOSC_ROS2_SHUTDOWN_HOOK_HPP_
#define ROBOSC_ROS2_SHUTDOWN_HOOK_HPP_

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Waits for a bounded time until the sent messages have arrived.
inline void flush(rclcpp::PublisherBase& publisher) {
  try {
    publisher.wait_for_all_acked(std::chrono::milliseconds(200));
  } catch (const std::exception&) {
    // Not every middleware reports that. Then do not wait.
  }
}

/// Calls a function once before the context closes, or at the destruction of the node, while it can still send. The
/// context stays open while the node `waits`. A node that is destroyed before its context does not wait.
///
/// The context closes in a separate thread, so a beat of the guard calls the function. If there is none for a second,
/// that thread calls it.
class ShutdownHook {
 public:
  template <typename Node>
  ShutdownHook(Node& node, const CallbackGuard& guard, std::function<void()> function, std::function<bool()> waits)
      : function_(std::move(function)),
        waits_(std::move(waits)),
        logger_(node.get_logger()),
        context_(node.get_node_base_interface()->get_context()),
        guard_(guard.sibling()),
        beat_(guard_.at_each_beat([this] {
          if (closes_ && !finished_) serve();
        })) {
    handle_ = context_->add_pre_shutdown_callback([this] {
      const std::future<void> done = done_.get_future();
      closes_ = true;
      while (done.wait_for(std::chrono::seconds(1)) != std::future_status::ready) {
        if (!served_.exchange(false)) return run();
      }
    });
  }

  ShutdownHook(const ShutdownHook&) = delete;
  ShutdownHook& operator=(const ShutdownHook&) = delete;

  ~ShutdownHook() {
    context_->remove_pre_shutdown_callback(handle_);
    guard_.close();
    run();
  }

 private:
  void serve() {
    served_ = true;
    run();
    if (waits_()) return;
    finished_ = true;
    done_.set_value();
  }

  void run() {
    if (started_.exchange(true)) return;
    try {
      function_();
    } catch (const std::exception& error) {
      RCLCPP_ERROR(logger_, "while it ends: %s", error.what());
    }
  }

  std::function<void()> function_;
  std::function<bool()> waits_;
  rclcpp::Logger logger_;
  rclcpp::Context::SharedPtr context_;
  rclcpp::PreShutdownCallbackHandle handle_;
  std::atomic<bool> closes_{false};
  std::atomic<bool> started_{false};
  std::atomic<bool> served_{false};
  bool finished_ = false;  ///< Used by the node's executor only.
  std::promise<void> done_;
  CallbackGuard guard_;
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SHUTDOWN_HOOK_HPP_
