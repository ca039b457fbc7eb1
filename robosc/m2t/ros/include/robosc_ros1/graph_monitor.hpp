// Monitor of the ROS graph around the node.
#ifndef ROBOSC_ROS1_GRAPH_MONITOR_HPP_
#define ROBOSC_ROS1_GRAPH_MONITOR_HPP_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/network.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Queries the master every second in a separate thread. Reports once by name: a publisher of another type, a topic
/// without a publisher, and a foreign publisher on a topic that the node commands. `faults` returns these faults as
/// long as they last.
class GraphMonitor {
 public:
  explicit GraphMonitor(const ros::NodeHandle& node) : node_(node) {}

  ~GraphMonitor() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

  GraphMonitor(const GraphMonitor&) = delete;
  GraphMonitor& operator=(const GraphMonitor&) = delete;

  template <typename Message>
  void listens_to(const std::string& topic) {
    listened_[node_.resolveName(topic)] = ros::message_traits::datatype<Message>();
  }

  template <typename Message>
  void commands(const std::string& topic) {
    commanded_[node_.resolveName(topic)] = ros::message_traits::datatype<Message>();
  }

  /// The faults of a topic at the last query.
  std::vector<std::string> faults(const std::string& topic) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = faults_.find(node_.resolveName(topic));
    return found == faults_.end() ? std::vector<std::string>() : found->second;
  }

  /// Starts the queries. No topic may follow.
  void start() {
    thread_ = std::thread([this] { work(); });
  }

 private:
  using Types = std::map<std::string, std::string>;
  using Faults = std::map<std::string, std::vector<std::string>>;

  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::seconds(1), [this] { return ending_; })) {
      lock.unlock();
      try {
        look();
      } catch (const XmlRpc::XmlRpcException& error) {
        ROS_DEBUG("an answer of another shape than expected: %s", error.getMessage().c_str());
      }
      lock.lock();
    }
  }

  void look() {
    XmlRpc::XmlRpcValue name(ros::this_node::getName()), answer, state;
    if (!ros::master::execute("getSystemState", name, answer, state, false)) return;
    std::map<std::string, std::vector<std::string>> publishers;
    for (int entry = 0; entry < state[0].size(); ++entry) {
      XmlRpc::XmlRpcValue& nodes = state[0][entry][1];
      for (int node = 0; node < nodes.size(); ++node) {
        const std::string& other = nodes[node];
        if (other != ros::this_node::getName()) publishers[state[0][entry][0]].push_back(other);
      }
    }
    Faults faults;
    std::map<std::pair<std::string, std::string>, std::string> types;
    for (const auto& [topic, type] : listened_) {
      missing_[topic] = publishers[topic].empty() ? missing_[topic] + 1 : 0;
      if (missing_[topic] >= 5) {
        // While a robot starts, publishers are often late. So the log contains no warning.
        faults[topic].push_back(topic + ": nobody publishes it");
        if (is_new(topic, "nobody publishes it after 5 s")) {
          ROS_INFO("%s: nobody publishes it after 5 s", topic.c_str());
        }
      }
      for (const std::string& other : publishers[topic]) {
        const auto known = types_.find({topic, other});
        const std::string found = known == types_.end() ? type_at(other, topic) : known->second;
        types[{topic, other}] = found;
        if (!found.empty() && found != type) {
          report(faults, topic, std::string(other).append(" publishes ").append(found).append(", not ").append(type));
        }
      }
    }
    types_ = std::move(types);
    for (const auto& [topic, type] : commanded_) {
      for (const std::string& other : publishers[topic]) report(faults, topic, other + " publishes it, too");
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    faults_ = std::move(faults);
  }

  // The type that a node itself reports for its publications on a topic: the master keeps only one type per topic.
  // Empty if the node does not answer.
  static std::string type_at(const std::string& node, const std::string& topic) {
    XmlRpc::XmlRpcValue name(ros::this_node::getName()), request, answer, place;
    request[0] = name;
    request[1] = node;
    std::string host;
    std::uint32_t port = 0;
    if (!ros::master::execute("lookupNode", request, answer, place, false)) return "";
    if (!ros::network::splitURI(place, host, port)) return "";
    XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
    if (!client.executeNonBlock("getPublications", name)) return "";
    XmlRpc::XmlRpcDispatch dispatch;
    dispatch.addSource(&client, XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
    dispatch.work(1.0);
    if (!client.executeCheckDone(answer) || answer.size() < 3) return "";
    XmlRpc::XmlRpcValue& types = answer[2];
    for (int entry = 0; entry < types.size(); ++entry) {
      if (static_cast<std::string&>(types[entry][0]) == topic) return types[entry][1];
    }
    return "";
  }

  void report(Faults& faults, const std::string& topic, const std::string& what) {
    faults[topic].push_back(topic + ": " + what);
    if (is_new(topic, what)) ROS_WARN("%s: %s", topic.c_str(), what.c_str());
  }

  bool is_new(const std::string& topic, const std::string& what) { return reported_.emplace(topic, what).second; }

  ros::NodeHandle node_;
  Types listened_;
  Types commanded_;
  std::map<std::string, int> missing_;                                // Number of queries without a publisher.
  std::map<std::pair<std::string, std::string>, std::string> types_;  // By topic and publisher.
  std::set<std::pair<std::string, std::string>> reported_;
  Faults faults_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_GRAPH_MONITOR_HPP_
