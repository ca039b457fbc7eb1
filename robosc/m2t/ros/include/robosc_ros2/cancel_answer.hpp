// Answers of a server to requests to cancel a goal.
#ifndef ROBOSC_ROS2_CANCEL_ANSWER_HPP_
#define ROBOSC_ROS2_CANCEL_ANSWER_HPP_

#include <algorithm>

#include "robosc/cancel_requests.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The answer to a request to cancel the goal `id`. An answer that names only other goals is a refusal. `Response`: the
/// response type of `action_msgs/srv/CancelGoal`.
template <typename Response, typename Id>
CancelAnswer cancel_answer(const Response& response, const Id& id) {
  if (response.return_code == Response::ERROR_GOAL_TERMINATED) return CancelAnswer::terminated;
  if (response.return_code == Response::ERROR_UNKNOWN_GOAL_ID) return CancelAnswer::unknown;
  const auto& goals = response.goals_canceling;
  const bool named = std::any_of(goals.begin(), goals.end(), [&](const auto& goal) { return goal.goal_id.uuid == id; });
  return response.return_code == Response::ERROR_NONE && named ? CancelAnswer::accepted : CancelAnswer::refused;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_CANCEL_ANSWER_HPP_
