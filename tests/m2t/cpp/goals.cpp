// Checks of the goal of an action, with a middleware that only counts. Prints what does not hold, as `headers.cpp`.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "robosc/goal_client.hpp"
#include "robosc/goal_proxy.hpp"
#include "robosc_ros2/cancel_answer.hpp"

namespace {

using namespace robosc;

constexpr int kTimeout = 1000, kRetry = 400, kPoll = 50, kLost = 30000;
const char* const kRefused = "the server refuses to cancel the goal";
const char* const kUnanswered = "the server does not answer the request to cancel the goal within 1000 ms";

/// Is over when the check says so.
class Countdown {
 public:
  Countdown(std::chrono::milliseconds time, std::function<void()> over)
      : time_(static_cast<int>(time.count())), over_(std::move(over)) {
    all().push_back(this);
  }
  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;
  ~Countdown() { all().erase(std::find(all().begin(), all().end(), this)); }

  void start() { running_ = true; }
  void stop() { running_ = false; }
  bool running() const { return running_; }

  /// Those that run for so long are over; how many they were.
  static int expire(int time) {
    std::vector<Countdown*> due;
    for (Countdown* one : all()) {
      if (one->running_ && one->time_ == time) due.push_back(one);
    }
    for (Countdown* one : due) {
      one->running_ = false;
      one->over_();
    }
    return static_cast<int>(due.size());
  }

 private:
  static std::vector<Countdown*>& all() {
    static std::vector<Countdown*> countdowns;
    return countdowns;
  }

  int time_;
  std::function<void()> over_;
  bool running_ = false;
};

struct Client : GoalClient<Countdown, int, int> {
  using Told = std::vector<std::string>;

  Client()
      : GoalClient(std::chrono::milliseconds(kTimeout), std::chrono::milliseconds(kRetry),
                   {[this](const int& feedback) { told.push_back("feedback " + std::to_string(feedback)); },
                    [this](const int& result) { told.push_back("response " + std::to_string(result)); },
                    [this](Failure reason, const std::string& why, const int& result) {
                      told.push_back(std::string("error ") + failure_name(reason) + " " + why + " " + std::to_string(result));
                    },
                    [this](Failure reason, const std::string& why, const int& result) {
                      told.push_back(std::string("canceled ") + failure_name(reason) + " " + why + " " + std::to_string(result));
                    }}) {}
  using GoalClient::abort;
  using GoalClient::accept;
  using GoalClient::await_result;
  using GoalClient::begin;
  using GoalClient::cancel_answered;
  using GoalClient::canceled;
  using GoalClient::hear;
  using GoalClient::lose;
  using GoalClient::succeed;

  bool is_served() override { return served; }
  bool is_gone() override { return gone; }
  bool is_canceling() override { return canceling; }
  bool send() override { return true; }
  void request_cancel() override { ++asked; }
  void reset() override {}
  void warn(const std::string& text) override { warned.push_back(text); }

  /// A goal that the server has accepted.
  Client& accepted() {
    begin();
    accept();
    return *this;
  }

