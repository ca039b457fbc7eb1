// Checks of limits and of provided data that chooses between objects and arrays: compiles the functions of a generated node that
// prepare its messages, with stand-ins for the node and its messages.
#include <initializer_list>
#include <string>
#include <vector>

#include "checks.hpp"
#include "chooser_supervisor.h"
#include "robosc/data.hpp"
#include "robosc/fields.hpp"

struct Vector {
  double x = 0.0, y = 0.0, z = 0.0;
};
namespace geometry_msgs::msg {
struct Twist {
  Vector linear, angular;
};
struct Pose {
  Vector position;
};
}  // namespace geometry_msgs::msg
namespace std_msgs::msg {
struct Float64MultiArray {
  std::vector<double> data;
};
struct Float32 {
  float data = 0.0F;
};
}  // namespace std_msgs::msg

namespace robosc {
inline namespace ROBOSC_VERSION {
template <typename Data>
bool finite(const Data&, OfRos) {
  return true;
}
}  // namespace ROBOSC_VERSION
}  // namespace robosc

namespace {

using namespace robosc;

#define RCLCPP_WARN_THROTTLE(...) ++warnings_

struct Node {
  struct Log {
    bool active() const { return true; }
    void note(const FieldWriter& written) { line = to_json(written); }
    std::string line;
  };
  struct Data {
    struct Base {
      bool trusted = true;
      double distance = 0.3;
      geometry_msgs::msg::Pose first, second;
      Vector stored;
      std::vector<double> gains;
    } Base;
    struct Parameters {
      double reach = 0.5;
    } parameters;
  };

  int now() const { return 0; }
  template <typename... Parts>
  void set_headers(Parts&&...) {}

#include "chooser.inc"

  chooser_supervisor supervisor_{};
  Data data_;
  Log log_;
  int warnings_ = 0;
  geometry_msgs::msg::Twist velocity_message_, nested_message_;
  geometry_msgs::msg::Pose aim_message_;
  std_msgs::msg::Float64MultiArray gain_message_, smoothed_message_;
  geometry_msgs::msg::Twist slowed_message_;
  std_msgs::msg::Float32 level_message_;
};

void each_branch_sets_its_own_fields(Node& node) {
  CHECK(node.prepare_velocity());
  CHECK(node.log_.line == R"({"angular":{"z":1},"linear":{"x":0.3}})");
  node.supervisor_.state.component_Person = chooser_component_Person_near;
  CHECK(node.prepare_velocity());
  CHECK(node.log_.line == R"({"linear":{"x":0.1}})");
  CHECK(node.velocity_message_.angular.z == 0.0);
}

void inner_choices_follow_outer_ones(Node& node) {
  CHECK(node.prepare_nested() && node.nested_message_.linear.x == 0.1);
  node.data_.Base.distance = 2.0;
  node.data_.Base.stored.z = 7.0;
  CHECK(node.prepare_nested() && node.nested_message_.linear.z == 7.0 && node.nested_message_.linear.x == 0.0);
  node.supervisor_.state.component_Person = chooser_component_Person_away;
  CHECK(node.prepare_nested() && node.nested_message_.linear.y == 3.0 && node.nested_message_.linear.z == 0.0);
  CHECK(node.nested_message_.angular.z == 0.5);
}

void stored_objects_are_chosen(Node& node) {
  node.data_.Base.first.position.x = 1.0;
  node.data_.Base.second.position.x = 2.0;
  CHECK(node.prepare_aim() && node.aim_message_.position.x == 2.0);
  node.supervisor_.state.component_Person = chooser_component_Person_near;
  CHECK(node.prepare_aim() && node.aim_message_.position.x == 1.0);
}

void arrays_are_chosen(Node& node) {
  CHECK(!node.prepare_gain() && node.warnings_ == 1);
  node.data_.Base.gains = {0.5};
  CHECK(node.prepare_gain() && node.gain_message_.data == std::vector<double>({1.0, 0.5}));
  node.data_.Base.gains = {2.0, 0.5, 3.0};
  CHECK(node.prepare_gain() && node.gain_message_.data.empty());
  node.supervisor_.state.component_Person = chooser_component_Person_away;
  CHECK(node.prepare_gain() && node.gain_message_.data == node.data_.Base.gains);
}

void limits_change_what_is_sent(Node& node) {
  node.data_.Base.distance = 2.0;
  CHECK(node.prepare_slowed() && node.slowed_message_.linear.x == 0.0 && node.slowed_message_.linear.z == 2.0);
  CHECK(node.slowed_message_.linear.y == 1.0 && node.slowed_message_.angular.z == 0.5);
  CHECK(node.log_.line == R"({"angular":{"z":0.5},"linear":{"x":0,"y":1,"z":2}})");
  node.data_.Base.distance = 0.25;
  node.data_.Base.stored.y = 9.0;
  CHECK(node.prepare_slowed() && node.slowed_message_.linear.y == 9.0 && node.slowed_message_.angular.z == 0.25);
  CHECK(node.log_.line == R"({"angular":{"z":0.25}})");
  node.data_.Base.distance = 1.0 / 0.0;
  CHECK(!node.prepare_slowed());
}

void a_limited_number_is_not_above_its_limit(Node& node) {
  node.data_.Base.distance = 2.0;
  CHECK(node.prepare_level() && node.level_message_.data == 0.6F && node.log_.line == "0.6000000238418579");
  node.data_.parameters.reach = 0.1;
  node.data_.Base.distance = 0.1;
  CHECK(node.prepare_level() && node.level_message_.data == 0.0F);
}

void limits_read_arrays(Node& node) {
  node.warnings_ = 0;
  CHECK(node.prepare_smoothed() && node.smoothed_message_.data.empty());
  auto& data = node.smoothed_message_;
  FieldWriter write(false);
  ArrayReader read;
  data.data = {0.0, 3.0, 2.0};
  node.limit_smoothed(data, write, read);
  CHECK(read.complete() && write.fault() == nullptr && data.data == std::vector<double>({3.0, 2.0}));
  node.limit_smoothed(data, write, read);
  CHECK(!read.complete());
  data.data[1] = 0.0 / 0.0;
  node.limit_smoothed(data, write, read);
  CHECK(std::string(write.fault()) == "data");
}

}  // namespace

int main() {
  Node node;
  node.supervisor_.state.data_velocity = chooser_data_velocity_d1;
  node.supervisor_.state.data_nested = chooser_data_nested_d1;
  node.supervisor_.state.data_aim = chooser_data_aim_d1;
  node.supervisor_.state.data_gain = chooser_data_gain_d1;
  each_branch_sets_its_own_fields(node);
  inner_choices_follow_outer_ones(node);
  stored_objects_are_chosen(node);
  arrays_are_chosen(node);
  node = Node();
  node.supervisor_.state.data_slowed = chooser_data_slowed_d1;
  node.supervisor_.state.data_level = chooser_data_level_d1;
  limits_change_what_is_sent(node);
  a_limited_number_is_not_above_its_limit(node);
  limits_read_arrays(node);
  return faults;
}
