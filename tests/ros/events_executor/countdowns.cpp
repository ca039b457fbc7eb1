// Countdowns whose expiry waits in an executor when they are started again, or stopped.
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
  executor.cancel();
  spinning.join();
  std::printf("early %d, in time %d, stopped %d\n", early, late, stopped);
  rclcpp::shutdown();
}
