// Notes how long each tick of a node takes, and the same tick of the engine alone: without publishing, logging and data.
// At its end the node writes them to the file that ROBOSC_TICK_TIMES names, in nanoseconds.
#pragma once

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

class TickTimes {
 public:
  using Clock = std::chrono::steady_clock;

  ~TickTimes() {
    const char* path = std::getenv("ROBOSC_TICK_TIMES");
    if (path == nullptr) return;
    std::ofstream file(path);
    for (const auto& [node, engine] : times_) file << node.count() << ' ' << engine.count() << '\n';
  }

  void note(Clock::duration node, Clock::duration engine) { times_.emplace_back(node, engine); }

 private:
  std::vector<std::pair<std::chrono::nanoseconds, std::chrono::nanoseconds>> times_;
};

inline TickTimes tick_times;
