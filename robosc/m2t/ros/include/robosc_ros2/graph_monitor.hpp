// What is wrong around the node.
#ifndef ROBOSC_ROS2_GRAPH_MONITOR_HPP_
#define ROBOSC_ROS2_GRAPH_MONITOR_HPP_

#include <algorithm>
#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Looks once a second at who else is on the node's topics, and says once, by name, what keeps them from working.
class GraphMonitor {
 public:
  template <typename Node>
  GraphMonitor(Node& node, const CallbackGuard& guard)
      : logger_(node.get_logger()),
        publishers_([&node](const std::string& topic) { return node.get_publishers_info_by_topic(topic); }),
        subscriptions_([&node](const std::string& topic) { return node.get_subscriptions_info_by_topic(topic); }),
        timer_(node.create_wall_timer(std::chrono::seconds(1), guard([this] { look(); }))) {}

  GraphMonitor(const GraphMonitor&) = delete;
  GraphMonitor& operator=(const GraphMonitor&) = delete;
  ~GraphMonitor() { stop(); }

  /// Looks no more: with its context closed, a node can't.
  void stop() { timer_->cancel(); }

  /// The node listens to a topic.
  void hear(const std::string& topic, const std::string& type, const rclcpp::QoS& quality) {
    heard_.push_back({topic, type, quality, {}});
  }

  /// The node commands a topic: it alone, as far as it knows.
  void command(const std::string& topic, const std::string& type, const rclcpp::QoS& quality, const rmw_gid_t& own) {
    commanded_.push_back({topic, type, quality, own});
  }

 private:
  struct Topic {
    std::string name;
    std::string type;
    rclcpp::QoS quality;
    rmw_gid_t own;
  };

  void look() {
    seconds_ += 1;
    for (const Topic& topic : heard_) {
      const auto others = publishers_(topic.name);
      if (others.empty() && seconds_ == 5) {
        // It may tell what seldom happens, such as that a button was pressed.
        RCLCPP_INFO(logger_, "%s: nobody publishes it after 5 s", topic.name.c_str());
      }
      for (const auto& other : others) {
        if (fits(topic, other, "publishes")) meets(topic, other, other.qos_profile(), topic.quality, "offers");
      }
    }
    for (const Topic& topic : commanded_) {
      for (const auto& other : publishers_(topic.name)) {
        if (!is_own(topic, other)) tell(topic.name + ": " + name(other) + " publishes it, too");
      }
      for (const auto& other : subscriptions_(topic.name)) {
        if (fits(topic, other, "expects")) meets(topic, other, topic.quality, other.qos_profile(), "asks for");
      }
    }
  }

  /// Whether both sides mean the same type.
  bool fits(const Topic& topic, const rclcpp::TopicEndpointInfo& other, const std::string& verb) {
    if (other.topic_type() == topic.type) return true;
    tell(topic.name + ": " + name(other) + " " + verb + " " + other.topic_type() + ", not " + topic.type);
    return false;
  }

  /// Whether what one side offers is enough for the other.
  void meets(const Topic& topic, const rclcpp::TopicEndpointInfo& other, const rclcpp::QoS& offered,
             const rclcpp::QoS& asked, const std::string& verb) {
    const auto result = rclcpp::qos_check_compatible(offered, asked);
    if (result.compatibility == rclcpp::QoSCompatibility::Error) {
      tell(topic.name + ": " + name(other) + " " + verb + " a quality of service that does not fit: " + result.reason);
    }
  }

  static bool is_own(const Topic& topic, const rclcpp::TopicEndpointInfo& other) {
    const auto& gid = other.endpoint_gid();
    return std::equal(gid.begin(), gid.end(), topic.own.data);
  }

  static std::string name(const rclcpp::TopicEndpointInfo& other) {
    const std::string& space = other.node_namespace();
    return (space == "/" ? space : space + "/") + other.node_name();
  }

  void tell(const std::string& text) {
    if (told_.insert(text).second) RCLCPP_WARN(logger_, "%s", text.c_str());
  }

  using Endpoints = std::function<std::vector<rclcpp::TopicEndpointInfo>(const std::string&)>;

  rclcpp::Logger logger_;
  Endpoints publishers_;
  Endpoints subscriptions_;
  std::vector<Topic> heard_;
  std::vector<Topic> commanded_;
  std::set<std::string> told_;
  int seconds_ = 0;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_GRAPH_MONITOR_HPP_
