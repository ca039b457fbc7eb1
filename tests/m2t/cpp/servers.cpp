// Checks of served requests and goals, with a middleware that only counts. Prints what does not hold, as `headers.cpp`.
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "robosc/call_server.hpp"
#include "robosc/goal_server.hpp"

namespace {

using namespace robosc;

/// A service with numbers as callers and requests. Negative requests can't be handled.
struct Service : CallServer<int, int, int> {
  Service()
      : CallServer("gone", {[this] { return ready; }, [this](const int& request) { return take(request); },
                            [this](const std::string& text) { warned.push_back(text); }}) {}
  using CallServer::called;

  bool take(int request) {
    if (request < 0) return false;
    taken.push_back(request);
    if (answers_at_once) respond(-request);
    return true;
  }

  void answer(const int& caller, const int& response) override { answered.emplace_back(caller, response); }
  void refuse(const int& caller) override { refused.push_back(caller); }
  void defer() override { ++deferred; }

  bool ready = true;
  bool answers_at_once = false;
  int deferred = 0;
  std::vector<int> taken;
  std::vector<std::pair<int, int>> answered;
  std::vector<int> refused;
  std::vector<std::string> warned;
};

void requests_are_taken_one_at_a_time() {
  Service service;
  service.called(1, 10);
  service.called(2, 20);
  CHECK(service.taken == std::vector({10}));
  service.respond(7);
  CHECK(service.answered == (std::vector<std::pair<int, int>>{{1, 7}}));
  CHECK(service.deferred == 1 && service.taken.size() == 1);  // The events of the model go on first.
  service.look();
  CHECK(service.taken == std::vector({10, 20}));
  service.respond(8);
  CHECK(service.deferred == 1 && service.answered.back() == std::make_pair(2, 8));
  service.respond(9);
  CHECK(service.answered.size() == 2);
}

void requests_wait_until_the_controller_is_ready() {
  Service service;
  service.ready = false;
  service.answers_at_once = true;
  service.called(1, 10);
  service.called(2, -1);
  service.called(3, 30);
  CHECK(service.taken.empty());
  service.ready = true;
  service.look();
  CHECK(service.answered == (std::vector<std::pair<int, int>>{{1, -10}, {3, -30}}));
  CHECK(service.refused == std::vector({2}) && service.warned.empty());
}

void ten_requests_wait_and_then_the_oldest_is_refused() {
  Service service;
  for (int caller = 0; caller <= 10; ++caller) service.called(caller, caller);
  CHECK(service.refused.empty());
  service.called(11, 11);
  CHECK(service.refused == std::vector({1}));
  CHECK(service.warned == std::vector<std::string>({"more than 10 requests wait: the oldest one is gone"}));
  service.called(12, 12);
  CHECK(service.refused == std::vector({1, 2}) && service.warned.size() == 1);  // The next one after five seconds.
  service.leave();
  CHECK(service.warned.back() == "requests without a response at the end of this node: 11");
  CHECK(service.refused == std::vector({1, 2, 0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  service.leave();
  CHECK(service.warned.size() == 2);
}

/// An action with texts as handles and numbers as goals.
struct Action : GoalServer<std::string, int, int, int> {
  explicit Action(bool cancels = true)
      : GoalServer({[this](const int&) { return permitting; }, [this](const int& goal) { return start(goal); },
                    cancels ? std::function<void()>([this] { told.push_back("cancel"); }) : nullptr,
                    [this](const std::string& text) { told.push_back("warn " + text); }}) {}
  using GoalServer::accepts_cancels;
  using GoalServer::begin;
  using GoalServer::is_open;
  using GoalServer::permits;

  bool start(int goal) {
    if (goal < 0) return false;
    told.push_back("goal " + std::to_string(goal));
    if (goal == 0) succeed(100);
    return true;
  }

  void send(std::string& handle, const int& feedback) override { tell(handle, "feedback", feedback); }
  void conclude(std::string handle, const int& result) override { tell(handle, "success", result); }
  void conclude_cancel(std::string handle, const int& result) override { tell(handle, "canceled", result); }
  void fail(std::string handle, const int& result, const char* why) override { tell(handle, why, result); }
  void tell(const std::string& handle, const std::string& what, int value) {
    told.push_back(handle + " " + what + " " + std::to_string(value));
  }

  bool permitting = true;
  std::vector<std::string> told;
};

void one_goal_is_open_at_a_time() {
  Action action;
  CHECK(action.permits(1));
  action.begin("a", 1);
  CHECK(!action.permits(2) && action.is_open("a") && !action.is_open("b"));
  action.publish(5);
  action.abort(6);
  action.succeed(7);
  action.publish(8);
  const std::string rejected = "warn a goal is rejected: its data or the present state does not permit it";
  CHECK(action.told == std::vector<std::string>({"goal 1", rejected, "a feedback 5", "a aborted 6"}));
  action.permitting = false;
  CHECK(!action.permits(1) && !action.is_open("a"));
  CHECK(action.told.size() == 4);  // The next warning of a rejection after five seconds.
}

void a_goal_may_end_at_once_and_may_fail_to_begin() {
  Action action;
  action.begin("a", 0);
  action.begin("b", -1);
  CHECK(action.told == std::vector<std::string>({"goal 0", "a success 100", "b the goal cannot begin 0"}));
  CHECK(action.permits(1));
}

void the_end_of_the_node_aborts_the_goal() {
  Action action(false);
  CHECK(!action.accepts_cancels() && Action().accepts_cancels());
  action.leave();
  CHECK(action.told.empty());
  action.begin("a", 1);
  action.leave();
  CHECK(action.told.back() == "a the controller has ended 0");
  CHECK(action.told[1] == "warn the goal is aborted because this node ends");
  action.canceled(1);
  CHECK(action.told.size() == 3);
}

}  // namespace

int main() {
  requests_are_taken_one_at_a_time();
  requests_wait_until_the_controller_is_ready();
  ten_requests_wait_and_then_the_oldest_is_refused();
  one_goal_is_open_at_a_time();
  a_goal_may_end_at_once_and_may_fail_to_begin();
  the_end_of_the_node_aborts_the_goal();
  return faults;
}
