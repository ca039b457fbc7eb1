// Headers of messages that the node fills in.
#ifndef ROBOSC_MESSAGE_HEADERS_HPP_
#define ROBOSC_MESSAGE_HEADERS_HPP_

#include <string>
#include <type_traits>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Part, typename = void>
struct has_header : std::false_type {};
template <typename Part>
struct has_header<Part, std::void_t<decltype(std::declval<Part&>().header.stamp)>> : std::true_type {};

/// Sets the time and the frame in the headers of parts of a message. Skips parts without a header.
template <typename Time, typename... Parts>
void set_headers(const Time& time, const std::string& frame, Parts&... parts) {
  const auto set = [&](auto& part) {
    if constexpr (has_header<std::decay_t<decltype(part)>>::value) {
      part.header.stamp = time;
      part.header.frame_id = frame;
    }
  };
  (set(parts), ...);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_MESSAGE_HEADERS_HPP_
