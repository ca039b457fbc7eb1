// What more than one thread or a signal touches: built with sanitizers, it prints nothing and ends with 0.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "robosc/callback_guard.hpp"
#include "robosc/event_log.hpp"
#include "robosc/hangup.hpp"

using namespace robosc;

namespace {

int faults = 0;

#define CHECK(condition)                                                     \
  do {                                                                       \
    if (!(condition)) {                                                      \
      std::printf("%s:%d: not %s\n", __FILE__, __LINE__, #condition);        \
      ++faults;                                                              \
    }                                                                        \
  } while (false)

// As nodes do: what is called back belongs to an object that goes.
class Counter {
 public:
  explicit Counter(std::function<void(int)>& callback) {
    callback = guard_([this](int step) { counts_.push_back(step); });
  }

 private:
  std::vector<int> counts_;
  CallbackGuard guard_;
};

void nothing_is_called_back_that_is_gone() {
  for (int round = 0; round < 40; ++round) {
    std::function<void(int)> callback;
    auto counter = std::make_unique<Counter>(callback);
    std::atomic<int> calls{0};
    std::atomic<bool> ending{false};
    std::vector<std::thread> executor;
    for (int thread = 0; thread < 2; ++thread) {
      executor.emplace_back([&] {
        while (!ending) {
          callback(1);
          ++calls;
        }
      });
    }
    while (calls < 4) std::this_thread::yield();
    counter.reset();
    const int before = calls;
    while (calls < before + 4) std::this_thread::yield();
    ending = true;
    for (std::thread& thread : executor) thread.join();
  }
}

void closing_waits_for_the_callback_that_runs() {
  CallbackGuard guard;
  std::atomic<bool> begun{false}, closes{false};
  bool done = false;
  const auto callback = guard([&] {
    begun = true;
    while (!closes) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    done = true;
  });
  std::thread executor(callback);
  while (!begun) std::this_thread::yield();
  closes = true;
  guard.close();
  CHECK(done);
  executor.join();
}

void what_is_made_after_closing_runs() {
  CallbackGuard guard;
  int calls = 0;
  const auto early = guard([&calls] { ++calls; });
  guard.close();
  const auto late = guard([&calls, &guard] {
    calls += 10;
    guard.close();  // its own one: it does not wait for itself
  });
  early();
  CHECK(calls == 0);
  late();
  late();
  CHECK(calls == 10);
}

void who_comes_after_closing_does_not_wait() {
  CallbackGuard guard;
  const auto late = guard([] {});
  auto running = guard.hold();  // as of a callback that closes and goes on
  guard.close();
  const auto done = std::async(std::launch::async, late);
  CHECK(done.wait_for(std::chrono::seconds(60)) == std::future_status::ready);
  running.unlock();
}

void siblings_exclude_each_other_and_close_alone() {
  CallbackGuard guard;
  const CallbackGuard sibling = guard.sibling();
  int calls = 0;
  const auto first = guard([&] { ++calls; });
  const auto second = sibling([&] { ++calls; });
  std::thread other([&] {
    for (int round = 0; round < 1000; ++round) second();
  });
  for (int round = 0; round < 1000; ++round) first();
  other.join();
  CHECK(calls == 2000);
  guard.close();
  first();
  CHECK(calls == 2000);
  second();
  CHECK(calls == 2001);
}

void beats_end_with_their_pointer_or_guard() {
  CallbackGuard guard;
  CallbackGuard sibling = guard.sibling();
  int first = 0, second = 0;
  CallbackGuard::Beat added;
  CallbackGuard::Beat kept = guard.at_each_beat([&] {
    ++first;
    added = sibling.at_each_beat([&] { ++second; });
  });
  guard.beat();
  CHECK(first == 1 && second == 1);
  kept.reset();
  guard.beat();
  CHECK(first == 1 && second == 2);
  sibling.close();
  guard.beat();
  CHECK(second == 2);
}

std::vector<std::string> lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);) found.push_back(line);
  return found;
}

