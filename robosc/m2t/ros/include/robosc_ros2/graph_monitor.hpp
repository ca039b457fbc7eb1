// Monitor of the ROS graph around the node.
#ifndef ROBOSC_ROS2_GRAPH_MONITOR_HPP_
#define ROBOSC_ROS2_GRAPH_MONITOR_HPP_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/rclcpp.hpp>
#include <rosidl_runtime_cpp/traits.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Checks once a second the other nodes on the node's topics and the servers of its calls. Reports once by name each
/// fault that prevents communication. `faults` returns a fault as long as it lasts. For a layer, it also reports nodes
/// that go around it.
class GraphMonitor {
 public:
  template <typename Node>
  GraphMonitor(Node& node, const CallbackGuard& guard)
      : logger_(node.get_logger()),
        self_(node.get_fully_qualified_name()),
        graph_(node.get_node_graph_interface()),
        services_(node.get_node_services_interface()),
        beat_(guard.at_each_beat([this] {
          const auto now = std::chrono::steady_clock::now();
          if (now < next_) return;
          next_ = now + std::chrono::seconds(1);
          look();
        })) {}

  GraphMonitor(const GraphMonitor&) = delete;
  GraphMonitor& operator=(const GraphMonitor&) = delete;

  /// Stops the checks. A node can't query the graph after its context is closed.
  void stop() { beat_.reset(); }

  /// Adds a topic that the node receives, or updates its quality of service.
  void hear(const std::string& topic, const std::string& type, const rclcpp::QoS& quality) {
    const auto known = std::find_if(heard_.begin(), heard_.end(), [&](const Topic& one) { return one.name == topic; });
    if (known == heard_.end()) {
      heard_.push_back({topic, type, quality, {}});
    } else {
      known->quality = quality;
    }
  }

  /// Adds a topic that the node commands. The node should be its only publisher.
  void command(const std::string& topic, const std::string& type, const rclcpp::QoS& quality, const rmw_gid_t& own) {
    commanded_.push_back({topic, type, quality, own});
  }

  /// Adds a topic of commands that a layer forwards. It must be their only publisher.
  template <typename Message>
  void guard(const std::string& topic) {
    guarded_.push_back({topic, rosidl_generator_traits::name<Message>(), rclcpp::QoS(1), {}});
  }

  /// Adds a service that the node calls, which may be a part of an action. `guarded`: only a layer may call it.
  void call(const std::string& name, const std::string& part, const std::string& type, bool guarded = false) {
    const std::string verb = part.empty() ? "calls it" : "sends goals";
    called_.push_back({name, services_->resolve_service_name(name + part), type, guarded ? verb : ""});
  }

  /// The faults of a topic, service or action at the last check.
  std::vector<std::string> faults(const std::string& name) const {
    const auto found = faults_.find(name);
    return found == faults_.end() ? std::vector<std::string>() : found->second;
  }

  /// Whether all servers of a service or action at the last check had another type.
  bool has_other_type(const std::string& name) const { return other_types_.count(name) > 0; }

 private:
  // Checks for which two nodes of one name may serve: after a crash and restart, the graph has both for 20 s.
  static constexpr int kLease = 25;

  struct Topic {
    std::string name;
    std::string type;
    rclcpp::QoS quality;
    rmw_gid_t own;
    int missing = 0;  ///< Number of checks without a publisher.
  };

  struct Called {
    std::string name;
    std::string service;
    std::string type;
    std::string verb;  ///< What other clients do that go around a layer. Empty: they may.
    int twice = 0;     ///< Number of checks with two servers of one name.
  };

  void look() {
    faults_.clear();
    other_types_.clear();
    try {
      for (Topic& topic : heard_) look_at_publishers(topic);
      for (const Topic& topic : commanded_) look_at_listeners(topic);
      for (const Topic& topic : guarded_) look_around(topic);
      if (!called_.empty()) types_ = graph_->get_service_names_and_types();
      for (Called& called : called_) {
        look_at_servers(called);
        if (!called.verb.empty()) look_at_callers(called);
      }
    } catch (const std::exception&) {
      // The context is closed: the node is at its end.
    }
  }

