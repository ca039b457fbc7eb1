// How data of the model and data of ROS become each other.
#ifndef ROBOSC_DATA_HPP_
#define ROBOSC_DATA_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace robosc {
inline namespace v1 {

/// A whole number of the model. Where a result does not fit, it is the nearest number that does.
class Integer {
 public:
  template <typename Number, typename = std::enable_if_t<std::is_integral_v<Number>>>
  constexpr Integer(Number value)  // NOLINT: numbers of ROS are numbers of the model
      : value_(fits(value) ? static_cast<std::int64_t>(value) : most) {}

  /// The nearest number between two bounds.
  constexpr Integer within(std::int64_t low, std::int64_t high) const { return std::clamp(value_, low, high); }

  /// The nearest number that a field can hold.
  template <typename Field>
  constexpr Field to() const {
    if (value_ < 0 && std::is_unsigned_v<Field>) return 0;
    if (value_ > 0 &&
        static_cast<std::uint64_t>(value_) > static_cast<std::uint64_t>(std::numeric_limits<Field>::max())) {
      return std::numeric_limits<Field>::max();
    }
    if (value_ < 0 && value_ < static_cast<std::int64_t>(std::numeric_limits<Field>::min())) {
      return std::numeric_limits<Field>::min();
    }
    return static_cast<Field>(value_);
  }

  explicit constexpr operator double() const { return static_cast<double>(value_); }

  friend Integer operator+(Integer a, Integer b) {
    if (b.value_ > 0 && a.value_ > most - b.value_) return most;
    if (b.value_ < 0 && a.value_ < least - b.value_) return least;
    return a.value_ + b.value_;
  }
  friend Integer operator-(Integer a, Integer b) {
    if (b.value_ < 0 && a.value_ > most + b.value_) return most;
    if (b.value_ > 0 && a.value_ < least + b.value_) return least;
    return a.value_ - b.value_;
  }
  friend Integer operator*(Integer a, Integer b) {
    if (a.value_ == 0 || b.value_ == 0) return 0;
    if ((a.value_ < 0) == (b.value_ < 0)) {
      if (a.value_ > 0 ? a.value_ > most / b.value_ : a.value_ < most / b.value_) return most;
    } else {
      if (a.value_ > 0 ? b.value_ < least / a.value_ : a.value_ < least / b.value_) return least;
    }
    return a.value_ * b.value_;
  }
  /// The remainder of a division by a positive number, which is never negative.
  friend Integer mod(Integer a, Integer b) {
    const std::int64_t remainder = a.value_ % b.value_;
    return remainder < 0 ? remainder + b.value_ : remainder;
  }
  friend Integer operator-(Integer a) { return Integer(0) - a; }
  friend constexpr bool operator==(Integer a, Integer b) { return a.value_ == b.value_; }
  friend constexpr bool operator!=(Integer a, Integer b) { return a.value_ != b.value_; }
  friend constexpr bool operator<(Integer a, Integer b) { return a.value_ < b.value_; }
  friend constexpr bool operator<=(Integer a, Integer b) { return a.value_ <= b.value_; }
  friend constexpr bool operator>(Integer a, Integer b) { return a.value_ > b.value_; }
  friend constexpr bool operator>=(Integer a, Integer b) { return a.value_ >= b.value_; }

 private:
  static constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();

  template <typename Number>
  static constexpr bool fits(Number value) {
    return value <= 0 || static_cast<std::uint64_t>(value) <= static_cast<std::uint64_t>(most);
  }

  std::int64_t value_;
};

/// Whether two numbers differ; false where one of them is no number, as for every comparison.
inline bool differ(double a, double b) { return a < b || a > b; }

/// Reads elements of arrays, and remembers the first one that was not there.
class ArrayReader {
 public:
  template <typename Array>
  typename Array::const_reference at(const Array& array, std::size_t index) {
    if (index < array.size()) return array[index];
    if (complete_) {
      complete_ = false;
      index_ = index;
      length_ = array.size();
    }
    static const typename Array::value_type nothing{};
    return nothing;
  }

  /// Whether all elements were there.
  bool complete() const { return complete_; }

  /// What was not there.
  std::string fault() const {
    return "there is no element " + std::to_string(index_) + " in an array of " + std::to_string(length_);
  }

 private:
  bool complete_ = true;
  std::size_t index_ = 0;
  std::size_t length_ = 0;
};

}  // namespace v1
}  // namespace robosc

#endif  // ROBOSC_DATA_HPP_
