// Heartbeats of a managed node.
#ifndef ROBOSC_ROS2_BOND_HPP_
#define ROBOSC_ROS2_BOND_HPP_

#include <chrono>
#include <iomanip>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>

#include <bond/msg/status.hpp>
#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/countdown.hpp"
#include "robosc_ros2/shutdown_hook.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The node's end of a bond with nav2_lifecycle_manager. As in Nav2's own nodes, the bond has the node's name. It lasts
/// until one end breaks it. Only the manager watches the heartbeats.
///
/// The class bond::Bond of bondcpp has the same protocol. But its timers and its subscription have no guard.
class Bond {
 public:
  template <typename Node>
  Bond(Node& node, const CallbackGuard& guard) : clock_(node.get_clock()) {
    status_.id = node.get_name();
    status_.instance_id = instance();
    status_.heartbeat_timeout = 4;
    status_.heartbeat_period = std::chrono::duration<float>(kHeartbeat).count();
    publisher_ = rclcpp::create_publisher<Status>(node, "bond", rclcpp::QoS(5));
    subscription_ = node.template create_subscription<Status>("bond", rclcpp::QoS(100),
                                                              guard([this](const Status& other) { hear(other); }));
    // The manager measures the silence in real time, also while a simulation is paused.
    heartbeat_.emplace(std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME), guard, kHeartbeat, [this] {
      publish(true);
      heartbeat_->start();
    });
    heartbeat_->start();
  }

  Bond(const Bond&) = delete;
  Bond& operator=(const Bond&) = delete;

  /// Breaks the bond.
  ~Bond() {
    publish(false);
    flush(*publisher_);
  }

 private:
  using Status = bond::msg::Status;

  static constexpr std::chrono::milliseconds kHeartbeat{100};

  /// A name that differs from that of the other end, and from those of earlier bonds.
  static std::string instance() {
    std::random_device random;
    std::ostringstream text;
    for (int word = 0; word < 4; ++word) text << std::hex << std::setw(8) << std::setfill('0') << random();
    return text.str();
  }

  void hear(const Status& other) {
    if (other.id != status_.id || other.instance_id == status_.instance_id || other.active) return;
    heartbeat_->stop();  // The manager has broken the bond, and waits for the answer.
    publish(false);
  }

  void publish(bool active) {
    status_.header.stamp = clock_->now();
    status_.active = active;
    publisher_->publish(status_);
  }

  rclcpp::Clock::SharedPtr clock_;
  Status status_;
  rclcpp::Publisher<Status>::SharedPtr publisher_;
  rclcpp::Subscription<Status>::SharedPtr subscription_;
  std::optional<Countdown> heartbeat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_BOND_HPP_
