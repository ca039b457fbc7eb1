// Checks of what a node tells about its state. Prints what does not hold, as `headers.cpp`.
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "robosc/absolute_names.hpp"
#include "robosc/block_reasons.hpp"
#include "robosc/json.hpp"
#include "robosc/transitions.hpp"

namespace {

using namespace robosc;

void the_last_are_kept() {
  Transitions transitions;
  CHECK(transitions.empty());
  transitions.add("first");
  CHECK(transitions.report("Robot", 1.5, Json::object()) ==
        R"({"robot":"Robot","time":1.5,"components":{},"transitions":["first"]})");
  for (std::size_t count = 0; count < kTransitionsKept; ++count) transitions.add("more");
  const std::string told = transitions.report("Robot", 1.5, Json::object());
  CHECK(told.find("first") == std::string::npos && told.find("more") != std::string::npos);
  transitions.clear();
  CHECK(transitions.empty());
}

void all_who_listen_are_told() {
  Audience audience;
  CHECK(!audience.waits(0, true));
  CHECK(audience.waits(1, false));
  CHECK(!audience.waits(1, false));
  CHECK(audience.waits(1, true));
  CHECK(!audience.waits(0, true));
  CHECK(audience.waits(1, false));
}

void what_is_blocked_is_told_with_its_reason() {
  BlockReasons reasons;
  reasons.add_state("Base.parked");
  CHECK(reasons.report("Robot", 2.5, "go", "Base.go", Json::object()) ==
        R"({"robot":"Robot","time":2.5,"name":"go","event":"Base.go","reason":"state","because":["Base.parked"],"components":{}})");
}

void names_outside_of_a_namespace_are_told() {
  const std::vector<std::pair<std::string, std::string>> names = {
      {"/scan", "/scan"}, {"/stop", "/left/stop"}, {"/go", "/leftover/go"}};
  CHECK(names_outside("/left", names) == "/scan, /go");
  CHECK(names_outside("/", names).empty() && names_outside("", names).empty());
}

}  // namespace

int main() {
  the_last_are_kept();
  all_who_listen_are_told();
  what_is_blocked_is_told_with_its_reason();
  names_outside_of_a_namespace_are_told();
  return faults;
}
