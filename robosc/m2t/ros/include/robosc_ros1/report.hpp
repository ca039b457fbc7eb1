// Topics with reports of a node about itself.
#ifndef ROBOSC_ROS1_REPORT_HPP_
#define ROBOSC_ROS1_REPORT_HPP_

#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "robosc/queue_depth.hpp"
#include "robosc/transitions.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Message>
class Report {
 public:
  void open(ros::NodeHandle& node, const std::string& topic) {
    publisher_ = node.advertise<Message>(topic, kQueueDepth);
  }

  /// Opens the topic and keeps the last message for later subscribers.
  void open_lasting(ros::NodeHandle& node, const std::string& topic) {
    publisher_ = node.advertise<Message>(topic, 1, true);
  }

  /// Whether there are subscribers.
  bool heard() const { return publisher_.getNumSubscribers() > 0; }
  /// Whether to publish: the state has `changed` and there are subscribers, or there is a new one.
  bool due(bool changed) { return audience_.waits(publisher_.getNumSubscribers(), changed); }

  void publish(const Message& message) const { publisher_.publish(message); }

  /// Publishes a message that contains a text.
  void publish_text(const std::string& text) const {
    Message message;
    message.data = text;
    publish(message);
  }

 private:
  ros::Publisher publisher_;
  Audience audience_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_REPORT_HPP_
