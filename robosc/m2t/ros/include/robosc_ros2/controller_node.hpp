// Base class of controllers.
#ifndef ROBOSC_ROS2_CONTROLLER_NODE_HPP_
#define ROBOSC_ROS2_CONTROLLER_NODE_HPP_

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/rclcpp.hpp>
#include <rosidl_runtime_cpp/traits.hpp>

#include "robosc/version.hpp"
#include "robosc_ros2/durabilities.hpp"
#include "robosc_ros2/graph_monitor.hpp"
#include "robosc_ros2/guarded_node.hpp"
#include "robosc_ros2/shutdown_hook.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A subscription that is replaced when its quality of service changes.
template <typename Message>
using Subscription = std::shared_ptr<typename rclcpp::Subscription<Message>::SharedPtr>;

/// A node that stops its robot before ROS closes, or at its destruction.
template <typename Node>
class ControllerNode : public GuardedNode<Node> {
 protected:
  using GuardedNode<Node>::GuardedNode;

  /// Closes the node. Call it first in the destructor of a derived class.
  void close() {
    shutdown_hook_.reset();
    {
      const auto lock = this->guard_.hold();
      leave();
      finalize();
    }
    GuardedNode<Node>::close();
  }

  // Functions that depend on the model.

  /// Whether a goal has not ended.
  virtual bool busy() const { return false; }
  /// Whether the end of the node waits for the end of a goal.
  virtual bool waits() const { return false; }
  /// Reports goals that have not ended when the node ends.
  virtual void leave() {}
  /// Stops the robot while all triggers are held.
  virtual void halt() = 0;
  /// Other steps before the end of the node.
  virtual void finish() {}
  /// Ends the lifecycle of the node, if it has one.
  virtual void finalize() {}
  /// Handles the end of a period.
  virtual void tick() = 0;

  // Functions of the node.

  /// A publisher of commands. The node should be the only publisher on its topic.
  template <typename Message>
  auto advertise(const std::string& topic, const rclcpp::QoS& quality) {
    rclcpp::PublisherOptions options;
    options.qos_overriding_options = rclcpp::QosOverridingOptions::with_default_policies();
    options.use_default_callbacks = false;  // The graph monitor reports incompatible subscribers.
    auto publisher = this->template create_publisher<Message>(topic, quality, options);
    monitor().command(topic, rosidl_generator_traits::name<Message>(), publisher->get_actual_qos(),
                      publisher->get_gid());
    return publisher;
  }

  /// A subscription to a topic of the robot.
  template <typename Message>
  Subscription<Message> subscribe(const std::string& topic, const rclcpp::QoS& quality,
                                  std::function<void(const Message&)> heard) {
    auto subscription = std::make_shared<typename Subscription<Message>::element_type>();
    open<Message>(*subscription, topic, quality, heard, rclcpp::QosOverridingOptions::with_default_policies());
    return subscription;
  }

  /// The same, with the quality of service `kept` while the publishers keep their last messages.
  template <typename Message>
  Subscription<Message> subscribe(const std::string& topic, const rclcpp::QoS& quality, const rclcpp::QoS& kept,
                                  std::function<void(const Message&)> heard) {
    const auto subscription = subscribe<Message>(topic, quality, heard);
    if (!durabilities_) durabilities_.emplace(*this, this->guard_);
    const auto changed = [this, subscription, topic, quality, kept, heard](bool lasting) {
      // By default, the parameters have the reliability of the first subscription.
      open<Message>(*subscription, topic, lasting ? kept : quality, heard,
                    {rclcpp::QosPolicyKind::History, rclcpp::QosPolicyKind::Depth});
    };
    durabilities_->watch(topic, changed, false);
    return subscription;
  }

  /// Watches the servers of a service that the node calls. `part`: the service's role in an action.
  template <typename Service>
  void watch_servers(const std::string& name, const std::string& part = "") {
    monitor().call(name, part, rosidl_generator_traits::name<Service>());
  }

  /// Faults of the ROS graph that concern a topic, service or action.
  std::vector<std::string> faults(const std::string& name) const {
    return monitor_ ? monitor_->faults(name) : std::vector<std::string>();
  }

  /// The reason of a failed call or goal. ROS does not match a server of another type.
  std::string explained(const std::string& name, const std::string& why) const {
    return monitor_ && monitor_->has_other_type(name) ? "the server has another type" : why;
  }

  /// Starts the ticks. The period is the same each time.
  void start(std::chrono::milliseconds period) {
    ticking_ = true;
    if (timer_) return;
    const auto tick = this->services_guard_([this] {
      if (ticking_) this->tick();
    });
    if (this->get_parameter("use_sim_time").as_bool()) {
      timer_ = rclcpp::create_timer(this, this->get_clock(), period, tick);
    } else {
      timer_ = this->create_wall_timer(period, tick);
    }
  }

  /// Makes the node stop the robot at its end. Call it last in the constructor of a derived class.
  void stop_at_end() {
    const auto end = [this] {
      const auto lock = this->guard_.hold();
      if (active_) {
        stop();
      } else if (monitor_) {
        monitor_->stop();
      }
    };
    shutdown_hook_.emplace(*this, this->guard_, end, [this] {
      const auto lock = this->guard_.hold();
      if (waits()) return true;
      leave();
      finalize();
      return false;
    });
  }

  /// Stops the robot before the node ends, while it can still send.
  void stop() {
    if (std::exchange(stopping_, true)) return;
    halt();
    if (monitor_) monitor_->stop();
    finish();
  }

  bool stopping_ = false;
  bool active_ = false;
  std::optional<GraphMonitor> monitor_;
  std::optional<Durabilities> durabilities_;
  bool ticking_ = false;
  rclcpp::TimerBase::SharedPtr timer_;

 private:
  template <typename Message>
  void open(typename rclcpp::Subscription<Message>::SharedPtr& subscription, const std::string& topic,
            const rclcpp::QoS& quality, const std::function<void(const Message&)>& heard,
            const rclcpp::QosOverridingOptions& overrides) {
    rclcpp::SubscriptionOptions options;
    options.qos_overriding_options = overrides;
    options.use_default_callbacks = false;
    subscription = this->template create_subscription<Message>(topic, quality, this->guard_(heard), options);
    monitor().hear(topic, rosidl_generator_traits::name<Message>(), subscription->get_actual_qos());
  }

  GraphMonitor& monitor() { return monitor_ ? *monitor_ : monitor_.emplace(*this, this->guard_); }

  std::optional<ShutdownHook> shutdown_hook_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_CONTROLLER_NODE_HPP_
