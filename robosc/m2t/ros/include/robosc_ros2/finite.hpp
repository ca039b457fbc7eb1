// Test for finite numbers in a message that is forwarded unchanged.
#ifndef ROBOSC_ROS2_FINITE_HPP_
#define ROBOSC_ROS2_FINITE_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <rosidl_runtime_c/message_type_support_struct.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <rosidl_typesupport_introspection_cpp/field_types.hpp>
#include <rosidl_typesupport_introspection_cpp/identifier.hpp>
#include <rosidl_typesupport_introspection_cpp/message_introspection.hpp>

#include "robosc/fields.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

inline bool finite(const void* message, const rosidl_message_type_support_t* type) {
  namespace kinds = rosidl_typesupport_introspection_cpp;
  const auto* fields = static_cast<const kinds::MessageMembers*>(type->data);
  return std::all_of(fields->members_, fields->members_ + fields->member_count_, [message](const auto& field) {
    const auto holds = [&field](const void* value) {
      switch (field.type_id_) {
        case kinds::ROS_TYPE_FLOAT:
          return std::isfinite(*static_cast<const float*>(value));
        case kinds::ROS_TYPE_DOUBLE:
          return std::isfinite(*static_cast<const double*>(value));
        case kinds::ROS_TYPE_MESSAGE:
          return finite(value, field.members_);
        default:
          return true;
      }
    };
    const void* value = static_cast<const char*>(message) + field.offset_;
    if (!field.is_array_ || field.type_id_ == kinds::ROS_TYPE_BOOLEAN) return holds(value);
    const std::size_t size = field.size_function(value);
    for (std::size_t index = 0; index < size; ++index) {
      if (!holds(field.get_const_function(value, index))) return false;
    }
    return true;
  });
}

template <typename Message>
bool finite(const Message& message, OfRos) {
  const auto* type = rosidl_typesupport_cpp::get_message_type_support_handle<Message>();
  return finite(&message,
                get_message_typesupport_handle(type, rosidl_typesupport_introspection_cpp::typesupport_identifier));
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_ROS2_FINITE_HPP_
