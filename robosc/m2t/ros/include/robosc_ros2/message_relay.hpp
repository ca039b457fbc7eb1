// Forwarded messages that the supervisor permits.
#ifndef ROBOSC_ROS2_MESSAGE_RELAY_HPP_
#define ROBOSC_ROS2_MESSAGE_RELAY_HPP_

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/arrivals.hpp"
#include "robosc_ros2/durabilities.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Forwards messages from one topic to another.
///
/// Publishes reliably, and transient-local if the publishers of the messages keep them. The relay must know that before
/// it subscribes. So it subscribes when it sees the first publisher.
template <typename Message>
class MessageRelay {
 public:
  /// `kept`: quality of service for messages that their publishers keep. `pass`: returns whether to forward a message.
  MessageRelay(rclcpp::Node& node, const CallbackGuard& guard, const std::string& from, const std::string& to,
               const rclcpp::QoS& received, const rclcpp::QoS& kept, const rclcpp::QoS& sent,
               std::function<bool(const Message&)> pass)
      : node_(node),
        guard_(guard),
        from_(from),
        to_(to),
        received_(received),
        kept_(kept),
        sent_(sent),
        pass_(std::move(pass)),
        durabilities_(node, guard) {
    publisher_ = node.create_publisher<Message>(to, sent_);
    durabilities_.watch(from, [this](bool lasting) { open(lasting); });
  }

  /// Handles messages that have already arrived.
  void hear() {
    if (subscription_ != nullptr) hear_all(*subscription_, [this](const Message& message) { forward(message); });
  }

  /// Publishes a message to the subscribers of forwarded messages.
  void publish(const Message& message) { publisher_->publish(message); }

 private:
  void open(bool lasting) {
    if (lasting != lasting_) {
      lasting_ = lasting;
      sent_.durability(lasting ? rclcpp::DurabilityPolicy::TransientLocal : rclcpp::DurabilityPolicy::Volatile);
      publisher_ = node_.create_publisher<Message>(to_, sent_);
    }
    const auto received = guard_([this](std::shared_ptr<const Message> message) { forward(*message); });
    subscription_ = node_.create_subscription<Message>(from_, lasting ? kept_ : received_, received);
  }

  void forward(const Message& message) {
    if (pass_(message)) publish(message);
  }

  rclcpp::Node& node_;
  const CallbackGuard& guard_;
  std::string from_;
  std::string to_;
  rclcpp::QoS received_;
  rclcpp::QoS kept_;
  rclcpp::QoS sent_;
  std::function<bool(const Message&)> pass_;
  bool lasting_ = false;
  std::shared_ptr<rclcpp::Publisher<Message>> publisher_;
  std::shared_ptr<rclcpp::Subscription<Message>> subscription_;
  Durabilities durabilities_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_MESSAGE_RELAY_HPP_