void a_log_is_whole_and_in_order(const std::string& path) {
  {
    EventLog log(path);
    for (int number = 0; number < 20'000; ++number) {
      log.note(static_cast<double>(number));
      log.write(number, "in", "e");
    }
    CHECK(log.lost() == 0);
  }
  const auto found = lines(path);
  CHECK(found.size() == 20'000);
  for (std::size_t number = 0; number < found.size(); ++number) {
    const std::string text = std::to_string(number);
    CHECK(found[number] == R"({"time":)" + text + R"(,"direction":"in","event":"e","data":{"value":)" + text + "}}");
  }
  EventLog again(path);
  again.write(1, "in", "e");
  again = EventLog();
  CHECK(!again.active() && lines(path).size() == 20'001);
}

void a_log_tells_of_an_event_at_once(const std::string& path) {
  EventLog log(path);
  log.write(1, "in", "e");
  while (lines(path).empty()) std::this_thread::yield();
}

// A pipe that nobody reads is a disk that takes nothing.
void a_disk_that_hangs_delays_nobody(const std::string& path) {
  CHECK(mkfifo(path.c_str(), 0600) == 0);
  const int reader = open(path.c_str(), O_RDWR);
  std::thread drain;
  {
    LineWriter log(path);
    const std::string line(1000, 'e');
    for (int number = 0; number < 20'000; ++number) log.write(line);
    const std::size_t lost = log.lost();
    CHECK(lost > 1'000 && lost < 20'000);  // 8 MB are kept, as much is under way
    drain = std::thread([reader] {
      std::vector<char> bytes(1 << 20);
      while (read(reader, bytes.data(), bytes.size()) > 0 && bytes[0] != '!') {
      }
    });
  }
  while (write(reader, "!", 1) != 1) {
  }
  drain.detach();
}

void a_full_disk_is_told() {
  EventLog log("/dev/full");
  std::size_t lost = 0;
  while (lost == 0) {
    log.write(1, "in", "e");
    lost = log.lost();
  }
  CHECK(lost > 0);
}

void a_log_that_can_not_be_written_is_refused() {
  try {
    EventLog log("/no/such/folder/log");
    CHECK(false);
  } catch (const std::runtime_error& error) {
    CHECK(error.what() == std::string("the event log /no/such/folder/log cannot be written"));
  }
}

volatile std::sig_atomic_t terminations = 0;

void (*disposition())(int) {
  struct sigaction action = {};
  sigaction(SIGHUP, nullptr, &action);
  return action.sa_handler;
}

void a_hangup_ends_the_process_as_sigterm_does() {
  std::signal(SIGTERM, [](int) { terminations = terminations + 1; });
  std::signal(SIGHUP, SIG_DFL);
  {
    const Hangup first;
    {
      const Hangup second;
      std::raise(SIGHUP);
    }
    std::raise(SIGHUP);
  }
  CHECK(terminations == 2 && disposition() == SIG_DFL);
  std::signal(SIGHUP, SIG_IGN);
  {
    const Hangup ignored;
    CHECK(disposition() == SIG_IGN);
  }
  CHECK(disposition() == SIG_IGN);
}

}  // namespace

int main(int, char** arguments) {
  const std::string folder = arguments[1];
  nothing_is_called_back_that_is_gone();
  closing_waits_for_the_callback_that_runs();
  what_is_made_after_closing_runs();
  who_comes_after_closing_does_not_wait();
  siblings_exclude_each_other_and_close_alone();
  beats_end_with_their_pointer_or_guard();
  a_log_is_whole_and_in_order(folder + "/whole");
  a_log_tells_of_an_event_at_once(folder + "/at_once");
  a_disk_that_hangs_delays_nobody(folder + "/pipe");
  a_full_disk_is_told();
  a_log_that_can_not_be_written_is_refused();
  a_hangup_ends_the_process_as_sigterm_does();
  return faults;
}
