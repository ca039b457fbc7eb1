// Topics with reports of a node about itself.
#ifndef ROBOSC_ROS2_REPORT_HPP_
#define ROBOSC_ROS2_REPORT_HPP_

#include <string>

#include <rclcpp/rclcpp.hpp>

#include "robosc/queue_depth.hpp"
#include "robosc/transitions.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Message>
class Report {
 public:
  template <typename Node>
  void open(Node& node, const std::string& topic, const rclcpp::QoS& quality = rclcpp::QoS(kQueueDepth)) {
    rclcpp::PublisherOptions options;
    options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
    publisher_ = rclcpp::create_publisher<Message>(node, topic, quality, options);
  }

  /// Opens the topic and keeps the last message for later subscribers.
  template <typename Node>
  void open_lasting(Node& node, const std::string& topic) {
    open(node, topic, rclcpp::QoS(1).transient_local());
  }

  void close() { *this = Report(); }

  /// Whether there are subscribers.
  bool heard() const { return publisher_->get_subscription_count() > 0; }
  /// Whether to publish: the state has `changed` and there are subscribers, or there is a new one.
  bool due(bool changed) { return audience_.waits(publisher_->get_subscription_count(), changed); }

  void publish(const Message& message) const { publisher_->publish(message); }

  /// Publishes a message that contains a text.
  void publish_text(const std::string& text) const {
    Message message;
    message.data = text;
    publish(message);
  }

 private:
  typename rclcpp::Publisher<Message>::SharedPtr publisher_;
  Audience audience_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_REPORT_HPP_
