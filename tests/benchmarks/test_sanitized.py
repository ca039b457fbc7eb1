"""Attribution of sanitizer reports, and the page with the last result."""

from __future__ import annotations

import json

from benchmarks.sanitized import PAGE, RESULTS, page, sorted_reports

OURS = """==================
WARNING: ThreadSanitizer: data race (pid=1)
  Write of size 8 at 0x7b38 by thread T14:
    #0 operator delete(void*) <null> (libtsan.so.2+0x8)
    #1 std::vector<int>::~vector() /usr/include/c++/12/bits/stl_vector.h:367 (a.so+0x1)
    #2 usher_layer::Layer::~Layer() /ws/usher_layer/src/usher_layer_node.cpp:14 (a.so+0x2)

  Previous read of size 8 at 0x7b38 by main thread:
    #0 rclcpp::Executor::spin() /src/rclcpp/executor.cpp:2 (librclcpp.so+0x3)

SUMMARY: ThreadSanitizer: data race /usr/include/c++/12/bits/stl_vector.h:367 in std::vector<int>::~vector()
==================
"""
#: The race is inside rclcpp; generated code only calls it.
THEIRS = OURS.replace("    #1", "    #1 rclcpp::Node::~Node() /src/rclcpp/node.cpp:7 (librclcpp.so+0x4)\n    #1")
LOCKS = THEIRS.replace("data race", "lock-order-inversion (potential deadlock)")
#: roscpp takes all locks; generated code is only the caller.
ROSCPP = LOCKS.replace("#0 rclcpp", "#0 ros::Connection::drop() <null> (libroscpp.so.4d+0x5)\n    #1 rclcpp").replace(
    "#1 rclcpp::Node::~Node() /src/rclcpp/node.cpp:7 (librclcpp.so+0x4)",
    "#1 ros::Connection::read() <null> (libroscpp.so.4d+0x4)",
)
#: rclcpp logs in its signal handler.
INTERRUPTED = LOCKS.replace(
    "#0 rclcpp",
    "#0 rclcpp_logging_output_handler /src/rclcpp/context.cpp:3 (librclcpp.so+0x6)\n"
    "    #1 rcutils_log_internal <null> (librcutils.so+0x7)\n"
    "    #2 CallUserSignalHandler /src/tsan_interceptors_posix.cpp:4 (libtsan.so.2+0x8)\n"
    "    #3 rclcpp",
)
UNDEFINED = "/ws/x.c:3:4: runtime error: signed integer overflow\n    #0 0x1 in f /ws/x.c:3\n"


def test_a_report_belongs_to_who_does_it() -> None:
    race = "ThreadSanitizer: data race stl_vector.h:367 in std::vector<int>::~vector()"
    assert sorted_reports([OURS, OURS]) == ({race: 2}, {})
    order = race.replace("data race", "lock-order-inversion (potential deadlock)")
    assert sorted_reports([THEIRS]) == ({}, {race: 1})
    assert sorted_reports([LOCKS]) == ({order: 1}, {})
    assert sorted_reports([ROSCPP, INTERRUPTED]) == ({}, {order: 2})
    assert sorted_reports([UNDEFINED, ""]) == ({"runtime error: signed integer overflow": 1}, {})


def test_the_page_tells_the_last_result() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(json.loads(RESULTS.read_text(encoding="utf-8")))
