// Action that the controller serves.
#ifndef ROBOSC_ROS1_ACTION_SERVER_HPP_
#define ROBOSC_ROS1_ACTION_SERVER_HPP_

#include <string>
#include <utility>

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>

#include "robosc/goal_server.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The server of one action over actionlib. All functions run in the thread that serves the node's callback queue.
template <typename Type>
class ActionServer final
    : public GoalServer<actionlib::ServerGoalHandle<Type>, typename Type::_action_goal_type::_goal_type,
                        typename Type::_action_feedback_type::_feedback_type,
                        typename Type::_action_result_type::_result_type> {
 public:
  ACTION_DEFINITION(Type)
  using Handle = actionlib::ServerGoalHandle<Type>;
  using Base = GoalServer<Handle, Goal, Feedback, Result>;

  ActionServer(ros::NodeHandle& node, const std::string& name, typename Base::Handlers handlers)
      : Base(std::move(handlers)),
        server_(
            node, name, [this](Handle handle) { on_goal(handle); }, [this](const Handle& handle) { on_cancel(handle); },
            false) {
    server_.start();
  }

  ActionServer(const ActionServer&) = delete;
  ActionServer& operator=(const ActionServer&) = delete;

  ~ActionServer() override { this->leave(); }  // NOLINT(bugprone-exception-escape): locks of boost, should they fail

 private:
  void on_goal(Handle& handle) {
    const GoalConstPtr goal = handle.getGoal();
    if (!this->permits(*goal)) return handle.setRejected(Result(), "the controller does not accept the goal now");
    handle.setAccepted();
    this->begin(handle, *goal);
  }

  void on_cancel(const Handle& handle) {
    if (this->accepts_cancels() && this->is_open(handle)) this->cancel();
  }

  void send(Handle& handle, const Feedback& feedback) override { handle.publishFeedback(feedback); }
  void conclude(Handle handle, const Result& result) override { handle.setSucceeded(result); }
  void conclude_cancel(Handle handle, const Result& result) override { handle.setCanceled(result); }
  void fail(Handle handle, const Result& result, const char* why) override { handle.setAborted(result, why); }

  actionlib::ActionServer<Type> server_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_ACTION_SERVER_HPP_