  void look_at_publishers(Topic& topic) {
    const auto others = graph_->get_publishers_info_by_topic(topic.name);
    const bool is_missing =
        std::all_of(others.begin(), others.end(), [this](const auto& other) { return is_self(other); });
    topic.missing = is_missing ? topic.missing + 1 : 0;
    if (topic.missing >= 5) {
      // While a robot starts, publishers are often late. So the log contains no warning.
      note(topic.name, topic.name + ": nobody publishes it");
      const std::string text = topic.name + ": nobody publishes it after 5 s";
      if (told_.insert(text).second) RCLCPP_INFO(logger_, "%s", text.c_str());
    }
    for (const auto& other : others) {
      if (is_nameless(other) || is_self(other)) continue;
      if (fits(topic, other, "publishes")) meets(topic, other, other.qos_profile(), topic.quality, "offers");
    }
  }

  void look_at_listeners(const Topic& topic) {
    for (const auto& other : graph_->get_publishers_info_by_topic(topic.name)) {
      if (!is_own(topic, other) && !is_nameless(other)) tell(topic.name, name(other) + " publishes it, too");
    }
    look_at_subscriptions(topic, topic.quality);
  }

  void look_at_subscriptions(const Topic& topic, const rclcpp::QoS& offered) {
    for (const auto& other : graph_->get_subscriptions_info_by_topic(topic.name)) {
      if (is_nameless(other)) continue;
      if (fits(topic, other, "expects")) meets(topic, other, offered, other.qos_profile(), "asks for");
    }
  }

  void look_around(const Topic& topic) {
    for (const auto& other : graph_->get_publishers_info_by_topic(topic.name)) {
      if (is_self(other)) {
        look_at_subscriptions(topic, other.qos_profile());
      } else if (!is_nameless(other)) {
        tell(topic.name, name(other) + " publishes it, too, around this layer");
      }
    }
  }

  void look_at_callers(const Called& called) {
    // To find the clients takes longer.
    if (count_clients(*graph_, called, 0) <= 1) return;
    for (const auto& [node, space] : graph_->get_node_names_and_namespaces()) {
      try {
        const std::string client = full_name(space, node);
        const auto services = graph_->get_client_names_and_types_by_node(node, space);
        if (client != self_ && services.count(called.service) > 0) {
          tell(called.name, client + " " + called.verb + ", too, around this layer");
        }
      } catch (const std::exception&) {
        // The node has just left.
      }
    }
  }

  void look_at_servers(Called& called) {
    // These types include those of clients. To find the servers takes longer.
    const auto& types = types_[called.service];
    const auto is_other = [&](const std::string& type) { return type != called.type; };
    const bool may_be_single = std::none_of(types.begin(), types.end(), is_other) && count(*graph_, called, 0) <= 1;
    std::vector<std::string> servers, others;
    if (!may_be_single) find_servers(called, servers, others);
    if (servers.empty()) {
      for (const std::string& other : others) {
        other_types_.insert(called.name);
        tell(called.name, other);
      }
    }
    look_for_single(called, servers);
  }

  /// Reports several servers of the right type: the first answer counts, regardless of the others.
  void look_for_single(Called& called, const std::vector<std::string>& servers) {
    const std::set<std::string> names(servers.begin(), servers.end());
    called.twice = names.size() < servers.size() ? called.twice + 1 : 0;
    std::string text;
    if (names.size() > 1) {
      for (const std::string& server : names) text += (text.empty() ? "" : " and ") + server;
    } else if (called.twice > kLease) {
      text = "several nodes " + *names.begin();
    }
    if (!text.empty()) tell(called.name, text + " serve it: only one answer counts");
  }

