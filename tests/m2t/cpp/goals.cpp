// Checks of the goal of an action, with a middleware that only counts. Prints what does not hold, as `headers.cpp`.
#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "checks.hpp"
#include "robosc/goal_client.hpp"

namespace {

using namespace robosc;

/// Is never over.
class Countdown {
 public:
  Countdown(std::chrono::milliseconds, std::function<void()>) {}
  void start() { running_ = true; }
  void stop() { running_ = false; }
  bool running() const { return running_; }

 private:
  bool running_ = false;
};

struct Client : GoalClient<Countdown, int, int> {
  Client()
      : GoalClient(std::chrono::milliseconds(1000),
                   {[](const int&) {}, [](const int&) {}, [](const std::string&) {}, [] {}}) {}
  using GoalClient::accept;
  using GoalClient::begin;
  using GoalClient::cancel_answered;

  bool is_served() override { return true; }
  bool is_gone() override { return false; }
  bool send() override { return true; }
  void request_cancel() override { ++asked; }
  void reset() override {}
  void warn(const std::string&) override { ++warned; }

  int asked = 0;
  int warned = 0;
};

void a_server_is_not_asked_to_cancel_while_it_is_to_answer() {
  Client client;
  client.begin();
  client.cancel();
  CHECK(client.asked == 0);  // It does not know the goal yet.
  client.accept();
  CHECK(client.asked == 1);
  client.interrupt();
  CHECK(client.asked == 1);
  client.cancel_answered(false);
  client.interrupt();
  CHECK(client.asked == 2 && client.warned == 1);
}

}  // namespace

int main() {
  a_server_is_not_asked_to_cancel_while_it_is_to_answer();
  return faults;
}
