// Client of a service.
#ifndef ROBOSC_ROS2_SERVICE_CLIENT_HPP_
#define ROBOSC_ROS2_SERVICE_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/call_client.hpp"
#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Creates a client. In Humble, its quality of service is a structure of the middleware.
template <typename Type, typename Node>
auto create_client(Node& node, const std::string& name, const rclcpp::QoS& quality) {
  if constexpr (requires { node.template create_client<Type>(name, quality); }) {
    return node.template create_client<Type>(name, quality);
  } else {
    return node.template create_client<Type>(name, quality.get_rmw_qos_profile());
  }
}

/// A client of one service. The node's executor calls the handlers.
template <typename Type>
class ServiceClient final : public CallClient<Countdown, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Base = CallClient<Countdown, Response>;

  template <typename Node>
  ServiceClient(Node& node, const CallbackGuard& guard, const std::string& name, const rclcpp::QoS& quality,
                std::chrono::milliseconds timeout, typename Base::Handlers handlers)
      : Base(timeout, std::move(handlers), node, guard),
        guard_(guard),
        client_(create_client<Type>(node, name, quality)),
        search_(node, guard, std::chrono::milliseconds(20), [this] { send(); }) {}

  /// Calls the service. Gives up an earlier call that has not ended.
  void call(const Request& request) {
    number_ = this->begin();
    request_ = std::make_shared<Request>(request);
    missing_ = {Failure::unavailable, "no server"};
    send();
  }

 private:
  void send() {
    if (!client_->service_is_ready()) {
      search_.start();
      return;
    }
    try {
      const auto answered = guard_([this, number = number_](typename rclcpp::Client<Type>::SharedFuture answer) {
        this->succeed(number, *answer.get());
      });
      pending_ = client_->async_send_request(request_, answered).request_id;
      missing_ = {Failure::timeout, "no answer"};
    } catch (const std::exception&) {
      missing_ = {Failure::failed, "the call cannot be sent"};
      search_.start();
    }
  }

  void forget() override {
    search_.stop();
    client_->remove_pending_request(pending_);
  }

  typename Base::Missing missing() override { return missing_; }

  const CallbackGuard& guard_;
  typename rclcpp::Client<Type>::SharedPtr client_;
  std::shared_ptr<Request> request_;
  typename Base::Missing missing_ = {Failure::unavailable, "no server"};
  std::uint64_t number_ = 0;
  std::int64_t pending_ = 0;
  Countdown search_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SERVICE_CLIENT_HPP_