  bool served = true;
  bool gone = false;
  bool canceling = false;
  int asked = 0;
  Told told;
  Told warned;
};

void a_cancel_waits_for_acceptance_and_nothing_is_dropped() {
  Client client;
  client.begin();
  client.cancel();
  CHECK(client.asked == 0);  // It does not know the goal yet.
  client.accept();
  client.cancel();
  CHECK(client.asked == 1);
  client.cancel_answered(CancelAnswer::accepted);
  client.hear(7);
  CHECK(Countdown::expire(kTimeout) == 0 && Countdown::expire(kRetry) == 0 && client.busy() && client.asked == 1);
  client.canceled("", 3);
  CHECK((client.told == Client::Told{"feedback 7", "canceled canceled canceled by the controller itself, an error to the model 3"}));
  CHECK(!client.busy() && client.warned.empty());
}

void each_end_has_its_reason_and_result() {
  Client client;
  client.accepted().succeed(1);
  client.accepted().abort(": stuck", 2);
  client.accepted().lose(": stuck");
  client.accepted().canceled(": stuck", 3);
  client.accepted().cancel();
  client.succeed(4);
  client.accepted().gone = true;
  Countdown::expire(kPoll);
  client.gone = false;
  client.served = false;
  client.begin();
  Countdown::expire(kTimeout);
  client.begin();
  client.cancel();
  Countdown::expire(kPoll);
  CHECK((client.told == Client::Told{"response 1", "error aborted aborted: stuck 2",
                                     "error lost the server has lost the goal: stuck 0",
                                     "canceled canceled canceled by someone else: stuck 3", "response 4",
                                     "error lost the server is gone 0", "error unavailable no server within 1000 ms 0",
                                     "canceled canceled canceled before it was sent 0"}));
}

void a_refused_cancel_is_reported_once_and_asked_again() {
  Client client;
  client.accepted().cancel();
  client.cancel_answered(CancelAnswer::refused);
  CHECK(client.trouble() == kRefused && Countdown::expire(kTimeout) == 0);
  CHECK(Countdown::expire(kRetry) == 1 && client.asked == 2);
  client.cancel_answered(CancelAnswer::refused);
  CHECK(Countdown::expire(kRetry) == 1 && client.asked == 3);
  CHECK(Countdown::expire(kTimeout) == 1 && client.trouble() == kUnanswered);
  CHECK(client.waits());
  client.leave();
  CHECK(client.warned.back() == std::string("the goal has not ended when this node ends: ") + kUnanswered);
  client.warned.pop_back();
  client.cancel_answered(CancelAnswer::accepted);
  CHECK(client.trouble().empty() && client.waits() && Countdown::expire(kRetry) == 0);
  for (const CancelAnswer late : {CancelAnswer::refused, CancelAnswer::terminated, CancelAnswer::unknown}) {
    client.cancel_answered(late);
  }
  CHECK(client.busy() && client.told.empty() && client.asked == 3);
  CHECK((client.warned == Client::Told{kRefused, kUnanswered}));
}

void an_unknown_goal_is_lost_and_a_terminated_one_without_a_result() {
  Client client;
  client.accepted().cancel();
  client.cancel_answered(CancelAnswer::unknown);
  client.accepted().cancel();
  client.cancel_answered(CancelAnswer::terminated);
  CHECK(client.busy() && Countdown::expire(kTimeout) == 1);
  client.accepted().cancel();
  client.cancel_answered(CancelAnswer::terminated);
  client.canceling = true;  // Someone else has canceled it, and it brakes.
  Countdown::expire(kTimeout);
  CHECK(client.busy() && Countdown::expire(kTimeout) == 0);
  client.canceled("", 5);
  CHECK((client.told == Client::Told{"error lost the server does not know the goal 0",
                                     "error lost the goal has ended, but its result did not come within 1000 ms 0",
                                     "canceled canceled canceled by the controller itself, an error to the model 5"}));
}

void a_goal_that_is_accepted_late_is_told_when_it_has_ended() {
  Client client;
  client.begin();
  CHECK(client.waits());
  Countdown::expire(kTimeout);
  CHECK(client.told.empty() && client.busy() && client.trouble() == "not accepted within 1000 ms");
  const int before = client.asked;
  client.accept();
  CHECK(client.asked == before + 1 && Countdown::expire(kLost) == 0);
  client.cancel_answered(CancelAnswer::accepted);
  client.canceled("", 1);
  client.begin();
  Countdown::expire(kTimeout);
  Countdown::expire(kLost);
  CHECK((client.told == Client::Told{"canceled timeout accepted too late, then canceled 1",
                                     "error lost neither accepted nor rejected 0"}));
}

void a_lost_goal_is_no_goal_that_was_accepted_late_and_has_ended() {
  Client client;
  client.begin();
  Countdown::expire(kTimeout);
  client.accept();
  client.lose();
  CHECK(client.told == Client::Told{"error lost the server has lost the goal 0"});
}

/// As `action_msgs/srv/CancelGoal` has it.
struct CancelResponse {
  static constexpr std::int8_t ERROR_NONE = 0, ERROR_REJECTED = 1, ERROR_UNKNOWN_GOAL_ID = 2, ERROR_GOAL_TERMINATED = 3;
  struct Identifier {
    std::array<std::uint8_t, 16> uuid;
  };
  struct Goal {
    Identifier goal_id;
  };
  std::int8_t return_code;
  std::vector<Goal> goals_canceling;
};

void only_an_answer_without_error_that_names_the_goal_accepts_a_cancel() {
  const std::array<std::uint8_t, 16> own = {1}, other = {2};
  const std::vector<CancelResponse::Goal> owns = {{{own}}}, others = {{{other}}}, both = {{{other}}, {{own}}};
  CHECK(cancel_answer(CancelResponse{0, owns}, own) == CancelAnswer::accepted);
  CHECK(cancel_answer(CancelResponse{0, both}, own) == CancelAnswer::accepted);
  CHECK(cancel_answer(CancelResponse{0, {}}, own) == CancelAnswer::refused);
  CHECK(cancel_answer(CancelResponse{0, others}, own) == CancelAnswer::refused);
  for (const std::int8_t code : {std::int8_t{1}, std::int8_t{77}, std::int8_t{-1}}) {
    CHECK(cancel_answer(CancelResponse{code, {}}, own) == CancelAnswer::refused);
    CHECK(cancel_answer(CancelResponse{code, owns}, own) == CancelAnswer::refused);
  }
  CHECK(cancel_answer(CancelResponse{2, {}}, own) == CancelAnswer::unknown);
  CHECK(cancel_answer(CancelResponse{3, {}}, own) == CancelAnswer::terminated);
}

struct Proxy : GoalProxy<Countdown, int, int, int> {
  using Told = std::vector<std::string>;

  Proxy()
      : GoalProxy(std::chrono::milliseconds(kTimeout), std::chrono::milliseconds(kRetry), handlers()) {}
  using GoalProxy::accept;
  using GoalProxy::admit;
  using GoalProxy::cancel_answered;
  using GoalProxy::canceled;
  using GoalProxy::finish;
  using GoalProxy::hear;
  using GoalProxy::look;
  using GoalProxy::lose;
  using GoalProxy::succeed;

