// Detection of lost action servers.
#ifndef ROBOSC_ROS2_ACTION_SERVERS_HPP_
#define ROBOSC_ROS2_ACTION_SERVERS_HPP_

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <rclcpp/rclcpp.hpp>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The servers of one action. A crashed server sends no notice, and a restarted one offers the same services. The
/// server of a goal is gone if none of the servers at the start of the goal is left.
class ActionServers {
 public:
  template <typename Node>
  ActionServers(Node& node, const std::string& action)
      : servers_([&node, action] { return node.get_publishers_info_by_topic(action + "/_action/status"); }) {}

  /// Records the current servers as those of a new goal.
  void remember() {
    then_ = servers_();
    gone_ = false;
  }

  /// Whether the recorded servers are gone. Call it repeatedly.
  bool are_gone() {
    if (++looks_ % kLooks != 0) return gone_;
    const auto is_left = [this](const rclcpp::TopicEndpointInfo& now) {
      return std::any_of(then_.begin(), then_.end(), [&now](const rclcpp::TopicEndpointInfo& then) {
        return now.endpoint_gid() == then.endpoint_gid();
      });
    };
    try {
      const std::vector<rclcpp::TopicEndpointInfo> now = servers_();
      gone_ = std::none_of(now.begin(), now.end(), is_left);
    } catch (const rclcpp::exceptions::RCLError&) {
      // The context is closed: the node is at its end.
    }
    return gone_;
  }

 private:
  static constexpr int kLooks = 4;  ///< Number of calls per query of the graph.

  std::function<std::vector<rclcpp::TopicEndpointInfo>()> servers_;
  std::vector<rclcpp::TopicEndpointInfo> then_;
  bool gone_ = false;
  int looks_ = 0;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_SERVERS_HPP_
