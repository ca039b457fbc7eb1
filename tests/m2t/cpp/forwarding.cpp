// Checks of a layer that applies limits: compiles the functions of a generated layer that forward a message, with
// stand-ins for the node and the message.
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cart_supervisor.h"
#include "checks.hpp"
#include "robosc/block_reasons.hpp"
#include "robosc/data.hpp"
#include "robosc/fields.hpp"

struct Vector {
  double x = 0.0, y = 0.0, z = 0.0;
};
namespace geometry_msgs::msg {
struct Twist {
  Vector linear, angular;
};
}  // namespace geometry_msgs::msg

namespace {

using namespace robosc;

#define RCLCPP_WARN_THROTTLE(...) static_cast<void>(0)

struct Relay {
  void publish(const geometry_msgs::msg::Twist& message) { sent.push_back(message); }
  std::vector<geometry_msgs::msg::Twist> sent;
};

struct Node {
  struct Log {
    bool active() const { return false; }
    void note(const FieldWriter& /*written*/) {}
    void write(double /*time*/, const char* /*direction*/, const char* /*event*/) {}
  };
  struct Data {
    struct Base {
      double most = 0.5;
    } Base;
  };

  double seconds() const { return 0.0; }
  void block(cart_event /*event*/, const char* /*name*/, const BlockReasons& reasons) {
    blocked.push_back(reasons.kind() + to_json(reasons.texts()));
  }

#include "forwarding.inc"

  cart_supervisor supervisor_{};
  Data data_;
  Log log_;
  Relay relay_, *velocity_relay_ = &relay_;
  geometry_msgs::msg::Twist velocity_message_;
  bool velocity_forwarded_ = false;
  std::vector<std::string> blocked;
};

geometry_msgs::msg::Twist twist(double x) {
  geometry_msgs::msg::Twist message;
  message.linear.x = x;
  message.angular.y = 7.0;
  return message;
}

}  // namespace

int main() {
  Node node;
  cart_init(&node.supervisor_, nullptr, nullptr);
  auto& sent = node.relay_.sent;
  CHECK(!node.forward_velocity(twist(2.0)) && sent.size() == 1 && sent[0].linear.x == 2.0);
  node.supervisor_.state.component_Person = cart_component_Person_near;
  node.forward_velocity(twist(2.0));
  CHECK(sent.size() == 2 && sent[1].linear.x == 0.3 && sent[1].angular.y == 7.0);
  CHECK(node.blocked.empty());
  node.forward_velocity(twist(std::numeric_limits<double>::quiet_NaN()));
  CHECK(node.blocked == std::vector<std::string>{R"(data["its linear.x would not be finite"])"});
  CHECK(sent.size() == 3 && sent[2].linear.x == 0.3 && sent[2].angular.y == 0.0);  // The message of onBlocked.
  return faults;
}
