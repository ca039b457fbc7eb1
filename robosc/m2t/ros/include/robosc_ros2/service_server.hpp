// Service that the controller serves.
#ifndef ROBOSC_ROS2_SERVICE_SERVER_HPP_
#define ROBOSC_ROS2_SERVICE_SERVER_HPP_

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/call_server.hpp"
#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/deferral.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The server of one service. ROS 2 has no refusals: a refused request has no response.
template <typename Type>
class ServiceServer final : public CallServer<rmw_request_id_t, typename Type::Request, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Base = CallServer<rmw_request_id_t, Request, Response>;

  template <typename Node>
  ServiceServer(Node& node, const CallbackGuard& guard, const std::string& name, typename Base::Handlers handlers)
      : Base("dropped", std::move(handlers)), next_(node, guard, [this] { this->look(); }) {
    service_ = node.template create_service<Type>(
        name, guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<Request> request) {
          this->called(*caller, *request);
        }));
  }

  ~ServiceServer() override { this->leave(); }  // NOLINT(bugprone-exception-escape): out of memory

 private:
  void answer(const rmw_request_id_t& caller, const Response& response) override {
    rmw_request_id_t id = caller;
    Response message = response;
    try {
      service_->send_response(id, message);
    } catch (const std::exception& error) {
      this->warn(std::string("the response cannot be sent: ") + error.what());
    }
  }

  void refuse(const rmw_request_id_t&) override {}
  void defer() override { next_.request(); }

  Deferral next_;
  typename rclcpp::Service<Type>::SharedPtr service_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SERVICE_SERVER_HPP_
