// Checks of the call of a service, with a middleware that only counts. Prints what does not hold, as `headers.cpp`.
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "robosc/call_client.hpp"
#include "robosc/call_proxy.hpp"

namespace {

using namespace robosc;

/// Is over when it is told so.
class Countdown {
 public:
  Countdown(std::chrono::milliseconds, std::function<void()> over) { last_over() = std::move(over); }
  void start() { running_ = true; }
  void stop() { running_ = false; }
  bool running() const { return running_; }

  static std::function<void()>& last_over() {
    static std::function<void()> over;
    return over;
  }

 private:
  bool running_ = false;
};

struct Client final : CallClient<Countdown, int> {
  explicit Client(Handlers handlers) : CallClient(std::chrono::milliseconds(1000), std::move(handlers)) {}
  using CallClient::begin;
  using CallClient::fail;
  using CallClient::stop;
  using CallClient::succeed;

  void forget() override { ++forgotten; }
  Missing missing() override { return {Failure::unavailable, "no server"}; }

  int forgotten = 0;
};

void a_call_has_one_end() {
  std::vector<std::string> told;
  Client client({[&](const int& response) { told.push_back(std::to_string(response)); },
                 [&](Failure reason, const std::string& why) {
                   told.push_back(why);
                   CHECK(reason == Failure::unavailable);
                 }});
  const std::uint64_t first = client.begin();
  client.succeed(first, 1);
  client.fail(first, Failure::failed, "late");
  Countdown::last_over()();
  CHECK(told == std::vector<std::string>{"1"});

  const std::uint64_t second = client.begin();
  CHECK(second != first);
  client.succeed(first, 2);
  Countdown::last_over()();
  client.succeed(second, 3);
  CHECK((told == std::vector<std::string>{"1", "no server within 1000 ms"}));

  const int forgotten = client.forgotten;
  const std::uint64_t third = client.begin();
  client.stop();
  client.succeed(third, 4);
  CHECK(told.size() == 2 && client.forgotten == forgotten + 2);
}

void a_call_from_a_handler_is_another_one() {
  std::uint64_t next = 0;
  std::string told;
  Client* again = nullptr;
  Client client({[](const int&) {},
                 [&](Failure, const std::string& why) {
                   told += why;
                   if (next == 0) next = again->begin();
                 }});
  again = &client;
  client.fail(client.begin(), Failure::failed, "first ");
  client.fail(next, Failure::failed, "second");
  CHECK(told == "first second");
}

struct Proxy final : CallProxy<int, int, int> {
  explicit Proxy(Handlers handlers) : CallProxy(std::move(handlers)) {}
  using CallProxy::answers;
  using CallProxy::called;

  void forward(const int& request) override { forwarded.push_back(request); }
  void answer(const int& caller, const std::optional<int>& response) override {
    answered.emplace_back(caller, response);
  }

  std::vector<int> forwarded;
  std::vector<std::pair<int, std::optional<int>>> answered;
};

void each_caller_is_answered_once() {
  int busy = 0;
  std::string heard;
  Proxy proxy({[](const int& request) { return request > 0; }, [&] { ++busy; },
               [&](const int& response) { heard += std::to_string(response); },
               [&](Failure reason, const std::string& why) {
                 heard += why;
                 CHECK(reason == Failure::timeout);
               }});
  const auto robot = proxy.answers<Client::Handlers>();
  using Answers = decltype(proxy.answered);

  proxy.called(1, -5);  // blocked
  CHECK(proxy.forwarded.empty() && (proxy.answered == Answers{{1, std::nullopt}}));
  proxy.called(2, 5);
  proxy.called(3, 6);
  CHECK(busy == 1 && proxy.forwarded == std::vector<int>{5});
  robot.response(7);
  CHECK((proxy.answered == Answers{{1, std::nullopt}, {3, std::nullopt}, {2, 7}}));
  proxy.called(4, 8);
  robot.error(Failure::timeout, "!");
  CHECK(heard == "7!" && proxy.answered.back() == std::make_pair(4, std::optional<int>()));
}

}  // namespace

int main() {
  a_call_has_one_end();
  a_call_from_a_handler_is_another_one();
  each_caller_is_answered_once();
  return faults;
}
