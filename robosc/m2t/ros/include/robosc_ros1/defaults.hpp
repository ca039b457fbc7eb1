// What a message says where the model says nothing.
#ifndef ROBOSC_ROS1_DEFAULTS_HPP_
#define ROBOSC_ROS1_DEFAULTS_HPP_

#include <string>
#include <type_traits>
#include <utility>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Part, typename = void>
struct has_w : std::false_type {};
template <typename Part>
struct has_w<Part, std::void_t<decltype(std::declval<Part&>().w)>> : std::true_type {};

/// Visits a message as a stream does that writes it, and makes each quaternion on the way one of length 1.
struct UnitQuaternions {
  template <typename Part>
  void next([[maybe_unused]] Part& part) {
    if constexpr (ros::message_traits::IsMessage<Part>::value) {
      if constexpr (has_w<Part>::value) {
        if (std::string(ros::message_traits::DataType<Part>::value()) == "geometry_msgs/Quaternion") part.w = 1.0;
      }
      ros::serialization::Serializer<Part>::template allInOne<UnitQuaternions, Part&>(*this, part);
    }
  }
};

template <typename Part, typename = void>
struct has_header : std::false_type {};
template <typename Part>
struct has_header<Part, std::void_t<decltype(std::declval<Part&>().header.stamp)>> : std::true_type {};

template <typename Part>
void set_header([[maybe_unused]] const ros::Time& time, [[maybe_unused]] const std::string& frame,
                [[maybe_unused]] Part& part) {
  if constexpr (has_header<Part>::value) {
    part.header.stamp = time;
    part.header.frame_id = frame;
  }
}

/// Gives every quaternion of a message no rotation, and the headers of parts of it, where they have one, time and
/// frame.
template <typename Message, typename... Parts>
void set_defaults(Message& message, [[maybe_unused]] const ros::Time& time, [[maybe_unused]] const std::string& frame,
                  Parts&... parts) {
  UnitQuaternions().next(message);
  (set_header(time, frame, parts), ...);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_DEFAULTS_HPP_
