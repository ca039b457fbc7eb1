// Output of a node as JSON.
#ifndef ROBOSC_JSON_HPP_
#define ROBOSC_JSON_HPP_

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>

#include "robosc/data.hpp"
#include "robosc/version.hpp"

namespace robosc {
inline namespace ROBOSC_VERSION {

inline std::string to_json(bool value) { return value ? "true" : "false"; }

inline std::string to_json(Integer value) { return std::to_string(value.to<std::int64_t>()); }

/// The shortest text that parses to the same number. JSON has no number for infinity and NaN.
inline std::string to_json(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  for (int digits = 15; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  std::string number(text);
  const auto point = number.find(*std::localeconv()->decimal_point);
  if (point != std::string::npos) number[point] = '.';
  return number;
}

/// The length in bytes of the character of UTF-8 at `start`. 0 if there is none.
inline std::size_t character(const std::string& text, std::size_t start) {
  const auto byte = [&](std::size_t offset) {
    return start + offset < text.size() ? static_cast<unsigned char>(text[start + offset]) : 0U;
  };
  const unsigned first = byte(0), second = byte(1);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  // Reject overlong encodings, halves of surrogate pairs, and values past the last code point.
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90) ||
      (first == 0xF4 && second > 0x8F)) {
    return 0;
  }
  for (std::size_t offset = 1; offset < length; ++offset) {
    if ((byte(offset) & 0xC0) != 0x80) return 0;
  }
  return length;
}

/// The code point of a character that has `length` bytes of UTF-8.
inline std::uint32_t code_point(const std::string& text, std::size_t start, std::size_t length) {
  std::uint32_t code = static_cast<unsigned char>(text[start]) & (length == 1 ? 0x7FU : 0xFFU >> (length + 1));
  for (std::size_t offset = 1; offset < length; ++offset) {
    code = code << 6U | (static_cast<unsigned char>(text[start + offset]) & 0x3FU);
  }
  return code;
}

/// Whether a character breaks lines, reorders them, controls terminals, or is invisible: `HIDDEN` of
/// robosc/base/diagnostics/visible.py.
inline bool hidden(std::uint32_t code) {
  constexpr std::uint32_t ranges[][2] = {
      {0x0, 0x1F},      {0x7F, 0x9F},     {0xAD, 0xAD},     {0x34F, 0x34F},   {0x61C, 0x61C},   {0x115F, 0x1160},
      {0x17B4, 0x17B5}, {0x180B, 0x180F}, {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F}, {0x3164, 0x3164},
      {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF}, {0xFFA0, 0xFFA0}, {0xFFF0, 0xFFFB}, {0xFFFE, 0xFFFF}, {0xE0000, 0xE0FFF},
  };
  return std::any_of(std::begin(ranges), std::end(ranges),
                     [code](const auto& range) { return range[0] <= code && code <= range[1]; });
}

/// A character as an escape sequence, a surrogate pair if necessary.
inline std::string escaped(std::uint32_t code) {
  char text[16];
  if (code < 0x10000) {
    std::snprintf(text, sizeof text, "\\u%04x", static_cast<unsigned>(code));
  } else {
    const auto high = static_cast<unsigned>(0xD7C0 + (code >> 10U)),
               low = static_cast<unsigned>(0xDC00 + (code & 0x3FFU));
    std::snprintf(text, sizeof text, "\\u%04x\\u%04x", high, low);
  }
  return text;
}

/// Bytes that are not UTF-8 become the replacement character. The text never breaks a line.
inline std::string to_json(const std::string& value) {
  std::string text = "\"";
  for (std::size_t at = 0; at < value.size();) {
    const std::size_t length = character(value, at);
    const char byte = value[at];
    if (length == 0) {
      text += "\\ufffd";
    } else if (byte == '"' || byte == '\\') {
      text += {'\\', byte};
    } else if (const auto code = code_point(value, at, length); hidden(code)) {
      text += escaped(code);
    } else {
      text.append(value, at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return text + '"';
}

inline std::string to_json(const char* value) { return to_json(std::string(value)); }

/// Builder of an object or an array.
class Json {
 public:
  static Json object() { return Json('{', '}'); }
  static Json array() { return Json('[', ']'); }

  /// Adds a member to an object.
  template <typename Value>
  Json& add(const char* name, const Value& value) {
    separate();
    text_ += to_json(name) + ':' + to_json(value);
    return *this;
  }

  /// Adds an element to an array.
  template <typename Value>
  Json& add(const Value& value) {
    separate();
    text_ += to_json(value);
    return *this;
  }

  friend std::string to_json(const Json& value) { return value.text_ + value.end_; }

 private:
  Json(char begin, char end) : text_(1, begin), end_(end) {}

  void separate() {
    if (text_.size() > 1) text_ += ',';
  }

  std::string text_;
  char end_;
};

/// A list of the values of a function for each element of an array.
template <typename Array, typename Function>
Json json_list(const Array& array, Function shown) {
  Json list = Json::array();
  for (const auto& element : array) list.add(shown(element));
  return list;
}

/// Builder of an object whose members have paths such as `position.x`. Members of one object must follow each other.
class JsonTree {
 public:
  template <typename Value>
  void add(const std::string& path, const Value& value) {
    const std::size_t last = path.rfind('.');
    const std::string parent = last == std::string::npos ? "" : path.substr(0, last + 1);
    while (parent.compare(0, open_.size(), open_) != 0) {
      open_.erase(open_.rfind('.', open_.size() - 2) + 1);
      text_ += '}';
    }
    while (open_ != parent) {
      const std::size_t dot = parent.find('.', open_.size());
      text_ += member(parent.substr(open_.size(), dot - open_.size())) + '{';
      open_ = parent.substr(0, dot + 1);
    }
    text_ += member(path.substr(parent.size())) + to_json(value);
  }

  /// Adds the value of a function of array elements unless an element is missing.
  template <typename Function>
  void add_if_there(const std::string& path, Function function) {
    ArrayReader element;
    const auto value = function(element);
    if (element.complete()) add(path, value);
  }

  bool empty() const { return text_ == "{"; }

  friend std::string to_json(const JsonTree& tree) {
    const auto depth = std::count(tree.open_.begin(), tree.open_.end(), '.');
    return tree.text_ + std::string(static_cast<std::size_t>(depth) + 1, '}');
  }

 private:
  std::string member(const std::string& name) const { return (text_.back() == '{' ? "" : ",") + to_json(name) + ':'; }

  std::string text_ = "{";
  std::string open_;
};

}  // namespace ROBOSC_VERSION
}  // namespace robosc

#endif  // ROBOSC_JSON_HPP_
