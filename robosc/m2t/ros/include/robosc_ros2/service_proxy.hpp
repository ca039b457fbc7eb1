// Forwarded service calls that the supervisor permits.
#ifndef ROBOSC_ROS2_SERVICE_PROXY_HPP_
#define ROBOSC_ROS2_SERVICE_PROXY_HPP_

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/call_proxy.hpp"
#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/service_client.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A service for the controller that forwards to the robot's service. A client waits for the robot's answer. A blocked
/// or failed call gets a response with default values.
template <typename Type>
class ServiceProxy final : public CallProxy<rmw_request_id_t, typename Type::Request, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Base = CallProxy<rmw_request_id_t, Request, Response>;

  /// `quality`: quality of service for calls of the robot's service.
  ServiceProxy(rclcpp::Node& node, const CallbackGuard& guard, const std::string& controller_side,
               const std::string& robot_side, const rclcpp::QoS& quality, std::chrono::milliseconds timeout,
               typename Base::Handlers handlers)
      : Base(std::move(handlers)),
        robot_(node, guard, robot_side, quality, timeout,
               this->template answers<typename ServiceClient<Type>::Base::Handlers>()) {
    service_ = node.create_service<Type>(
        controller_side, guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<Request> request) {
          this->called(*caller, *request);
        }));
  }

 private:
  void forward(const Request& request) override { robot_.call(request); }

  void answer(const rmw_request_id_t& caller, const std::optional<Response>& response) override {
    rmw_request_id_t id = caller;
    Response message = response.value_or(Response());
    service_->send_response(id, message);
  }

  std::shared_ptr<rclcpp::Service<Type>> service_;
  ServiceClient<Type> robot_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SERVICE_PROXY_HPP_
