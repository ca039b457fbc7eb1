// Hands calls of a service on that the supervisor lets through.
#ifndef ROBOSC_ROS1_SERVICE_PROXY_HPP_
#define ROBOSC_ROS1_SERVICE_PROXY_HPP_

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "robosc/call_proxy.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/event_queue.hpp"
#include "robosc_ros1/service_client.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A service for the controller behind which stands the robot's one. Who calls it waits for the robot's answer; to whom
/// is blocked, or gets no answer, the call fails.
///
/// ROS answers synchronously: a caller waits in one thread, and another one rejects who calls meanwhile. What is
/// decided, is decided in the node's queue.
template <typename Type>
class ServiceProxy final : public CallProxy<std::shared_ptr<std::promise<std::optional<typename Type::Response>>>,
                                            typename Type::Request, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Answer = std::optional<Response>;
  using Caller = std::shared_ptr<std::promise<Answer>>;
  using Base = CallProxy<Caller, Request, Response>;

  ServiceProxy(ros::NodeHandle& node, const std::string& controller_side, const std::string& robot_side,
               std::chrono::milliseconds timeout, typename Base::Handlers handlers)
      : Base(std::move(handlers)),
        events_(node),
        robot_(node, robot_side, timeout, this->template answers<typename ServiceClient<Type>::Base::Handlers>()) {
    callers_.setCallbackQueue(&calls_);
    server_ = callers_.advertiseService<Request, Response>(
        controller_side, boost::function<bool(Request&, Response&)>(
                             [this](Request& request, Response& response) { return serve(request, response); }));
    threads_.start();
  }

  ServiceProxy(const ServiceProxy&) = delete;
  ServiceProxy& operator=(const ServiceProxy&) = delete;
  ~ServiceProxy() override { server_.shutdown(); }

 private:
  bool serve(const Request& request, Response& response) {
    const auto caller = std::make_shared<std::promise<Answer>>();
    std::future<Answer> future = caller->get_future();
    events_.push([this, caller, request] { this->called(caller, request); });
    while (future.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
      if (!ros::ok()) return false;
    }
    const Answer given = future.get();
    if (given) response = *given;
    return given.has_value();
  }

  void forward(const Request& request) override { robot_.call(request); }
  void answer(const Caller& caller, const Answer& response) override { caller->set_value(response); }

  EventQueue events_;
  ServiceClient<Type> robot_;
  ros::CallbackQueue calls_;
  ros::NodeHandle callers_;
  ros::ServiceServer server_;
  ros::AsyncSpinner threads_{2, &calls_};
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_SERVICE_PROXY_HPP_
