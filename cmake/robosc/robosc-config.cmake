# find_package(robosc): the supervisor of a model, in C99, as a target. For projects without ROS.
include(${CMAKE_CURRENT_LIST_DIR}/find-robosc.cmake)
