# robosc_generate_controller(<model> [CONFIG <file>] [LAYER] [LIBRARY_PATH <folder>...] [INTERFACE_PATH <folder>...]
#                            [TESTS])
#
# Makes the node that controls the robot of a model, or with LAYER its supervisory layer, a part of this package:
# component, executable, launch file, parameters. Before ament_package().
#
# @public
macro(robosc_generate_controller)
  # A macro, since ament and rclcpp_components collect in variables what ament_package() writes.
  if(NOT _AMENT_PACKAGE_NAME)
    ament_package_xml()
  endif()
  # The definitions in this package count before others.
  robosc_generate(_robosc_fragment ros2 ${PROJECT_NAME} ${ARGV} INTERFACE_PATH "${CMAKE_CURRENT_SOURCE_DIR}")
  include("${_robosc_fragment}")
endmacro()
