// One forwarded service call, independent of the middleware.
#ifndef ROBOSC_CALL_PROXY_HPP_
#define ROBOSC_CALL_PROXY_HPP_

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "robosc/failure.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The part of a layer between a controller and the robot's service. One call is forwarded at a time. Further calls are
/// turned away until it is answered. `Caller` identifies the client to answer.
template <typename Caller, typename RequestType, typename ResponseType>
class CallProxy {
 public:
  /// Decisions and notifications of the supervisor. A handler never runs inside another function of this class.
  struct Handlers {
    std::function<bool(const RequestType&)> call;       ///< Returns whether to forward a call.
    std::function<void()> busy;                         ///< A call was turned away because another one waits.
    std::function<void(const ResponseType&)> response;  ///< The robot has answered.
    std::function<void(Failure reason, const std::string& why)> error;  ///< The call has failed.
  };

  CallProxy(const CallProxy&) = delete;
  CallProxy& operator=(const CallProxy&) = delete;
  virtual ~CallProxy() = default;

 protected:
  explicit CallProxy(Handlers handlers) : handlers_(std::move(handlers)) {}

  /// Calls the robot's service.
  virtual void forward(const RequestType& request) = 0;
  /// Answers the waiting client. No response: the call is blocked or has failed.
  virtual void answer(const Caller& caller, const std::optional<ResponseType>& response) = 0;

  /// Handles a call of the controller.
  void called(const Caller& caller, const RequestType& request) {
    if (waiting_) {
      handlers_.busy();
      answer(caller, std::nullopt);
    } else if (!handlers_.call(request)) {
      answer(caller, std::nullopt);
    } else {
      waiting_ = caller;
      forward(request);
    }
  }

  /// The handlers for the client of the robot's service.
  template <typename ClientHandlers>
  ClientHandlers answers() {
    return {
        [this](const ResponseType& response) {
          handlers_.response(response);
          finish(response);
        },
        [this](Failure reason, const std::string& why) {
          handlers_.error(reason, why);
          finish(std::nullopt);
        },
    };
  }

 private:
  void finish(const std::optional<ResponseType>& response) {
    const Caller caller = *std::exchange(waiting_, std::nullopt);
    answer(caller, response);
  }

  const Handlers handlers_;
  std::optional<Caller> waiting_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_CALL_PROXY_HPP_
