// Calls from other threads, in line with the messages of ROS.
#ifndef ROBOSC_ROS1_EVENT_QUEUE_HPP_
#define ROBOSC_ROS1_EVENT_QUEUE_HPP_

#include <cstdint>
#include <functional>
#include <utility>

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <boost/make_shared.hpp>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Puts calls from any thread into a node's callback queue. They run one at a time with its messages and timers.
/// Pending calls never run after the destruction of this object.
class EventQueue {
 public:
  explicit EventQueue(const ros::NodeHandle& node) : queue_(node.getCallbackQueue()) {}
  ~EventQueue() { queue_->removeByID(id()); }
  EventQueue(const EventQueue&) = delete;
  EventQueue& operator=(const EventQueue&) = delete;

  void push(std::function<void()> function) {
    queue_->addCallback(boost::make_shared<Call>(std::move(function)), id());
  }

 private:
  class Call : public ros::CallbackInterface {
   public:
    explicit Call(std::function<void()> function) : function_(std::move(function)) {}
    CallResult call() override {
      function_();
      return Success;
    }

   private:
    std::function<void()> function_;
  };

  std::uint64_t id() const { return reinterpret_cast<std::uintptr_t>(this); }

  ros::CallbackQueueInterface* queue_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_EVENT_QUEUE_HPP_
