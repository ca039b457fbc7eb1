// A call of a service from its start to its one end, without middleware.
#ifndef ROBOSC_CALL_CLIENT_HPP_
#define ROBOSC_CALL_CLIENT_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "robosc/failure.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The client of one service, with one call at a time. A derived class makes the call and says what comes of it.
///
/// Everything runs where the countdowns run, one call after the other. `Countdown` calls a function once, some time
/// after each start.
template <typename Countdown, typename ResponseType>
class CallClient {
 public:
  /// Exactly one of them follows a call, never from inside it.
  struct Handlers {
    std::function<void(const ResponseType&)> response;
    std::function<void(Failure reason, const std::string& why)>
        error;  ///< No server, no answer in time, a failed call.
  };

  CallClient(const CallClient&) = delete;
  CallClient& operator=(const CallClient&) = delete;
  virtual ~CallClient() = default;

 protected:
  /// What a call waits for, as "no server", and why it has failed where that does not come.
  struct Missing {
    Failure reason;
    std::string what;
  };

  /// `timeout`: from a call to its answer; the server, too, may appear in this time. `place`: what a countdown begins
  /// with.
  template <typename... Place>
  CallClient(std::chrono::milliseconds timeout, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        deadline_(place..., timeout, [this] {
          const Missing missed = missing();
          fail(number_, missed.reason, missed.what + within_);
        }) {}

  // What the middleware does.

  /// Forgets the call that is under way, if there is one.
  virtual void forget() = 0;
  /// What the call still waits for.
  virtual Missing missing() = 0;

  // What comes of it.

  /// Begins a call; its number. One that is still under way is given up.
  std::uint64_t begin() {
    stop();
    waiting_ = true;
    deadline_.start();
    return ++number_;
  }

  /// Gives up the call that is under way: nothing follows it.
  void stop() {
    waiting_ = false;
    deadline_.stop();
    forget();
  }

  /// The call of this number was answered. What comes late belongs to no call any more.
  void succeed(std::uint64_t number, const ResponseType& response) {
    if (ends(number)) handlers_.response(response);
  }

  /// It was not.
  void fail(std::uint64_t number, Failure reason, const std::string& why) {
    if (ends(number)) handlers_.error(reason, why);
  }

 private:
  bool ends(std::uint64_t number) {
    if (!waiting_ || number != number_) return false;
    stop();
    return true;
  }

  const Handlers handlers_;
  const std::string within_;
  bool waiting_ = false;
  std::uint64_t number_ = 0;
  Countdown deadline_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALL_CLIENT_HPP_
