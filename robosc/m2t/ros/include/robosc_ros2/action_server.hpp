// Action that the controller serves.
#ifndef ROBOSC_ROS2_ACTION_SERVER_HPP_
#define ROBOSC_ROS2_ACTION_SERVER_HPP_

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>

#include "robosc/callback_guard.hpp"
#include "robosc/goal_server.hpp"
#include "robosc/version.hpp"
#include "robosc_ros2/deferral.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The server of one action. The node's executor calls the handlers.
template <typename Type>
class ActionServer final : public GoalServer<std::shared_ptr<rclcpp_action::ServerGoalHandle<Type>>,
                                             typename Type::Goal, typename Type::Feedback, typename Type::Result> {
 public:
  using Goal = typename Type::Goal;
  using Feedback = typename Type::Feedback;
  using Result = typename Type::Result;
  using Handle = std::shared_ptr<rclcpp_action::ServerGoalHandle<Type>>;
  using Base = GoalServer<Handle, Goal, Feedback, Result>;

  template <typename Node>
  ActionServer(Node& node, const CallbackGuard& guard, const std::string& name, typename Base::Handlers handlers)
      : Base(std::move(handlers)), canceling_(node, guard, [this] { follow_cancel(); }) {
    using rclcpp_action::CancelResponse;
    using rclcpp_action::GoalResponse;
    const auto permit = guard([this](const Goal& goal, bool& permitted) { permitted = this->permits(goal); });
    const auto cancel = guard([this](const Handle& handle, bool& accepted) { accepted = accepts_cancel(handle); });
    server_ = rclcpp_action::create_server<Type>(
        &node, name,
        [permit](const rclcpp_action::GoalUUID&, std::shared_ptr<const Goal> goal) {
          bool permitted = false;
          permit(*goal, permitted);
          return permitted ? GoalResponse::ACCEPT_AND_EXECUTE : GoalResponse::REJECT;
        },
        [cancel](const Handle& handle) {
          bool accepted = false;
          cancel(handle, accepted);
          return accepted ? CancelResponse::ACCEPT : CancelResponse::REJECT;
        },
        guard([this](Handle handle) { this->begin(handle, *handle->get_goal()); }));
  }

  ~ActionServer() override { this->leave(); }  // NOLINT(bugprone-exception-escape): out of memory

 private:
  bool accepts_cancel(const Handle& handle) {
    const bool accepted = this->accepts_cancels() && this->is_open(handle);
    if (accepted) canceling_.request();
    return accepted;
  }

  /// The goal is canceling once rclcpp has answered the request.
  void follow_cancel() {
    if (this->open() && (*this->open())->is_canceling()) this->cancel();
  }

  void send(Handle& handle, const Feedback& feedback) override {
    attempt([&] { handle->publish_feedback(std::make_shared<Feedback>(feedback)); });
  }
  void conclude(Handle handle, const Result& result) override {
    attempt([&] { handle->succeed(std::make_shared<Result>(result)); });
  }
  void conclude_cancel(Handle handle, const Result& result) override {
    attempt([&] { handle->canceled(std::make_shared<Result>(result)); });
  }
  void fail(Handle handle, const Result& result, const char*) override {
    attempt([&] { handle->abort(std::make_shared<Result>(result)); });
  }

  template <typename Send>
  void attempt(Send send) {
    try {
      send();
    } catch (const std::exception& error) {
      this->warn(std::string("the client cannot be informed: ") + error.what());
    }
  }

  Deferral canceling_;
  typename rclcpp_action::Server<Type>::SharedPtr server_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_ACTION_SERVER_HPP_
