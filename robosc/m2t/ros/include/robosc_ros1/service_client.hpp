// Client of a service that does not block.
#ifndef ROBOSC_ROS1_SERVICE_CLIENT_HPP_
#define ROBOSC_ROS1_SERVICE_CLIENT_HPP_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <ros/connection.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>
#include <ros/service_manager.h>
#include <ros/service_server_link.h>
#include <ros/service_traits.h>

#include "robosc/call_client.hpp"
#include "robosc/version.hpp"
#include "robosc_ros1/countdown.hpp"
#include "robosc_ros1/event_queue.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A client of one service. ROS 1 calls block, so a separate thread makes them. The node's callback queue delivers the
/// response. Call all functions in the thread that serves this queue.
template <typename Type>
class ServiceClient final : public CallClient<Countdown, typename Type::Response> {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using Base = CallClient<Countdown, Response>;

  ServiceClient(ros::NodeHandle& node, const std::string& name, std::chrono::milliseconds timeout,
                typename Base::Handlers handlers)
      : Base(timeout, std::move(handlers), node),
        name_(node.resolveName(name)),
        events_(node),
        worker_([this] { work(); }) {}

  ~ServiceClient() override {
    this->stop();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_one();
    worker_.join();
  }

  ServiceClient(const ServiceClient&) = delete;
  ServiceClient& operator=(const ServiceClient&) = delete;

  /// Calls the service. Gives up an earlier call that has not ended.
  void call(const Request& request) {
    const std::uint64_t number = this->begin();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      request_ = request;
      current_ = number;
      found_ = false;
    }
    changed_.notify_one();
  }

 private:
  void forget() override {
    ros::ServiceServerLinkPtr link;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      request_.reset();
      current_ = 0;
      link.swap(link_);
    }
    changed_.notify_one();
    if (link) link->getConnection()->drop(ros::Connection::Destructing);  // ends the wait of the worker
  }

  typename Base::Missing missing() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (found_) return {Failure::timeout, "no answer"};
    return {Failure::unavailable, "no server"};
  }

  // Makes one call after the other, in the worker's thread.
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return ending_ || request_; });
      if (ending_) return;
      const ros::SerializedMessage request = ros::serialization::serializeMessage(*request_);
      const std::uint64_t number = current_;
      request_.reset();
      lock.unlock();
      ask(number, request);
      lock.lock();
    }
  }

  void ask(std::uint64_t number, const ros::SerializedMessage& request) {
    const ros::ServiceServerLinkPtr link = find(number);
    if (!link) return;
    ros::SerializedMessage answer;
    const bool answered = link->call(request, answer);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (link_ == link) link_.reset();
    }
    const auto response = std::make_shared<Response>();
    if (answered && read(answer, *response)) {
      events_.push([this, number, response] { this->succeed(number, *response); });
    } else {
      events_.push([this, number] { this->fail(number, Failure::failed, "the call failed"); });
    }
  }

  // A connection to the server, once there is one. Null if the call was given up.
  ros::ServiceServerLinkPtr find(std::uint64_t number) {
    const std::string type = ros::service_traits::md5sum<Type>();
    std::unique_lock<std::mutex> lock(mutex_);
    while (current_ == number) {
      lock.unlock();
      auto link = ros::ServiceManager::instance()->createServiceServerLink(name_, false, type, type, {});
      lock.lock();
      if (link && current_ == number) {
        found_ = true;
        link_ = link;  // lets `forget` end the call
        return link;
      }
      if (link) link->getConnection()->drop(ros::Connection::Destructing);
      changed_.wait_for(lock, std::chrono::milliseconds(100), [this, number] { return current_ != number; });
    }
    return {};
  }

  static bool read(const ros::SerializedMessage& answer, Response& response) {
    try {
      ros::serialization::deserializeMessage(answer, response);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }

  const std::string name_;
  std::mutex mutex_;  // for the members that both threads use, up to `ending_`
  std::condition_variable changed_;
  std::optional<Request> request_;
  std::uint64_t current_ = 0;  // the number of the current call; 0: none
  bool found_ = false;         // whether its server was found
  ros::ServiceServerLinkPtr link_;
  bool ending_ = false;

  EventQueue events_;
  std::thread worker_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_SERVICE_CLIENT_HPP_
