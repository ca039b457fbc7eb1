// Services of a node that callers may use while it is destroyed.
#ifndef ROBOSC_ROS2_NODE_SERVICES_HPP_
#define ROBOSC_ROS2_NODE_SERVICES_HPP_

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameter_types.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters_atomically.hpp>
#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Services below the name of a node. rclcpp's own services for parameters and for the lifecycle call the node without
/// a guard: an executor with several threads may run one while another thread destroys the node.
class NodeServices {
 public:
  /// Adds a service. `function`: fills the response to a request.
  template <typename Service, typename Node>
  void serve(Node& node, const CallbackGuard& guard, const std::string& name,
             std::function<void(const typename Service::Request&, typename Service::Response&)> function) {
    services_.push_back(node.template create_service<Service>(
        "~/" + name, guard([function = std::move(function)](std::shared_ptr<typename Service::Request> request,
                                                            std::shared_ptr<typename Service::Response> response) {
          function(*request, *response);
        })));
  }

  void close() { services_.clear(); }

 private:
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
};

/// Adds the services for parameters, with the answers of those of rclcpp.
template <typename Node>
void serve_parameters(NodeServices& services, Node& node, const CallbackGuard& guard) {
  namespace srv = rcl_interfaces::srv;
  using rclcpp::exceptions::ParameterNotDeclaredException;
  auto& parameters = *node.get_node_parameters_interface();
  const auto converted = [](const std::vector<rcl_interfaces::msg::Parameter>& messages) {
    std::vector<rclcpp::Parameter> converted;
    for (const auto& message : messages) converted.push_back(rclcpp::Parameter::from_parameter_msg(message));
    return converted;
  };
  const auto set = [&parameters](const std::vector<rclcpp::Parameter>& values, const std::string& more) {
    rcl_interfaces::msg::SetParametersResult result;
    try {
      result = parameters.set_parameters_atomically(values);
    } catch (const ParameterNotDeclaredException& error) {
      result.reason = more + error.what();
    }
    return result;
  };
  services.serve<srv::GetParameters>(node, guard, "get_parameters", [&parameters](const auto& request, auto& response) {
    try {
      for (const rclcpp::Parameter& parameter : parameters.get_parameters(request.names)) {
        response.values.push_back(parameter.get_value_message());
      }
    } catch (const rclcpp::exceptions::ParameterNotDeclaredException&) {
      response.values.clear();
    } catch (const rclcpp::exceptions::ParameterUninitializedException&) {
      response.values.clear();
    }
  });
  services.serve<srv::GetParameterTypes>(node, guard, "get_parameter_types",
                                         [&parameters](const auto& request, auto& response) {
                                           try {
                                             response.types = parameters.get_parameter_types(request.names);
                                           } catch (const ParameterNotDeclaredException&) {
                                             response.types.clear();
                                           }
                                         });
  services.serve<srv::SetParameters>(node, guard, "set_parameters",
                                     [set, converted](const auto& request, auto& response) {
                                       for (const rclcpp::Parameter& parameter : converted(request.parameters)) {
                                         response.results.push_back(set({parameter}, ""));
                                       }
                                     });
  services.serve<srv::SetParametersAtomically>(
      node, guard, "set_parameters_atomically", [set, converted](const auto& request, auto& response) {
        response.result = set(converted(request.parameters), "no parameter was set: ");
      });
  services.serve<srv::DescribeParameters>(node, guard, "describe_parameters",
                                          [&parameters](const auto& request, auto& response) {
                                            try {
                                              response.descriptors = parameters.describe_parameters(request.names);
                                            } catch (const ParameterNotDeclaredException&) {
                                              response.descriptors.clear();
                                            }
                                          });
  services.serve<srv::ListParameters>(node, guard, "list_parameters",
                                      [&parameters](const auto& request, auto& response) {
                                        response.result = parameters.list_parameters(request.prefixes, request.depth);
                                      });
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_NODE_SERVICES_HPP_
