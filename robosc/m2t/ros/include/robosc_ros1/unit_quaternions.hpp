// Quaternions of messages that the node fills in.
#ifndef ROBOSC_ROS1_UNIT_QUATERNIONS_HPP_
#define ROBOSC_ROS1_UNIT_QUATERNIONS_HPP_

#include <string>
#include <type_traits>
#include <utility>

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Part, typename = void>
struct has_w : std::false_type {};
template <typename Part>
struct has_w<Part, std::void_t<decltype(std::declval<Part&>().w)>> : std::true_type {};

/// Visits a message as a serializing stream does, and sets each quaternion to length 1.
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

/// Sets each quaternion of a message to no rotation.
template <typename Message>
void set_unit_quaternions(Message& message) {
  UnitQuaternions().next(message);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_UNIT_QUATERNIONS_HPP_
