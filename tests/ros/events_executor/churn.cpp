// Loads components into an executor and unloads them, while another process calls their services and sends messages.
//
// churn EXECUTOR ROUNDS LIBRARY...
//
// As in a container, the executor itself runs the function that loads and unloads. The caller has a process of its own,
// because Fast DDS may deliver a request within one process to a service that another thread destroys.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <class_loader/class_loader.hpp>
#include <cstdio>
#include <cstdlib>
#include <lifecycle_msgs/srv/change_state.hpp>
#include <lifecycle_msgs/srv/get_state.hpp>
#include <memory>
#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rclcpp/experimental/executors/events_executor/events_executor.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/node_factory.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/float64_multi_array.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#if __has_include(<rclcpp/executors/events_cbg_executor/events_cbg_executor.hpp>)
#include <rclcpp/executors/events_cbg_executor/events_cbg_executor.hpp>
#define HAS_CALLBACK_GROUP_EVENTS
#elif __has_include(<cm_executors/events_cbg_executor.hpp>)
#include <cm_executors/events_cbg_executor.hpp>
#define HAS_CALLBACK_GROUP_EVENTS
#endif

using namespace std::chrono_literals;

namespace {

std::shared_ptr<rclcpp::Executor> make_executor(const std::string& kind) {
  if (kind == "single") return std::make_shared<rclcpp::executors::SingleThreadedExecutor>();
  if (kind == "multi") return std::make_shared<rclcpp::executors::MultiThreadedExecutor>(rclcpp::ExecutorOptions(), 4);
  if (kind == "events") return std::make_shared<rclcpp::experimental::executors::EventsExecutor>();
#ifdef HAS_CALLBACK_GROUP_EVENTS
  if (kind == "events-cbg" || kind == "events-cbg-single") {
    const std::size_t threads = kind == "events-cbg" ? 4 : 1;
    return std::make_shared<rclcpp::executors::EventsCBGExecutor>(rclcpp::ExecutorOptions(), threads);
  }
#endif
  std::fprintf(stderr, "no executor %s\n", kind.c_str());
  std::exit(2);
}

/// Calls a service again and again, and does not wait for the answers.
template <typename Service>
struct Caller {
  Caller(rclcpp::Node& node, const std::string& name) : client(node.create_client<Service>(name)) {}

  void call(const typename Service::Request& request = typename Service::Request()) {
    if (!client->service_is_ready()) return;
    client->async_send_request(std::make_shared<typename Service::Request>(request),
                               [this](typename rclcpp::Client<Service>::SharedFuture) { ++answers; });
    if (++calls % 64 == 0) client->prune_pending_requests();
  }

  std::shared_ptr<rclcpp::Client<Service>> client;
  int calls = 0, answers = 0;
};

struct Callers {
  Callers(rclcpp::Node& node, const std::string& name)
      : get(node, name + "/get_parameters"),
        list(node, name + "/list_parameters"),
        describe(node, name + "/describe_parameters"),
        state(node, name + "/get_state"),
        change(node, name + "/change_state") {}

  void call() {
    rcl_interfaces::srv::GetParameters::Request wanted;
    wanted.names = {"period_ms"};
    get.call(wanted);
    list.call();
    rcl_interfaces::srv::DescribeParameters::Request described;
    described.names = {"period_ms"};
    describe.call(described);
    state.call();
    lifecycle_msgs::srv::ChangeState::Request transition;
    transition.transition.id = static_cast<std::uint8_t>(1 + 2 * (turn++ % 2));  // configure, activate
    change.call(transition);
  }

  int answers() const { return get.answers + list.answers + describe.answers + state.answers + change.answers; }

