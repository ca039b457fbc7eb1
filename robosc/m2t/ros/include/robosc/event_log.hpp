// The file with the events of a node.
#ifndef ROBOSC_EVENT_LOG_HPP_
#define ROBOSC_EVENT_LOG_HPP_

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "robosc/json.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The default path of a log, in the folder of ROS's own logs. `node` is the node's full name, such as `/left/base`.
/// The path of a renamed node contains its package, too.
inline std::string default_log(std::string node, const std::string& package) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  std::filesystem::path folder = variable("ROS_LOG_DIR");
  if (folder.empty() && !variable("ROS_HOME").empty()) folder = std::filesystem::path(variable("ROS_HOME")) / "log";
  if (folder.empty()) folder = std::filesystem::path(variable("HOME")) / ".ros" / "log";
  std::error_code failed;  // opening the log reports the failure
  std::filesystem::create_directories(folder, failed);
  node.erase(0, node.find_first_not_of('/'));
  if (node.substr(node.rfind('/') + 1) != package) node += "/" + package;
  std::replace(node.begin(), node.end(), '/', '.');
  return folder / (node + "-events.jsonl");
}

/// Appends lines to a file in a separate thread, so that a slow disk delays no caller. Writes within 20 ms, and writes
/// all lines at destruction. Keeps some MB of lines for a slow disk.
class LineWriter {
 public:
  explicit LineWriter(const std::string& path) : file_(path, std::ios::app) {
    if (!file_) throw std::runtime_error("the event log " + path + " cannot be written");
    thread_ = std::thread([this] { work(); });
  }

  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  ~LineWriter() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }

  void write(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (lines_.size() + line.size() > kKept) {
      ++lost_;
      return;
    }
    const bool waits = lines_.empty();
    lines_ += line;
    ++waiting_;
    if (waits) changed_.notify_one();
  }

  /// The number of lost lines not reported yet, once a second. Otherwise 0.
  std::size_t lost() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (lost_ == 0 || now < told_ + std::chrono::seconds(1)) return 0;
    told_ = now;
    return std::exchange(lost_, 0);
  }

 private:
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    auto next = std::chrono::steady_clock::now();
    do {
      changed_.wait(lock, [this] { return ending_ || !lines_.empty(); });
      changed_.wait_until(lock, next, [this] { return ending_; });
      next = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
      const std::string lines = std::exchange(lines_, "");
      const std::size_t count = std::exchange(waiting_, 0);
      lock.unlock();
      file_ << lines << std::flush;
      const bool failed = !file_;
      file_.clear();
      lock.lock();
      if (failed) lost_ += count;
    } while (!ending_ || !lines_.empty());
  }

  static constexpr std::size_t kKept = std::size_t{8} << 20U;

  std::ofstream file_;  // used by the thread only
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string lines_;
  std::size_t waiting_ = 0;
  std::size_t lost_ = 0;
  std::chrono::steady_clock::time_point told_;
  bool ending_ = false;
  std::thread thread_;
};

/// A file with a line of JSON for each event. No file without a path.
class EventLog {
 public:
  explicit EventLog(const std::string& path = "") {
    if (!path.empty()) writer_ = std::make_unique<LineWriter>(path);
  }

  bool active() const { return writer_ != nullptr; }

  /// Adds the data of the next event.
  template <typename Value>
  void note(const Value& value) {
    data_ = ",\"data\":{\"value\":" + to_json(value) + '}';
  }

  /// Adds the reason of the next event, an error, after its data.
  void note_reason(const char* reason) {
    if (data_.empty()) {
      data_ = ",\"data\":{";
    } else {
      data_.back() = ',';
    }
    data_ += "\"reason\":" + to_json(reason) + '}';
  }

  void write(double time, const char* direction, const char* event) {
    if (!active()) return;
    writer_->write("{\"time\":" + to_json(time) + ",\"direction\":\"" + direction + "\",\"event\":" + to_json(event) +
                   std::exchange(data_, "") + "}\n");
  }

  /// The number of lost events not reported yet, once a second. Otherwise 0.
  std::size_t lost() { return active() ? writer_->lost() : 0; }

 private:
  std::unique_ptr<LineWriter> writer_;
  std::string data_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_EVENT_LOG_HPP_