  void find_servers(const Called& called, std::vector<std::string>& servers, std::vector<std::string>& others) const {
    for (const auto& [node, space] : graph_->get_node_names_and_namespaces()) {
      try {
        const auto served = graph_->get_service_names_and_types_by_node(node, space)[called.service];
        for (const std::string& type : served) {
          const std::string server = full_name(space, node);
          if (type == called.type) {
            servers.push_back(server);
          } else {
            others.push_back(server + " serves " + plain(type) + ", not " + plain(called.type));
          }
        }
      } catch (const std::exception&) {
        // The node has just left.
      }
    }
  }

  /// The number of servers. Several if rclcpp can't count them (before Iron).
  template <typename Graph>
  static auto count(const Graph& graph, const Called& called, int) -> decltype(graph.count_services(called.service)) {
    return graph.count_services(called.service);
  }
  template <typename Graph>
  static std::size_t count(const Graph&, const Called&, long) {
    return 2;
  }

  /// The number of clients. Several if rclcpp can't count them (before Iron).
  template <typename Graph>
  static auto count_clients(const Graph& graph, const Called& called, int)
      -> decltype(graph.count_clients(called.service)) {
    return graph.count_clients(called.service);
  }
  template <typename Graph>
  static std::size_t count_clients(const Graph&, const Called&, long) {
    return 2;
  }

  /// Whether both sides use the same type. Reports a difference.
  bool fits(const Topic& topic, const rclcpp::TopicEndpointInfo& other, const std::string& verb) {
    if (other.topic_type() == topic.type) return true;
    tell(topic.name, name(other) + " " + verb + " " + other.topic_type() + ", not " + topic.type);
    return false;
  }

  /// Reports an offered quality of service that is too low for the other side.
  void meets(const Topic& topic, const rclcpp::TopicEndpointInfo& other, const rclcpp::QoS& offered,
             const rclcpp::QoS& asked, const std::string& verb) {
    const auto result = rclcpp::qos_check_compatible(offered, asked);
    if (result.compatibility == rclcpp::QoSCompatibility::Error) {
      tell(topic.name, name(other) + " " + verb + " a quality of service that does not fit: " + result.reason);
    }
  }

  static bool is_own(const Topic& topic, const rclcpp::TopicEndpointInfo& other) {
    const auto& gid = other.endpoint_gid();
    return std::equal(gid.begin(), gid.end(), topic.own.data);
  }

  bool is_self(const rclcpp::TopicEndpointInfo& other) const { return name(other) == self_; }

  /// Whether the endpoint's node is unknown, or not known yet.
  static bool is_nameless(const rclcpp::TopicEndpointInfo& other) {
    return other.node_name().find("UNKNOWN") != std::string::npos;
  }

  static std::string name(const rclcpp::TopicEndpointInfo& other) {
    return full_name(other.node_namespace(), other.node_name());
  }

  static std::string full_name(const std::string& space, const std::string& node) {
    return (space == "/" ? space : space + "/") + node;
  }

  /// The type of an action, from the type of its service.
  static std::string plain(const std::string& type) { return type.substr(0, type.find("_SendGoal")); }

  void note(const std::string& name, const std::string& fault) {
    auto& faults = faults_[name];
    if (std::find(faults.begin(), faults.end(), fault) == faults.end()) faults.push_back(fault);
  }

  void tell(const std::string& name, const std::string& what) {
    const std::string text = name + ": " + what;
    note(name, text);
    if (told_.insert(text).second) RCLCPP_WARN(logger_, "%s", text.c_str());
  }

  rclcpp::Logger logger_;
  std::string self_;
  rclcpp::node_interfaces::NodeGraphInterface::SharedPtr graph_;
  rclcpp::node_interfaces::NodeServicesInterface::SharedPtr services_;
  std::vector<Topic> heard_;
  std::vector<Topic> commanded_;
  std::vector<Topic> guarded_;
  std::vector<Called> called_;
  std::map<std::string, std::vector<std::string>> types_;  ///< Types of services at the last check.
  std::map<std::string, std::vector<std::string>> faults_;
  std::set<std::string> other_types_;
  std::set<std::string> told_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  CallbackGuard::Beat beat_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_GRAPH_MONITOR_HPP_
