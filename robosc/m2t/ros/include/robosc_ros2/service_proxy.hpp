// Hands calls of a service on that the supervisor lets through.
#ifndef ROBOSC_ROS2_SERVICE_PROXY_HPP_
#define ROBOSC_ROS2_SERVICE_PROXY_HPP_

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/service_client.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A service for the controller behind which stands the robot's one. Who calls it waits for the robot's answer; whose
/// call is blocked, or has no answer, gets a response with nothing set.
template <typename Type>
class ServiceProxy {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;

  /// What the supervisor has to say and to hear. Nothing is called from inside of anything else here.
  struct Handlers {
    std::function<bool(const Request&)> call;       ///< Whether a call goes on.
    std::function<void()> busy;                     ///< A call is turned away because another one waits.
    std::function<void(const Response&)> response;  ///< The robot has answered.
    std::function<void(const std::string&)> error;  ///< It has not, and why.
  };

  /// `quality`: of calls of the robot's service.
  ServiceProxy(rclcpp::Node& node, const CallbackGuard& guard, const std::string& controller_side,
               const std::string& robot_side, const rclcpp::QoS& quality, std::chrono::milliseconds timeout,
               Handlers handlers)
      : handlers_(std::move(handlers)),
        robot_(node, guard, robot_side, quality, timeout,
               {
                   [this](const Response& response) {
                     handlers_.response(response);
                     finish(response);
                   },
                   [this](const std::string& why) {
                     handlers_.error(why);
                     finish(Response());
                   },
               }) {
    service_ = node.create_service<Type>(
        controller_side, guard([this](std::shared_ptr<rmw_request_id_t> caller, std::shared_ptr<Request> request) {
          called(*caller, *request);
        }));
  }

 private:
  void called(const rmw_request_id_t& caller, const Request& request) {
    if (waiting_) {
      handlers_.busy();
      answer(caller, Response());
    } else if (!handlers_.call(request)) {
      answer(caller, Response());
    } else {
      waiting_ = caller;
      robot_.call(request);
    }
  }

  void finish(const Response& response) {
    const rmw_request_id_t caller = *waiting_;
    waiting_.reset();
    answer(caller, response);
  }

  void answer(rmw_request_id_t caller, Response response) { service_->send_response(caller, response); }

  const Handlers handlers_;
  std::optional<rmw_request_id_t> waiting_;
  std::shared_ptr<rclcpp::Service<Type>> service_;
  ServiceClient<Type> robot_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SERVICE_PROXY_HPP_
