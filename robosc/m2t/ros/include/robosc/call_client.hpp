// One service call, independent of the middleware.
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

/// The client of one service, with one call at a time. A derived class makes the call and reports its result.
///
/// All functions run sequentially, in the thread of the countdowns. `Countdown` calls a function once, a given time
/// after each start.
template <typename Countdown, typename ResponseType>
class CallClient {
 public:
  /// Exactly one handler follows each call. It never runs inside the call.
  struct Handlers {
    std::function<void(const ResponseType&)> response;
    std::function<void(Failure reason, const std::string& why)>
        error;  ///< No server, no response in time, or a failed call.
  };

  CallClient(const CallClient&) = delete;
  CallClient& operator=(const CallClient&) = delete;
  virtual ~CallClient() = default;

 protected:
  /// The missing part of a call, such as "no server", and the failure reason if it stays missing.
  struct Missing {
    Failure reason;
    std::string what;
  };

  /// `timeout`: from a call to its response, including the search for a server. `place`: first arguments of a
  /// countdown.
  template <typename... Place>
  CallClient(std::chrono::milliseconds timeout, Handlers handlers, Place&... place)
      : handlers_(std::move(handlers)),
        within_(" within " + std::to_string(timeout.count()) + " ms"),
        deadline_(place..., timeout, [this] {
          const Missing missed = missing();
          fail(number_, missed.reason, missed.what + within_);
        }) {}

  // Functions that the middleware implements.

  /// Forgets the current call, if there is one.
  virtual void forget() = 0;
  /// The part of the call that is still missing.
  virtual Missing missing() = 0;

  // Functions that the derived class calls.

  /// Begins a call and returns its number. Gives up an earlier call that has not ended.
  std::uint64_t begin() {
    stop();
    waiting_ = true;
    deadline_.start();
    return ++number_;
  }

  /// Gives up the current call. No handler follows.
  void stop() {
    waiting_ = false;
    deadline_.stop();
    forget();
  }

  /// Reports the response of the call with this number. A late response is ignored.
  void succeed(std::uint64_t number, const ResponseType& response) {
    if (ends(number)) handlers_.response(response);
  }

  /// Reports the failure of the call with this number.
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
