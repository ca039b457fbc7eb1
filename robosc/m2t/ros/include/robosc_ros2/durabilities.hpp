// Detection of publishers that keep their last messages for late subscribers.
#ifndef ROBOSC_ROS2_DURABILITIES_HPP_
#define ROBOSC_ROS2_DURABILITIES_HPP_

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Watches the publishers of topics. A topic is lasting if all its publishers are transient-local and reliable. A
/// volatile subscription receives their messages, but not the kept ones. A transient-local subscription does not
/// receive from other publishers.
class Durabilities {
 public:
  template <typename Node>
  Durabilities(Node& node, const CallbackGuard& guard)
      : publishers_([&node](const std::string& topic) { return node.get_publishers_info_by_topic(topic); }),
        // Created here: the first event of a context takes its locks in another order than closing does.
        graph_(node.get_graph_event()),
        beat_(guard.at_each_beat([this] {
          if (graph_->check_and_clear()) look();
        })) {}

  Durabilities(const Durabilities&) = delete;
  Durabilities& operator=(const Durabilities&) = delete;

  /// Calls `changed` whenever a topic becomes lasting or no longer is. `lasting`: the known value, or nothing if
  /// unknown.
  void watch(const std::string& topic, std::function<void(bool)> changed, std::optional<bool> lasting = std::nullopt) {
    topics_.push_back({topic, std::move(changed), lasting});
    graph_->set();  // for existing publishers
  }

 private:
  struct Topic {
    std::string name;
    std::function<void(bool)> changed;
    std::optional<bool> lasting;
  };

  void look() {
    for (Topic& topic : topics_) {
      std::vector<rclcpp::TopicEndpointInfo> publishers;
      try {
        publishers = publishers_(topic.name);
      } catch (const rclcpp::exceptions::RCLError&) {
        return;  // The context is closed: the node is at its end.
      }
      if (publishers.empty()) continue;
      const bool lasting = std::all_of(publishers.begin(), publishers.end(), keeps);
      if (topic.lasting == lasting) continue;
      topic.lasting = lasting;
      topic.changed(lasting);
    }
  }

  static bool keeps(const rclcpp::TopicEndpointInfo& publisher) {
    return publisher.qos_profile().durability() == rclcpp::DurabilityPolicy::TransientLocal &&
           publisher.qos_profile().reliability() == rclcpp::ReliabilityPolicy::Reliable;
  }

  std::function<std::vector<rclcpp::TopicEndpointInfo>(const std::string&)> publishers_;
  std::vector<Topic> topics_;
  rclcpp::Event::SharedPtr graph_;
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_DURABILITIES_HPP_
