// Hands messages on that the supervisor lets through.
#ifndef ROBOSC_ROS2_MESSAGE_RELAY_HPP_
#define ROBOSC_ROS2_MESSAGE_RELAY_HPP_

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/arrivals.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Takes messages from one topic to another.
///
/// What is published is reliable, and transient-local where all who publish the messages are. That must be known before
/// the subscription is made: it begins when the first publisher is seen.
template <typename Message>
class MessageRelay {
 public:
  /// `pass`: whether a message goes on.
  MessageRelay(rclcpp::Node& node, const CallbackGuard& guard, const std::string& from, const std::string& to,
               const rclcpp::QoS& received, const rclcpp::QoS& sent, std::function<bool(const Message&)> pass)
      : node_(node),
        guard_(guard),
        from_(from),
        to_(to),
        received_(received),
        sent_(sent),
        pass_(std::move(pass)),
        // Here, since the first one of a context takes locks of it that its closing takes in another order.
        graph_(node.get_graph_event()) {
    graph_->set();  // for those who are there already
    publisher_ = node.create_publisher<Message>(to, sent_);
    look_ = node.create_wall_timer(std::chrono::milliseconds(20), guard([this] { look(); }));
  }

  /// Hands on what has arrived already.
  void hear() {
    if (subscription_ != nullptr) hear_all(*subscription_, [this](const Message& message) { forward(message); });
  }

 private:
  void look() {
    if (!graph_->check_and_clear()) return;
    std::vector<rclcpp::TopicEndpointInfo> publishers;
    try {
      publishers = node_.get_publishers_info_by_topic(from_);
    } catch (const rclcpp::exceptions::RCLError&) {
      return;  // The context is closed: the node is at its end.
    }
    if (publishers.empty()) return;
    const bool lasting =
        std::all_of(publishers.begin(), publishers.end(), [](const rclcpp::TopicEndpointInfo& publisher) {
          return publisher.qos_profile().durability() == rclcpp::DurabilityPolicy::TransientLocal;
        });
    if (subscription_ != nullptr && lasting == lasting_) return;
    if (lasting != lasting_) {
      lasting_ = lasting;
      const auto durability = lasting ? rclcpp::DurabilityPolicy::TransientLocal : rclcpp::DurabilityPolicy::Volatile;
      received_.durability(durability);
      sent_.durability(durability);
      publisher_ = node_.create_publisher<Message>(to_, sent_);
    }
    const auto received = guard_([this](std::shared_ptr<const Message> message) { forward(*message); });
    subscription_ = node_.create_subscription<Message>(from_, received_, received);
  }

  void forward(const Message& message) {
    if (pass_(message)) publisher_->publish(message);
  }

  rclcpp::Node& node_;
  const CallbackGuard& guard_;
  std::string from_;
  std::string to_;
  rclcpp::QoS received_;
  rclcpp::QoS sent_;
  std::function<bool(const Message&)> pass_;
  rclcpp::Event::SharedPtr graph_;
  bool lasting_ = false;
  std::shared_ptr<rclcpp::Publisher<Message>> publisher_;
  std::shared_ptr<rclcpp::Subscription<Message>> subscription_;
  rclcpp::TimerBase::SharedPtr look_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_MESSAGE_RELAY_HPP_
