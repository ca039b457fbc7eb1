// The default number of queued messages.
#ifndef ROBOSC_QUEUE_DEPTH_HPP_
#define ROBOSC_QUEUE_DEPTH_HPP_

#include <cstdint>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// `QUEUE_DEPTH` of robosc/model/semantics/communication.py.
inline constexpr std::uint32_t kQueueDepth = 10;

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_QUEUE_DEPTH_HPP_
