// Service that the controller serves.
#ifndef ROBOSC_ROS1_SERVICE_SERVER_HPP_
#define ROBOSC_ROS1_SERVICE_SERVER_HPP_

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "robosc/call_server.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/event_queue.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A request of ROS 1 whose thread waits for the response.
template <typename Response>
struct WaitingCall {
  bool ended = false;
  std::optional<Response> response;  ///< Empty if the request was refused.
};

/// The server of one service. ROS 1 expects each response from the thread that delivers the request. So threads wait
/// here, one for each request. The node's callback queue delivers the requests to the controller.
template <typename Type>
class ServiceServer final : public CallServer<std::shared_ptr<WaitingCall<typename Type::Response>>,
                                              typename Type::Request, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Caller = std::shared_ptr<WaitingCall<Response>>;
  using Base = CallServer<Caller, Request, Response>;

  ServiceServer(ros::NodeHandle& node, const std::string& name, typename Base::Handlers handlers)
      : Base("refused", std::move(handlers)), events_(node) {
    boost::function<bool(Request&, Response&)> receive = [this](Request& request, Response& response) {
      return wait_for(request, response);
    };
    ros::AdvertiseServiceOptions options;
    options.init(name, receive);
    options.callback_queue = &calls_;
    service_ = node.advertiseService(options);
    // The open request, the waiting ones, and the one that replaces the oldest of these.
    for (std::size_t number = 0; number < kWaitingRequests + 2; ++number) {
      threads_.emplace_back([this] {
        while (calls_.isEnabled()) calls_.callOne(ros::WallDuration(3600));
      });
    }
  }

  ServiceServer(const ServiceServer&) = delete;
  ServiceServer& operator=(const ServiceServer&) = delete;

  ~ServiceServer() override {  // NOLINT(bugprone-exception-escape): locks, should they fail
    this->leave();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    calls_.disable();
    for (std::thread& thread : threads_) thread.join();
    service_.shutdown();
  }

 private:
  // Runs in a thread of this service.
  bool wait_for(const Request& request, Response& response) {
    const auto call = std::make_shared<WaitingCall<Response>>();
    std::unique_lock<std::mutex> lock(mutex_);
    if (ending_) return false;
    events_.push([this, call, request] { this->called(call, request); });
    changed_.wait(lock, [&] { return ending_ || call->ended; });
    if (!call->response) return false;
    response = *call->response;
    return true;
  }

  void answer(const Caller& caller, const Response& response) override { end(*caller, response); }
  void refuse(const Caller& caller) override { end(*caller, std::nullopt); }
  void defer() override {
    events_.push([this] { this->look(); });
  }

  void end(WaitingCall<Response>& call, const std::optional<Response>& response) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      call.response = response;
      call.ended = true;
    }
    changed_.notify_all();
  }

  std::mutex mutex_;  // for the waiting calls and `ending_`
  std::condition_variable changed_;
  bool ending_ = false;
  EventQueue events_;
  ros::CallbackQueue calls_;
  ros::ServiceServer service_;
  std::vector<std::thread> threads_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_SERVICE_SERVER_HPP_
