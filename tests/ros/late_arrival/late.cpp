// Loads a component and does nothing for a while, in which a scan arrives and a time is up.
//
// late LIBRARY CLASS sensor|empty LOG: sends scans of either type until the event log has one, lets all be handled,
// sends one more, and spins again only when the time is up. Prints when.
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include <class_loader/class_loader.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/node_factory.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>
#include <std_msgs/msg/empty.hpp>

using namespace std::chrono_literals;

namespace {

std::size_t scans(const std::string& log) {
  std::ifstream file(log);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::size_t found = 0;
  for (auto at = text.find("message_scan.u_response"); at != std::string::npos; ++found) {
    at = text.find("message_scan.u_response", at + 1);
  }
  return found;
}

template <typename Scan>
void come_late(rclcpp::Executor& executor, rclcpp::Node& robot, const std::string& log) {
  const auto publisher = robot.create_publisher<Scan>("/scan", 10);
  while (scans(log) == 0) {
    publisher->publish(Scan());
    executor.spin_some(100ms);
    std::this_thread::sleep_for(10ms);
  }
  for (std::size_t known = 0; known != scans(log);) {
    known = scans(log);
    executor.spin_some(100ms);
    std::this_thread::sleep_for(1s);  // the log is written by then
  }
  publisher->publish(Scan());
  std::this_thread::sleep_for(2s);
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  std::printf("on at %f\n", now.count());
  executor.spin_some(100ms);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::string library = argv[1], name = argv[2], log = argv[4];
  rclcpp::init(0, nullptr);
  {
    class_loader::ClassLoader loader(library);
    {
      const auto factory = loader.createInstance<rclcpp_components::NodeFactory>(
          "rclcpp_components::NodeFactoryTemplate<" + name + ">");
      auto component =
          factory->create_node_instance(rclcpp::NodeOptions().append_parameter_override("event_log", log));
      const auto robot = std::make_shared<rclcpp::Node>("robot");
      rclcpp::executors::SingleThreadedExecutor executor;
      executor.add_node(component.get_node_base_interface());
      if (argv[3] == std::string("sensor")) {
        come_late<sensor_msgs::msg::LaserScan>(executor, *robot, log);
      } else {
        come_late<std_msgs::msg::Empty>(executor, *robot, log);
      }
    }
  }
  rclcpp::shutdown();
}
