// Reasons for failed services and actions.
#ifndef ROBOSC_FAILURE_HPP_
#define ROBOSC_FAILURE_HPP_

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The values of the predefined enum `Failure` of the language.
enum class Failure { rejected, lost, aborted, canceled, unavailable, timeout, unreadable, failed };

inline const char* failure_name(Failure reason) {
  switch (reason) {
    case Failure::rejected:
      return "rejected";
    case Failure::lost:
      return "lost";
    case Failure::aborted:
      return "aborted";
    case Failure::canceled:
      return "canceled";
    case Failure::unavailable:
      return "unavailable";
    case Failure::timeout:
      return "timeout";
    case Failure::unreadable:
      return "unreadable";
    case Failure::failed:
      break;
  }
  return "failed";
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_FAILURE_HPP_
