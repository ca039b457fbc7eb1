// Hands messages on that the supervisor lets through.
#ifndef ROBOSC_ROS1_MESSAGE_RELAY_HPP_
#define ROBOSC_ROS1_MESSAGE_RELAY_HPP_

#include <functional>
#include <string>
#include <utility>

#include <ros/ros.h>

#include "robosc/queue_depth.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Takes messages from one topic to another. What is published is latched from the first message on that comes latched.
template <typename Message>
class MessageRelay {
 public:
  /// `pass`: whether a message goes on.
  MessageRelay(const std::string& from, const std::string& to, std::function<bool(const Message&)> pass)
      : to_(to), pass_(std::move(pass)) {
    publisher_ = node_.advertise<Message>(to_, kQueueDepth);
    subscription_ = node_.subscribe<Event>(from, kQueueDepth,
                                           boost::function<void(Event)>([this](Event event) { received(event); }),
                                           ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  /// Sends a message to those who get what is handed on.
  void publish(const Message& message) { publisher_.publish(message); }

 private:
  using Event = const ros::MessageEvent<const Message>&;

  void received(Event event) {
    if (!pass_(*event.getConstMessage())) return;
    const auto latching = event.getConnectionHeader().find("latching");
    if (!latched_ && latching != event.getConnectionHeader().end() && latching->second == "1") {
      latched_ = true;
      publisher_.shutdown();
      publisher_ = node_.advertise<Message>(to_, kQueueDepth, true);
    }
    publisher_.publish(event.getConstMessage());
  }

  ros::NodeHandle node_;
  std::string to_;
  std::function<bool(const Message&)> pass_;
  bool latched_ = false;
  ros::Publisher publisher_;
  ros::Subscriber subscription_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_MESSAGE_RELAY_HPP_
