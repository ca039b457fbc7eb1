// What a server answers to a request to cancel a goal.
#ifndef ROBOSC_ROS2_CANCEL_ANSWER_HPP_
#define ROBOSC_ROS2_CANCEL_ANSWER_HPP_

#include <action_msgs/srv/cancel_goal.hpp>

#include "robosc/cancel_requests.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The answer to a request to cancel one goal.
inline CancelAnswer cancel_answer(const action_msgs::srv::CancelGoal::Response& response) {
  using Response = action_msgs::srv::CancelGoal::Response;
  if (response.return_code == Response::ERROR_GOAL_TERMINATED) return CancelAnswer::terminated;
  if (response.return_code == Response::ERROR_UNKNOWN_GOAL_ID) return CancelAnswer::unknown;
  return response.goals_canceling.empty() ? CancelAnswer::refused : CancelAnswer::accepted;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_CANCEL_ANSWER_HPP_
