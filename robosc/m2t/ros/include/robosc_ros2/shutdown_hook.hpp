// What is done before ROS closes.
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

/// Waits, not for long, until what was sent has arrived.
inline void flush(rclcpp::PublisherBase& publisher) {
  try {
    publisher.wait_for_all_acked(std::chrono::milliseconds(200));
  } catch (const std::exception&) {
    // Not every middleware can tell; then nobody waits.
  }
}

/// Calls a function once before the context closes, or when the node goes: while it can still send. The context stays
/// open while the node `waits`; a node that goes before its context does not wait.
///
/// The context closes in a thread of its own, so the function is handed to the executor of the node; only where none
/// is running for a second does that thread call it.
class ShutdownHook {
 public:
  template <typename Node>
  ShutdownHook(
      Node& node, std::function<void()> function, std::function<bool()> waits = [] { return false; })
      : function_(std::move(function)),
        logger_(node.get_logger()),
        context_(node.get_node_base_interface()->get_context()) {
    timer_ = node.create_wall_timer(std::chrono::milliseconds(1), guard_([this, waits = std::move(waits)] {
                                      if (finished_) return;  // An events executor had this call in its queue.
                                      served_ = true;
                                      run();
                                      if (waits()) return;
                                      finished_ = true;
                                      timer_->cancel();
                                      done_.set_value();
                                    }));
    timer_->cancel();
    handle_ = context_->add_pre_shutdown_callback([this] {
      const std::future<void> done = done_.get_future();
      timer_->reset();
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
  void run() {
    if (started_.exchange(true)) return;
    try {
      function_();
    } catch (const std::exception& error) {
      RCLCPP_ERROR(logger_, "while it ends: %s", error.what());
    }
  }

  std::function<void()> function_;
  rclcpp::Logger logger_;
  rclcpp::Context::SharedPtr context_;
  rclcpp::PreShutdownCallbackHandle handle_;
  rclcpp::TimerBase::SharedPtr timer_;
  std::atomic<bool> started_{false};
  std::atomic<bool> served_{false};
  bool finished_ = false;  ///< Only the executor of the node reads and sets it.
  std::promise<void> done_;
  CallbackGuard guard_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SHUTDOWN_HOOK_HPP_
