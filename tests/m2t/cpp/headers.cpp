// Checks of the headers that come with every node. Prints what does not hold; the exit status says how much that is.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "checks.hpp"
#include "robosc/data.hpp"
#include "robosc/event_log.hpp"
#include "robosc/fields.hpp"
#include "robosc/json.hpp"

namespace {

using namespace robosc;

constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
constexpr auto kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr auto kInfinity = std::numeric_limits<double>::infinity();

void whole_numbers_saturate() {
  CHECK(Integer(~std::uint64_t{0}) == kMost);
  CHECK(Integer(std::uint8_t{200}) == 200);
  CHECK(Integer(kMost) + 1 == kMost);
  CHECK(Integer(kLeast) + -1 == kLeast);
  CHECK(Integer(kLeast) - 1 == kLeast);
  CHECK(Integer(0) - Integer(kLeast) == kMost);
  CHECK(-Integer(kLeast) == kMost);
  CHECK(Integer(kMost) * -2 == kLeast);
  CHECK(Integer(kLeast) * -1 == kMost);
  CHECK(Integer(kLeast) * 1 == kLeast && Integer(kLeast / 2) * 2 == kLeast && Integer(2) * (kLeast / 2) == kLeast);
  CHECK(Integer(kLeast) * kLeast == kMost && Integer(kMost) * kLeast == kLeast && Integer(kMost) * 0 == 0);
  CHECK(Integer(3037000499) * 3037000499 == 9223372030926249001 && Integer(3037000500) * 3037000500 == kMost);
  CHECK(Integer(kMost) + -1 == kMost - 1 && Integer(kLeast) - -1 == kLeast + 1 && Integer(-1) - kMost == kLeast);
  CHECK(Integer(-5) + 3 < 0 && Integer(-5) * -5 == 25 && Integer(1u) > Integer(-1));
  CHECK(Integer(7).within(-3, 5) == 5 && Integer(-7).within(-3, 5) == -3 && Integer(4).within(-3, 5) == 4);
  CHECK(Integer(300).to<std::uint8_t>() == 255 && Integer(-1).to<std::uint8_t>() == 0);
  CHECK(Integer(-40000).to<std::int16_t>() == -32768 && Integer(kMost).to<std::uint64_t>() == 9223372036854775807u);
  CHECK(static_cast<double>(Integer(-3)) == -3.0);
}

void logs_are_named_by_their_nodes() {
  setenv("ROS_LOG_DIR", "/tmp", 1);
  CHECK(default_log("/base", "base") == "/tmp/base-events.jsonl");
  CHECK(default_log("/hall/left/base", "base") == "/tmp/hall.left.base-events.jsonl");
  CHECK(default_log("/left/wheels", "base") == "/tmp/left.wheels.base-events.jsonl");
}

void comparisons_with_nan_are_false() {
  CHECK(!differ(kNaN, 1.0) && !differ(1.0, kNaN) && !differ(kNaN, kNaN));
  CHECK(differ(1.0, 2.0) && !differ(2.0, 2.0) && differ(-kInfinity, kInfinity));
}

void elements_that_are_not_there_are_noticed() {
  const std::vector<float> ranges = {1.5F, 2.5F};
  const std::vector<bool> flags = {true};
  const std::array<std::string, 1> names = {"one"};
  ArrayReader read;
  CHECK(read.at(ranges, 1) == 2.5F && read.at(flags, 0) && read.at(names, 0) == "one" && read.complete());
  read.at(ranges, 4);
  read.at(names, 7);
  CHECK(!read.complete() && read.fault() == "there is no element 4 in an array of 2");
  JsonTree tree;
  tree.add_if_there("ranges.4", [&](ArrayReader& element) { return double(element.at(ranges, 4)); });
  CHECK(tree.empty());
  tree.add_if_there("ranges.0", [&](ArrayReader& element) { return double(element.at(ranges, 0)); });
  CHECK(!tree.empty() && to_json(tree) == "{\"ranges\":{\"0\":1.5}}");
  ArrayReader lazy;
  CHECK((read.at(ranges, 0) > 1.0F || lazy.at(ranges, 9) > 1.0F) && lazy.complete());
}

void fields_take_what_fits() {
  std::uint8_t byte = 1;
  std::int64_t large = 1;
  std::uint64_t larger = 1;
  float single = 1;
  double whole = 1;
  bool flag = false;
  std::string text;
  FieldWriter write(false);
  write.set("byte", byte, Integer(-4));
  write.set("flag", flag, true);
  write.set("text", text, std::string("x"));
  write.set("whole", whole, Integer(7));
  CHECK(byte == 0 && flag && text == "x" && whole == 7.0);
  write.set("large", large, 1e300);
  write.set("larger", larger, -0.5);
  write.set("byte", byte, 99.9);
  CHECK(large == kMost && larger == 0 && byte == 99 && write.fault() == nullptr);
  write.set("larger", larger, 18446744073709551616.0);
  write.set("single", single, 3e38);
  CHECK(larger == ~std::uint64_t{0} && write.fault() == nullptr);
  write.set("single", single, -1e39);
  CHECK(write.fault() == std::string("single"));
  write.set("byte", byte, kNaN);
  CHECK(write.fault() == std::string("single"));
  FieldWriter other(false);
  other.set("byte", byte, kInfinity);
  CHECK(other.fault() == std::string("byte"));
}

void what_is_written_can_be_told() {
  double x = 0, y = 0, z = 0;
  std::int16_t count = 0;
  FieldWriter write(true);
  write.set("pose.position.x", x, 0.1);
  write.set("pose.position.y", y, kNaN);
  write.set("pose.orientation.z", z, 1e21);
  write.set("posed.count", count, Integer(70000));
  write.set("last", z, -2.0);
  CHECK(to_json(write) == R"({"last":-2,"pose":{"orientation":{"z":1e+21},"position":{"x":0.1,"y":null}},)"
                          R"("posed":{"count":32767}})");
  write.set("pose.position.x", x, 0.2);
  write.set("last", z, -1.0);
  CHECK(to_json(write) == R"({"last":-1,"pose":{"orientation":{"z":1e+21},"position":{"x":0.2,"y":null}},)"
                          R"("posed":{"count":32767}})");
  FieldWriter basic(true);
  basic.set("data", count, Integer(5));
  CHECK(to_json(basic) == "5");
  basic.set("data", count, Integer(6));
  CHECK(to_json(basic) == "6");
  CHECK(to_json(FieldWriter(true)) == "{}");
}

void what_is_required_is_finite() {
  FieldWriter write(false);
  write.require("x", 1.0F);
  CHECK(write.fault() == nullptr);
  write.require("y.z", kInfinity);
  write.require("x", kNaN);
  CHECK(std::string(write.fault()) == "y.z");
}

void elements_are_numbers_of_any_size_or_truth_values() {
  std::vector<std::int8_t> bytes;
  std::vector<bool> flags;
  FieldWriter write(true);
  write.set_elements("bytes", bytes, std::vector<std::uint8_t>{200, 7});
  write.set_elements("flags", flags, std::vector<bool>{true, false});
  CHECK(bytes == std::vector<std::int8_t>({127, 7}));
  CHECK(to_json(write) == R"({"bytes":[127,7],"flags":[true,false]})");
}

void json_is_json() {
  CHECK(to_json(true) == "true" && to_json(Integer(-3)) == "-3" && to_json(kInfinity) == "null");
  CHECK(to_json(0.1) == "0.1" && to_json(1.0 / 3) == "0.3333333333333333" && to_json(-0.0) == "-0");
  CHECK(to_json("a\"b\\c\n\x01") == R"("a\"b\\c\u000a\u0001")");
  CHECK(to_json("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x99\x82") == "\"\xc3\xa4 \xe2\x82\xac \xf0\x9f\x99\x82\"");
  // A lone byte, too long a form of `/`, half of a surrogate pair, a character cut off.
  CHECK(to_json("\xff") == R"("\ufffd")");
  CHECK(to_json("\xc0\xaf") == R"("\ufffd\ufffd")");
  CHECK(to_json("\xed\xa0\x80") == R"("\ufffd\ufffd\ufffd")");
  CHECK(to_json("\xe2\x82") == R"("\ufffd\ufffd")");
  CHECK(to_json(Json::object().add("a", Json::array().add(1.5).add("x")).add("b", Json::object())) ==
        R"({"a":[1.5,"x"],"b":{}})");
}

}  // namespace

/// With a second argument, its JSON; else what is wrong with the headers.
int main(int count, char** arguments) {
  if (count > 2) {
    std::fputs(to_json(arguments[2]).c_str(), stdout);
    return 0;
  }
  whole_numbers_saturate();
  logs_are_named_by_their_nodes();
  comparisons_with_nan_are_false();
  elements_that_are_not_there_are_noticed();
  fields_take_what_fits();
  what_is_written_can_be_told();
  what_is_required_is_finite();
  elements_are_numbers_of_any_size_or_truth_values();
  json_is_json();
  return faults;
}
