// Two generated controllers in one process, each with a queue and a thread of its own.
#define main scout_main
#include "scout_controller_node.cpp"
#undef main
#define main courier_main
#include "courier_controller_node.cpp"
#undef main

int main(int argc, char** argv) {
  ros::init(argc, argv, "two_in_one");
  ros::CallbackQueue scout_queue, courier_queue;
  ros::NodeHandle scout_node, courier_node;
  scout_node.setCallbackQueue(&scout_queue);
  courier_node.setCallbackQueue(&courier_queue);
  scout_controller::Controller scout(scout_node);
  courier_controller::Controller courier(courier_node);
  ros::AsyncSpinner scout_spinner(1, &scout_queue), courier_spinner(1, &courier_queue);
  scout_spinner.start();
  courier_spinner.start();
  ros::waitForShutdown();
  return 0;
}
