# robosc_generate_controller(<model> [CONFIG <file>] [LAYER] [LIBRARY_PATH <folder>...] [INTERFACE_PATH <folder>...]
#                            [TESTS])
#
# Adds the controller node of a model's robot to this package, or with LAYER its supervisory layer: component,
# executable, launch file, parameters. Call it before ament_package().
#
# @public
macro(robosc_generate_controller)
  # A macro, because ament and rclcpp_components collect data for ament_package() in variables.
  if(NOT _AMENT_PACKAGE_NAME)
    ament_package_xml()
  endif()
  # Definitions in this package take precedence.
  robosc_generate(_robosc_fragment ros2 ${PROJECT_NAME} ${ARGV} INTERFACE_PATH "${CMAKE_CURRENT_SOURCE_DIR}")
  include("${_robosc_fragment}")
endmacro()
