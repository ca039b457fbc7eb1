// Why a service or an action has failed.
#ifndef ROBOSC_FAILURE_HPP_
#define ROBOSC_FAILURE_HPP_

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// The values of the predefined enum `Failure` of the language.
enum class Failure { unavailable, rejected, timeout, lost, aborted, canceled, failed, unreadable };

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_FAILURE_HPP_
