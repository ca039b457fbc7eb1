// Runs the component of a library in an events executor until it is interrupted.
#include <class_loader/class_loader.hpp>
#include <rclcpp/experimental/executors/events_executor/events_executor.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/node_factory.hpp>

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  {
    class_loader::ClassLoader loader(argv[1]);
    const auto names = loader.getAvailableClasses<rclcpp_components::NodeFactory>();
    const auto factory = loader.createInstance<rclcpp_components::NodeFactory>(names.at(0));
    auto component = factory->create_node_instance(rclcpp::NodeOptions());
    rclcpp::experimental::executors::EventsExecutor executor;
    executor.add_node(component.get_node_base_interface());
    executor.spin();
    executor.remove_node(component.get_node_base_interface());
  }
  rclcpp::shutdown();
}
