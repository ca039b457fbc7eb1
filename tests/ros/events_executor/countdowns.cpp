// Countdowns whose expiry waits in an executor when they are started again, or stopped, and their effect on a timer.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include <rclcpp/experimental/executors/events_executor/events_executor.hpp>
#include <rclcpp/rclcpp.hpp>

#include "robosc_ros2/countdown.hpp"

using namespace std::chrono_literals;

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<rclcpp::Node>("countdowns");
  const robosc::CallbackGuard guard;
  const auto beats = node->create_wall_timer(robosc::kBeat, guard([&guard] { guard.beat(); }));
  int early = 0, late = 0, stopped = 0;
  std::chrono::steady_clock::time_point start;
  robosc::Countdown restarted(*node, guard, 50ms, [&] {
    ++(std::chrono::steady_clock::now() - start < 50ms ? early : late);
  });
  robosc::Countdown ended(*node, guard, 50ms, [&] { ++stopped; });
  rclcpp::experimental::executors::EventsExecutor executor;
  executor.add_node(node);
  std::thread spinning([&] { executor.spin(); });
  for (int round = 0; round < 5; ++round) {
    {
      const auto busy = guard.hold();  // no callback runs
      restarted.start();
      ended.start();
      std::this_thread::sleep_for(200ms);  // both are up, and wait
      start = std::chrono::steady_clock::now();
      restarted.start();
      ended.stop();
    }
    std::this_thread::sleep_for(500ms);
  }
  // A countdown that never is over, as it starts anew again and again, and a timer beside it.
  std::atomic<int> ticks{0};
  robosc::Countdown endless(*node, guard, 40ms, [] {});
  {
    const auto busy = guard.hold();
    endless.start();
  }
  const auto timer = node->create_wall_timer(50ms, [&] { ++ticks; });
  for (int turn = 0; turn < 5000 && ticks < 20; ++turn) {
    {
      const auto busy = guard.hold();
      endless.start();
    }
    std::this_thread::sleep_for(2ms);
  }
  executor.cancel();
  spinning.join();
  std::printf("early %d, in time %d, stopped %d, ticks %d\n", early, late, stopped, std::min<int>(ticks, 20));
  rclcpp::shutdown();
}
