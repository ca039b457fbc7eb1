// Conversion of data of the model into messages.
#ifndef ROBOSC_FIELDS_HPP_
#define ROBOSC_FIELDS_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <type_traits>

#include "robosc/data.hpp"
#include "robosc/json.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

template <typename Data, typename = void>
inline constexpr bool is_array_v = false;
template <typename Data>
inline constexpr bool is_array_v<Data, std::void_t<typename Data::const_iterator>> = true;

/// Tag for message types of ROS. `robosc_ros1/finite.hpp` and `robosc_ros2/finite.hpp` define `finite` for them.
struct OfRos {};

/// Whether a message, or an array of messages, contains finite numbers only.
template <typename Data>
bool all_finite(const Data& data) {
  if constexpr (is_array_v<Data>) {
    return std::all_of(data.begin(), data.end(), [](const auto& element) { return finite(element, OfRos{}); });
  } else {
    return finite(data, OfRos{});
  }
}

/// Fills the fields of a message and records the first one whose value is not a finite number.
class FieldWriter {
 public:
  /// `noted`: whether to record the fields as JSON, too.
  explicit FieldWriter(bool noted) : noted_(noted) {}

  /// Sets the elements of an array. An array of fixed length keeps its remaining elements.
  template <typename Array, typename Values>
  void set_elements(const char* path, Array& array, const Values& values) {
    reserve(array, values.size(), 0);
    Json list = Json::array();
    auto field = array.begin();
    for (auto value = values.begin(); value != values.end() && field != array.end(); ++value, ++field) {
      using Element = std::decay_t<decltype(*value)>;
      if constexpr (std::is_floating_point_v<Element>) {
        fill(path, *field, static_cast<double>(*value));
        list.add(number(*field));
      } else if constexpr (std::is_same_v<Element, Integer> ||
                           (std::is_integral_v<Element> && !std::is_same_v<Element, bool>)) {
        fill(path, *field, Integer(*value));
        list.add(number(*field));
      } else {
        *field = *value;
        list.add(static_cast<const Element&>(*value));
      }
    }
    note(path, list);
  }

  /// Sets a field, or the whole data if the path is empty, to received data. Records no JSON.
  template <typename Field, typename Data>
  void hand_on(const char* path, Field& field, const Data& data) {
    store(field, data);
    if (!all_finite(field) && fault_ == nullptr) fault_ = *path == '\0' ? "data" : path;
    const std::string inside = *path == '\0' ? "" : std::string(path) + '.';
    auto noted = fields_.lower_bound(inside);
    while (noted != fields_.end() && noted->first.compare(0, inside.size(), inside) == 0) noted = fields_.erase(noted);
  }

  template <typename Field, typename Value>
  void set(const char* path, Field& field, const Value& value) {
    if constexpr (std::is_same_v<Value, Integer> || std::is_floating_point_v<Value>) {
      fill(path, field, value);
      if constexpr (std::is_floating_point_v<Field>) {
        note(path, static_cast<double>(field));
      } else {
        note(path, Integer(field));
      }
    } else {
      field = value;
      note(path, value);
    }
  }

  /// Requires a value of the message to be finite.
  template <typename Value>
  void require(const char* path, const Value& value) {
    check(path, static_cast<double>(value));
  }

  /// The path of the first field whose value is not finite. Null if there is none.
  const char* fault() const { return fault_; }

  /// The recorded fields as in the message. For basic data, the value itself.
  friend std::string to_json(const FieldWriter& writer) {
    const auto first = writer.fields_.find("data");
    if (writer.fields_.size() == 1 && first != writer.fields_.end()) return first->second.json;
    JsonTree tree;
    for (const auto& [path, noted] : writer.fields_) tree.add(path, noted);
    return to_json(tree);
  }

 private:
  template <typename Number>
  static auto number(Number value) {
    if constexpr (std::is_floating_point_v<Number>) {
      return static_cast<double>(value);
    } else {
      return Integer(value);
    }
  }

  template <typename Array>
  static auto reserve(Array& array, std::size_t size, int) -> decltype(array.resize(size)) {
    array.resize(std::min(size, array.max_size()));
  }
  template <typename Array>
  static void reserve(Array&, std::size_t, long) {}

  template <typename Field>
  void fill(const char* path, Field& field, Integer value) {
    if constexpr (std::is_integral_v<Field>) {
      field = value.to<Field>();
    } else {
      fill(path, field, static_cast<double>(value));
    }
  }

  template <typename Field>
  void fill(const char* path, Field& field, double value) {
    if constexpr (std::is_floating_point_v<Field>) {
      field = static_cast<Field>(value);
      check(path, static_cast<double>(field));
    } else if (check(path, value)) {
      // A double may not represent the largest number of a field: compare with the next power of two.
      const double end = std::ldexp(1.0, std::numeric_limits<Field>::digits);
      const double least = static_cast<double>(std::numeric_limits<Field>::min());
      field = value >= end     ? std::numeric_limits<Field>::max()
              : value <= least ? std::numeric_limits<Field>::min()
                               : static_cast<Field>(value);
    }
  }

  bool check(const char* path, double value) {
    const bool finite = std::isfinite(value);
    if (!finite && fault_ == nullptr) fault_ = path;
    return finite;
  }

  template <typename Value>
  void note(const char* path, const Value& value) {
    if (noted_) fields_[path] = {to_json(value)};
  }

  /// JSON of a field.
  struct Noted {
    std::string json;
    friend std::string to_json(const Noted& noted) { return noted.json; }
  };

  bool noted_;
  const char* fault_ = nullptr;
  std::map<std::string, Noted> fields_;  // By path. So those of one object are together.
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_FIELDS_HPP_
