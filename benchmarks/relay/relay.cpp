// Forwards the messages of a guarded base unchanged, with the quality of service of its supervisory layer.
#include <memory>
#include <string>

#include <geometry_msgs/msg/twist.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>
#include <std_msgs/msg/bool.hpp>

template <typename Message>
auto relay(rclcpp::Node& node, const std::string& from, const std::string& to, const rclcpp::QoS& received) {
  auto publisher = node.create_publisher<Message>(to, rclcpp::QoS(10));
  return node.create_subscription<Message>(
      from, received, [publisher](std::shared_ptr<const Message> message) { publisher->publish(*message); });
}

int main(int count, char* arguments[]) {
  rclcpp::init(count, arguments);
  const auto node = std::make_shared<rclcpp::Node>("plain_relay");
  const auto velocity = relay<geometry_msgs::msg::Twist>(*node, "~/controller/cmd_vel", "~/cmd_vel", rclcpp::QoS(10));
  const auto scan = relay<sensor_msgs::msg::LaserScan>(*node, "/scan", "~/controller/scan", rclcpp::SensorDataQoS());
  const auto button =
      relay<std_msgs::msg::Bool>(*node, "/emergency_stop", "~/controller/emergency_stop", rclcpp::QoS(10));
  rclcpp::spin(node);
  rclcpp::shutdown();
}