  Handlers handlers() {
    Handlers made;
    made.goal = [this](const int& goal) { return goal > 0; };
    made.busy = [this] { told.push_back("busy"); };
    made.feedback = [this](const int&) { told.push_back("feedback"); };
    made.response = [this](const int&) { told.push_back("response"); };
    made.error = [this](Failure reason, const std::string& why, const int& result) {
      told.push_back(std::string("error ") + failure_name(reason) + " " + why + " " + std::to_string(result));
    };
    made.canceled = [this](Failure reason, const std::string& why, const int& result) {
      told.push_back(std::string("canceled ") + failure_name(reason) + " " + why + " " + std::to_string(result));
    };
    made.warn = [this](const std::string& text) { warned.push_back(text); };
    return made;
  }

  bool is_served() override { return served; }
  bool is_canceling() override { return canceling; }
  bool send() override { return true; }
  void send_cancel() override { ++asked; }
  void restart(std::chrono::milliseconds) override { due = false; }
  bool is_over() override { return due; }
  void abandon() override { told.push_back("abandoned"); }

  /// A goal that the robot has accepted.
  Proxy& accepted() {
    CHECK(admit(1, [] {}));
    look();
    accept();
    return *this;
  }
  void pass() {
    due = true;
    look();
  }

  bool served = true;
  bool canceling = false;
  bool due = false;
  int asked = 0;
  Told told;
  Told warned;
};

void a_layer_follows_a_goal_that_it_cancels_to_its_end() {
  Proxy proxy;
  proxy.accepted().cancel();
  CHECK(proxy.asked == 1 && proxy.waits());
  proxy.cancel_answered(CancelAnswer::refused);
  CHECK(proxy.trouble() == kRefused);
  CHECK(Countdown::expire(kRetry) == 1 && proxy.asked == 2);
  CHECK(Countdown::expire(kTimeout) == 1);
  proxy.leave();
  proxy.cancel_answered(CancelAnswer::accepted);
  proxy.hear(1);
  proxy.pass();
  CHECK(proxy.told == Proxy::Told{"feedback"} && proxy.asked == 2 && proxy.trouble().empty());
  proxy.finish();
  proxy.canceled(2);
  CHECK(proxy.told.back() == "canceled canceled canceled 2");
  const std::string left = std::string("the goal has not ended when this layer ends: ") + kUnanswered;
  CHECK((proxy.warned == Proxy::Told{kRefused, kUnanswered, left}));
}

void a_layer_waits_for_the_end_of_a_goal_that_is_accepted_late() {
  Proxy proxy;
  CHECK(proxy.admit(1, [] {}));
  proxy.look();
  proxy.pass();
  CHECK(proxy.told.empty() && proxy.warned == Proxy::Told{"not accepted within 1000 ms"});
  const int before = proxy.asked;
  CHECK(!proxy.admit(1, [] {}) && proxy.told == Proxy::Told{"busy"});
  proxy.accept();
  CHECK(proxy.asked == before + 1);
  proxy.cancel_answered(CancelAnswer::accepted);
  proxy.finish();
  proxy.canceled(2);
  CHECK(proxy.told.back() == "canceled timeout canceled 2");
  proxy.lose();
  CHECK(proxy.told.back() == "error lost the server has lost the goal 0");

  CHECK(proxy.admit(1, [] {}));
  proxy.look();
  proxy.pass();
  proxy.pass();
  CHECK(proxy.told.back() == "abandoned");
  CHECK(proxy.told[proxy.told.size() - 2] == "error lost neither accepted nor rejected 0");
}

void a_layer_hears_that_a_goal_is_lost() {
  Proxy proxy;
  proxy.accepted().cancel();
  proxy.cancel_answered(CancelAnswer::unknown);
  CHECK(proxy.told[0] == "error lost the server does not know the goal 0");
  proxy.accepted().cancel();
  proxy.cancel_answered(CancelAnswer::terminated);
  proxy.canceling = true;
  proxy.pass();
  CHECK(proxy.told.size() == 2);
  proxy.canceling = false;
  proxy.served = false;
  proxy.pass();
  CHECK(proxy.told[2] == "error lost the server is gone 0");
  CHECK(proxy.admit(1, [] {}));
  proxy.cancel();
  proxy.look();
  CHECK(proxy.told[4] == "canceled canceled canceled before it was sent 0");
}

}  // namespace

int main() {
  a_cancel_waits_for_acceptance_and_nothing_is_dropped();
  each_end_has_its_reason_and_result();
  a_refused_cancel_is_reported_once_and_asked_again();
  an_unknown_goal_is_lost_and_a_terminated_one_without_a_result();
  a_goal_that_is_accepted_late_is_told_when_it_has_ended();
  a_lost_goal_is_no_goal_that_was_accepted_late_and_has_ended();
  only_an_answer_without_error_that_names_the_goal_accepts_a_cancel();
  a_layer_follows_a_goal_that_it_cancels_to_its_end();
  a_layer_waits_for_the_end_of_a_goal_that_is_accepted_late();
  a_layer_hears_that_a_goal_is_lost();
  return faults;
}
