// Conversion between data of the model and data of ROS.
#ifndef ROBOSC_DATA_HPP_
#define ROBOSC_DATA_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

/// A whole number of the model. Results saturate at the nearest number that fits.
class Integer {
 public:
  template <typename Number, typename = std::enable_if_t<std::is_integral_v<Number>>>
  constexpr Integer(Number value)  // NOLINT: numbers of ROS convert implicitly to numbers of the model
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
  /// The remainder of a division by a positive number. Never negative.
  friend Integer mod(Integer a, Integer b) {
    const std::int64_t remainder = a.value_ % b.value_;
    return remainder < 0 ? remainder + b.value_ : remainder;
  }
  friend Integer operator-(Integer a) { return Integer(0) - a; }
  friend Integer magnitude(Integer a) { return a.value_ < 0 ? -a : a; }
  friend Integer smaller(Integer a, Integer b) { return b < a ? b : a; }
  friend Integer larger(Integer a, Integer b) { return b > a ? b : a; }
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

/// Whether two numbers differ. False if one of them is NaN, as for each comparison.
inline bool differ(double a, double b) { return a < b || a > b; }

inline double magnitude(double a) { return std::fabs(a); }
/// The smaller or larger of two numbers. If one is NaN, the other one.
inline double smaller(double a, double b) { return b < a || std::isnan(a) ? b : a; }
inline double larger(double a, double b) { return b > a || std::isnan(a) ? b : a; }

/// A duration in milliseconds. `value` counts units of `unit` milliseconds.
inline std::uint32_t duration_ms(double value, double unit) {
  return static_cast<std::uint32_t>(std::floor(value * unit + 0.5));
}

/// The number of characters of a text in UTF-8.
inline Integer size_of(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
}

/// A range of an array's elements.
template <typename Iterator>
class Slice {
 public:
  using const_iterator = Iterator;
  using const_reference = typename std::iterator_traits<Iterator>::reference;
  using value_type = typename std::iterator_traits<Iterator>::value_type;

  Slice(Iterator begin, Iterator end) : begin_(begin), end_(end) {}

  Iterator begin() const { return begin_; }
  Iterator end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(std::distance(begin_, end_)); }
  const_reference operator[](std::size_t index) const { return *std::next(begin_, static_cast<std::ptrdiff_t>(index)); }

 private:
  Iterator begin_, end_;
};

/// The number of elements of an array.
template <typename Array>
Integer size_of(const Array& array) {
  return array.size();
}

/// Whether a condition holds for all elements of an array, or for any. Evaluates from left to right until the result is
/// certain.
template <typename Array, typename Condition>
bool for_all(const Array& array, Condition holds) {
  for (const auto& element : array) {
    if (!holds(element)) return false;
  }
  return true;
}
template <typename Array, typename Condition>
bool for_any(const Array& array, Condition holds) {
  return !for_all(array, [&](const auto& element) { return !holds(element); });
}

/// The number of elements of an array for which a condition holds.
template <typename Array, typename Condition>
Integer number_of(const Array& array, Condition holds) {
  std::int64_t count = 0;
  for (const auto& element : array) count += holds(element) ? 1 : 0;
  return count;
}

/// Assigns data, element by element if the types of the arrays differ.
template <typename Kept, typename Data>
void store(Kept& kept, const Data& data) {
  if constexpr (std::is_assignable_v<Kept&, const Data&>) {
    kept = data;
  } else {
    Kept made;
    for (const auto& element : data) made.push_back(static_cast<typename Kept::value_type>(element));
    kept = std::move(made);
  }
}

/// Reads elements of arrays, rounds numbers, and records the first failure.
class ArrayReader {
 public:
  Integer floor(double number) { return whole(std::floor(number)); }
  Integer ceil(double number) { return whole(std::ceil(number)); }
  Integer round(double number) { return whole(std::round(number)); }

  template <typename Array>
  typename Array::const_reference at(const Array& array, Integer position) {
    const auto index = position.to<std::int64_t>();
    if (index >= 0 && position < array.size()) return array[static_cast<std::size_t>(index)];
    fail("there is no element " + std::to_string(index) + " in an array of " + std::to_string(array.size()));
    static const typename Array::value_type nothing{};
    return nothing;
  }

  /// The elements from `first` to `last`, both included. Empty if `last` is less than `first`.
  template <typename Array>
  Slice<typename Array::const_iterator> slice(const Array& array, Integer first, Integer last) {
    const auto from = first.to<std::int64_t>(), to = last.to<std::int64_t>();
    if (last < first) return {array.begin(), array.begin()};
    if (from >= 0 && last < array.size()) {
      const auto begin = std::next(array.begin(), static_cast<std::ptrdiff_t>(from));
      return {begin, std::next(begin, static_cast<std::ptrdiff_t>(to - from + 1))};
    }
    fail("there are no elements " + std::to_string(from) + " to " + std::to_string(to) + " in an array of " +
         std::to_string(array.size()));
    return {array.begin(), array.begin()};
  }

  /// The number at a path, if it is at least `low` and at most `high`.
  Integer within(const char* path, Integer number, std::int64_t low, std::int64_t high) {
    if (number < low || high < number) {
      fail("its " + std::string(path) + " is " + std::to_string(number.to<std::int64_t>()) + ", expected " +
           std::to_string(low) + " to " + std::to_string(high));
    }
    return number.within(low, high);
  }

  template <typename Number, typename Array>
  Number least(const Array& array) {
    return first_of<Number>(array, [](Number a, Number b) { return a < b; });
  }
  template <typename Number, typename Array>
  Number greatest(const Array& array) {
    return first_of<Number>(array, [](Number a, Number b) { return a > b; });
  }

  /// Whether all reads succeeded.
  bool complete() const { return fault_.empty(); }

  /// The first failure.
  const std::string& fault() const { return fault_; }

 private:
  /// The first number in the order `before`. Skips NaN.
  template <typename Number, typename Array, typename Before>
  Number first_of(const Array& array, Before before) {
    Number found = 0;
    bool any = false;
    for (const auto& element : array) {
      const auto number = static_cast<Number>(element);
      if (!is_nan(number) && (!any || before(number, found))) {
        found = number;
        any = true;
      }
    }
    if (!any) fail("there is no number in an array of " + std::to_string(array.size()));
    return found;
  }

  static bool is_nan(double number) { return std::isnan(number); }
  static bool is_nan(const Integer& /*number*/) { return false; }

  Integer whole(double number) {
    if (std::isnan(number)) fail("NaN cannot be rounded");
    constexpr double least = std::numeric_limits<std::int32_t>::min(), most = std::numeric_limits<std::int32_t>::max();
    return std::isnan(number) ? 0 : static_cast<std::int32_t>(std::clamp(number, least, most));
  }

  void fail(const std::string& why) {
    if (complete()) fault_ = why;
  }

  std::string fault_;
};

/// The value that `read` returns, or `unread` after a failed read.
template <typename Value, typename Read>
Value read_or(Value unread, Read read) {
  ArrayReader reader;
  const Value value = read(reader);
  return reader.complete() ? value : unread;
}

/// Stores the value that `read` returns unless a read failed.
template <typename Kept, typename Read>
void store_if_readable(Kept& kept, Read read) {
  ArrayReader reader;
  const auto value = read(reader);
  if (reader.complete()) store(kept, value);
}

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_DATA_HPP_
