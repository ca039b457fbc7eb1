// Checks of the times of a model, with a clock that is set by hand. Prints what does not hold, as `headers.cpp`.
#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "robosc/timeouts.hpp"

namespace {

using namespace robosc;

constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

struct Clock final : Timeouts {
  Clock(Engine engine, bool late) : Timeouts(std::move(engine), late) {}
  using Timeouts::ring;

  std::int64_t nanoseconds() const override { return time; }
  bool has_begun() const override { return time != 0; }
  void set(std::chrono::milliseconds left) override { asked.push_back(left.count()); }

  std::int64_t time = 0;
  std::vector<std::chrono::milliseconds::rep> asked;
};

void it_looks_when_the_next_time_is_up() {
  std::uint32_t left = kNever;
  int up = 0;
  bool counts = true;
  Clock clock({[](std::uint32_t) {}, [&](std::uint32_t) { return left; }, [&](std::uint32_t) { return up-- > 0; },
               [&] { return counts; }},
              false);
  clock.wait();
  CHECK(clock.asked.empty());
  left = 50;
  clock.wait();
  left = 70;  // It looks before.
  clock.wait();
  CHECK(clock.asked == std::vector<std::chrono::milliseconds::rep>{50});
  left = 20;
  clock.wait();
  CHECK(clock.asked.back() == 20);
  up = 2;
  clock.ring();
  CHECK(up == -1 && clock.asked.size() == 3);
  counts = false;
  clock.ring();
  CHECK(up == -1 && clock.asked.size() == 3);
}

void it_catches_up_with_what_has_expired() {
  std::uint32_t left = 1;
  int up = 2;
  Clock clock({[](std::uint32_t) {}, [&](std::uint32_t) { return left; }, [&](std::uint32_t) { return up-- > 0; }},
              false);
  clock.catch_up();
  CHECK(up == 2);
  left = 0;
  clock.catch_up();
  CHECK(up == -1);
}

void a_clock_that_begins_late_starts_all_times() {
  std::vector<std::uint32_t> restarts;
  Clock clock({[&](std::uint32_t now) { restarts.push_back(now); }, [](std::uint32_t) { return kNever; },
               [](std::uint32_t) { return false; }},
              true);
  CHECK(clock.at() == 0 && restarts.empty());
  clock.time = 4'999'999'999;
  CHECK(clock.at() == 4999 && clock.at() == 4999);
  CHECK(restarts == std::vector<std::uint32_t>{4999});
  clock.time = (std::int64_t{1} << 32) * 1'000'000;  // it wraps
  CHECK(clock.at() == 0 && restarts.size() == 1);
}

}  // namespace

int main() {
  it_looks_when_the_next_time_is_up();
  it_catches_up_with_what_has_expired();
  a_clock_that_begins_late_starts_all_times();
  return faults;
}
