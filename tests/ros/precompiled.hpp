// What each node of ROS 1 includes, whatever its model, and what the code generator adds to all but a few.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#include "robosc/block_reasons.hpp"
#include "robosc/component_status.hpp"
#include "robosc/data.hpp"
#include "robosc/event_log.hpp"
#include "robosc/json.hpp"
#include "robosc_ros1/countdown.hpp"
#include "robosc_ros1/graph_monitor.hpp"
#include "robosc_ros1/interruption.hpp"
#include "robosc_ros1/parameters.hpp"
