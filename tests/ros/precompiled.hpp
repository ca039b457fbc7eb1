// Headers that each ROS 1 node includes, and headers that the code generator adds to all but a few nodes.
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
