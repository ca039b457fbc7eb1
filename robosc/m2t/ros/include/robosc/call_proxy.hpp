// A call of a service that is handed on, from its start to its one end, without middleware.
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

/// What stands between a controller and the robot's service. One call waits at a time; another one is turned away until
/// that is answered. `Caller` is who waits for an answer.
template <typename Caller, typename RequestType, typename ResponseType>
class CallProxy {
 public:
  /// What the supervisor has to say and to hear. Nothing is called from inside of anything else here.
  struct Handlers {
    std::function<bool(const RequestType&)> call;       ///< Whether a call goes on.
    std::function<void()> busy;                         ///< A call is turned away because another one waits.
    std::function<void(const ResponseType&)> response;  ///< The robot has answered.
    std::function<void(Failure reason, const std::string& why)> error;  ///< It has not.
  };

  CallProxy(const CallProxy&) = delete;
  CallProxy& operator=(const CallProxy&) = delete;
  virtual ~CallProxy() = default;

 protected:
  explicit CallProxy(Handlers handlers) : handlers_(std::move(handlers)) {}

  /// Calls the robot's service.
  virtual void forward(const RequestType& request) = 0;
  /// Answers who waits; nothing: the call is blocked, or has no answer.
  virtual void answer(const Caller& caller, const std::optional<ResponseType>& response) = 0;

  /// The controller has called.
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

  /// What the client of the robot's service is made with.
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
