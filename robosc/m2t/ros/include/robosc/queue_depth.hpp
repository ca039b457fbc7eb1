// How many messages wait where the configuration says nothing.
#ifndef ROBOSC_QUEUE_DEPTH_HPP_
#define ROBOSC_QUEUE_DEPTH_HPP_

#include <cstdint>

namespace robosc {
inline namespace v1 {

/// `QUEUE_DEPTH` of robosc/semantics/communication.py.
inline constexpr std::uint32_t kQueueDepth = 10;

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_QUEUE_DEPTH_HPP_
