// Test for finite numbers in a message that is forwarded unchanged.
#ifndef ROBOSC_ROS1_FINITE_HPP_
#define ROBOSC_ROS1_FINITE_HPP_

#include <cmath>
#include <type_traits>

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include "robosc/fields.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// Visits a message as a serializing stream does.
struct FiniteNumbers {
  bool found = true;

  template <typename Part>
  void next([[maybe_unused]] const Part& part) {
    if constexpr (std::is_floating_point_v<Part>) {
      found = found && std::isfinite(part);
    } else if constexpr (ros::message_traits::IsMessage<Part>::value) {
      ros::serialization::Serializer<Part>::template allInOne<FiniteNumbers, const Part&>(*this, part);
    } else if constexpr (is_array_v<Part>) {
      for (const auto& element : part) next(element);
    }
  }
};

template <typename Message>
bool finite(const Message& message, OfRos) {
  FiniteNumbers numbers;
  numbers.next(message);
  return numbers.found;
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS1_FINITE_HPP_
