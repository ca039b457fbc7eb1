// Calls a service.
#ifndef ROBOSC_ROS2_SERVICE_CLIENT_HPP_
#define ROBOSC_ROS2_SERVICE_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/countdown.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// One call at a time, with a time limit. Handlers are called by the node's executor, never from inside `call`.
template <typename Type>
class ServiceClient {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;

  struct Handlers {
    std::function<void(const Response&)> response;
    std::function<void(const std::string& why)> error;
  };

  /// `timeout`: from a call to its answer; the server, too, may appear in this time.
  template <typename Node>
  ServiceClient(Node& node, const CallbackGuard& guard, const std::string& name, const rclcpp::QoS& quality,
                std::chrono::milliseconds timeout, Handlers handlers)
      : guard_(guard),
        handlers_(std::move(handlers)),
        client_(node.template create_client<Type>(name, quality)),
        limit_(" within " + std::to_string(timeout.count()) + " ms"),
        deadline_(node, guard, timeout, [this] { give_up(); }),
        search_(node, guard, std::chrono::milliseconds(20), [this] { send(); }) {}

  /// One of the handlers is called then; an answer that comes after an error is dropped.
  void call(const Request& request) {
    request_ = std::make_shared<Request>(request);
    fault_ = "no server";
    deadline_.start();
    send();
  }

 private:
  void send() {
    if (!client_->service_is_ready()) {
      search_.start();
      return;
    }
    try {
      const auto answered = guard_([this, number = ++calls_](typename rclcpp::Client<Type>::SharedFuture answer) {
        if (number != calls_) return;
        deadline_.stop();
        handlers_.response(*answer.get());
      });
      pending_ = client_->async_send_request(request_, answered).request_id;
      fault_ = "no answer";
    } catch (const std::exception&) {
      fault_ = "the call can't be sent";
      search_.start();
    }
  }

  void give_up() {
    search_.stop();
    ++calls_;
    client_->remove_pending_request(pending_);
    handlers_.error(fault_ + limit_);
  }

  const CallbackGuard& guard_;
  Handlers handlers_;
  typename rclcpp::Client<Type>::SharedPtr client_;
  std::string limit_;
  std::shared_ptr<Request> request_;
  std::string fault_;
  std::uint64_t calls_ = 0;
  std::int64_t pending_ = 0;
  Countdown deadline_;
  Countdown search_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_SERVICE_CLIENT_HPP_
