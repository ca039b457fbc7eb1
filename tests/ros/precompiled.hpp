// What each node of ROS 1 includes, whatever its model, and what the code generator adds to all but a few.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#include "robosc/block_reasons.hpp"
#include "robosc/component_status.hpp"
#include "robosc/data.hpp"
#include "robosc/event_log.hpp"
#include "robosc/json.hpp"
#include "robosc_ros1/controller_node.hpp"
#include "robosc_ros1/parameters.hpp"
#include "robosc_ros1/report.hpp"
#include "robosc_ros1/run_controller.hpp"