  Caller<rcl_interfaces::srv::GetParameters> get;
  Caller<rcl_interfaces::srv::ListParameters> list;
  Caller<rcl_interfaces::srv::DescribeParameters> describe;
  Caller<lifecycle_msgs::srv::GetState> state;
  Caller<lifecycle_msgs::srv::ChangeState> change;
  int turn = 0;
};

/// Calls the services of the nodes that `names` lists, until `names` is closed. Returns whether there was an answer.
bool call_all(int names, int argc, char** argv) {
  char text[4096] = {};
  if (read(names, text, sizeof(text) - 1) <= 0) return false;
  fcntl(names, F_SETFL, O_NONBLOCK);
  rclcpp::init(argc, argv);
  int answers = 0;
  {
    const auto caller = std::make_shared<rclcpp::Node>("caller");
    rclcpp::executors::SingleThreadedExecutor own;
    own.add_node(caller);
    std::vector<std::unique_ptr<Callers>> callers;
    std::istringstream words(text);
    for (std::string name; words >> name;) callers.push_back(std::make_unique<Callers>(*caller, name));
    const auto flag = caller->create_publisher<std_msgs::msg::Bool>("/wanted", 10);
    const auto other = caller->create_publisher<std_msgs::msg::Bool>("/pressed", 10);
    const auto order = caller->create_publisher<std_msgs::msg::Float64MultiArray>("/errand", 10);
    std_msgs::msg::Bool value;
    for (int turn = 0; read(names, text, 1) != 0; ++turn) {
      for (const auto& one : callers) one->call();
      value.data = turn % 2 == 0;
      flag->publish(value);
      other->publish(value);
      order->publish(std_msgs::msg::Float64MultiArray());
      own.spin_some();
      std::this_thread::sleep_for(500us);
    }
    for (const auto& one : callers) answers += one->answers();
  }
  rclcpp::shutdown();
  std::fprintf(stderr, "%d answers\n", answers);
  return answers > 0;
}

}  // namespace

int main(int argc, char** argv) {
  int ends[2];
  if (pipe(ends) != 0) return 2;
  const pid_t caller = fork();
  if (caller == 0) {
    close(ends[1]);
    return call_all(ends[0], argc, argv) ? 0 : 1;
  }
  close(ends[0]);
  const int names_to_caller = ends[1];
  rclcpp::init(argc, argv);
  auto executor = make_executor(argv[1]);
  const int rounds = std::atoi(argv[2]);
  std::vector<std::unique_ptr<class_loader::ClassLoader>> loaders;
  std::vector<std::shared_ptr<rclcpp_components::NodeFactory>> factories;
  for (int place = 3; place < argc; ++place) {
    loaders.push_back(std::make_unique<class_loader::ClassLoader>(argv[place]));
    const auto names = loaders.back()->getAvailableClasses<rclcpp_components::NodeFactory>();
    factories.push_back(loaders.back()->createInstance<rclcpp_components::NodeFactory>(names.at(0)));
  }

  const auto container = std::make_shared<rclcpp::Node>("container");
  std::vector<rclcpp_components::NodeInstanceWrapper> components;
  bool named = false;
  int round = 0, unloaded = 0;
  std::chrono::steady_clock::time_point until;
  const auto step = container->create_wall_timer(1ms, [&] {
    if (components.empty()) {
      std::string names;
      const auto options = rclcpp::NodeOptions().append_parameter_override("period_ms", 1);
      for (const auto& factory : factories) {
        components.push_back(factory->create_node_instance(options));
        executor->add_node(components.back().get_node_base_interface());
        names += std::string(components.back().get_node_base_interface()->get_fully_qualified_name()) + " ";
      }
      if (!std::exchange(named, true) && write(names_to_caller, names.data(), names.size()) < 0) std::abort();
      until = std::chrono::steady_clock::now() + 30ms + round % 40 * 1ms;
    } else if (std::chrono::steady_clock::now() > until) {
      for (auto& component : components) {
        executor->remove_node(component.get_node_base_interface());
        component = rclcpp_components::NodeInstanceWrapper();
        ++unloaded;
      }
      components.clear();
      if (++round == rounds) executor->cancel();
    }
  });
  executor->add_node(container);

  executor->spin();
  close(names_to_caller);
  int ended = 1;
  waitpid(caller, &ended, 0);
  executor->remove_node(container);
  executor.reset();
  std::printf("unloaded %d, answered %s\n", unloaded, ended == 0 ? "yes" : "no");
  rclcpp::shutdown();
}
