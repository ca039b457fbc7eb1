include(${CMAKE_CURRENT_LIST_DIR}/find-robosc.cmake)

# robosc_generate_controller(<model> [CONFIG <file>] [LIBRARY_PATH <folder>...] [INTERFACE_PATH <folder>...] [TESTS])
#
# Adds the controller node of a model's robot to this package: executable, launch file, parameters. Call it before
# catkin_package(), which exports its engine. If the model uses types of this package, call it after
# generate_messages().
#
# @public
macro(robosc_generate_controller)
  if(${PROJECT_NAME}_CATKIN_PACKAGE)
    message(FATAL_ERROR
      "robosc_generate_controller() must be called before catkin_package() in project '${PROJECT_NAME}'")
  endif()
  if(NOT _CATKIN_CURRENT_PACKAGE)
    catkin_package_xml()
  endif()
  catkin_destinations()
  _robosc_generate_controller(${ARGV})
endmacro()

# A function, so that the packages it finds do not replace those of the calling package.
function(_robosc_generate_controller)
  # Definitions in this package take precedence, then those of a workspace that catkin_make builds as one project.
  robosc_generate(fragment ros1 ${PROJECT_NAME} ${ARGV} INTERFACE_PATH
    "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_SOURCE_DIR}")
  include("${fragment}")
  foreach(kind INCLUDE_DIRS LIBRARIES)
    set(${PROJECT_NAME}_${kind} ${${PROJECT_NAME}_${kind}} PARENT_SCOPE)
  endforeach()
endfunction()
