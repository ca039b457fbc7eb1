// Hands calls of a service on that the supervisor lets through.
#ifndef ROBOSC_ROS1_SERVICE_PROXY_HPP_
#define ROBOSC_ROS1_SERVICE_PROXY_HPP_

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ros/ros.h>

#include "robosc/version.hpp"
#include "robosc_ros1/event_queue.hpp"
#include "robosc_ros1/service_client.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A service for the controller behind which stands the robot's one. Who calls it waits for the robot's answer; to whom
/// is blocked, or gets no answer, the call fails.
///
/// ROS answers synchronously: each caller waits in a thread of `callers`. What is decided, is decided in the node's
/// queue.
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

  ServiceProxy(ros::NodeHandle& node, ros::NodeHandle& callers, const std::string& controller_side,
               const std::string& robot_side, std::chrono::milliseconds timeout, Handlers handlers)
      : handlers_(std::move(handlers)),
        events_(node),
        robot_(node, robot_side, timeout,
               {
                   [this](const Response& response) {
                     handlers_.response(response);
                     finish(response);
                   },
                   [this](const std::string& why) {
                     handlers_.error(why);
                     finish(std::nullopt);
                   },
               }) {
    server_ = callers.advertiseService<Request, Response>(
        controller_side, boost::function<bool(Request&, Response&)>(
                             [this](Request& request, Response& response) { return serve(request, response); }));
  }

  ~ServiceProxy() { server_.shutdown(); }
  ServiceProxy(const ServiceProxy&) = delete;
  ServiceProxy& operator=(const ServiceProxy&) = delete;

 private:
  using Answer = std::optional<Response>;

  struct Call {
    explicit Call(const Request& asked) : request(asked) {}

    Request request;
    std::promise<Answer> answer;
  };

  bool serve(const Request& request, Response& response) {
    const auto call = std::make_shared<Call>(request);
    std::future<Answer> answer = call->answer.get_future();
    events_.push([this, call] { called(call); });
    while (answer.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
      if (!ros::ok()) return false;
    }
    const Answer given = answer.get();
    if (given) response = *given;
    return given.has_value();
  }

  void called(const std::shared_ptr<Call>& call) {
    if (waiting_) {
      handlers_.busy();
      call->answer.set_value(std::nullopt);
    } else if (!handlers_.call(call->request)) {
      call->answer.set_value(std::nullopt);
    } else {
      waiting_ = call;
      robot_.call(call->request);
    }
  }

  void finish(const Answer& answer) {
    waiting_->answer.set_value(answer);
    waiting_.reset();
  }

  const Handlers handlers_;
  ros::ServiceServer server_;
  std::shared_ptr<Call> waiting_;
  EventQueue events_;
  ServiceClient<Type> robot_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_SERVICE_PROXY_HPP_
