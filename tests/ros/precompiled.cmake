# Precompile the headers that each ROS 1 node includes, once for all packages of the tests' workspace. CMake includes
# this file at each `project`. Headers that a node includes for its model are not precompiled, so the build fails if one
# is missing. `test_gcc_has_nothing_to_say` precompiles nothing, so it finds missing includes of precompiled headers.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang" OR CMAKE_CXX_COMPILER_VERSION VERSION_LESS 11)
  return()
endif()

set(headers ${CMAKE_CURRENT_LIST_DIR}/precompiled.hpp)
set(precompiled ${CMAKE_BINARY_DIR}/precompiled.pch)
get_filename_component(include ${CMAKE_CURRENT_LIST_DIR}/../../robosc/m2t/ros/include ABSOLUTE)
file(GLOB_RECURSE shared ${include}/*.hpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers} ${shared})
set(old FALSE)
foreach(header ${headers} ${shared})
  if("${header}" IS_NEWER_THAN "${precompiled}")
    set(old TRUE)
  endif()
endforeach()
if(old)
  separate_arguments(options NATIVE_COMMAND "${CMAKE_CXX_FLAGS}")
  execute_process(
    COMMAND ${CMAKE_CXX_COMPILER} -std=gnu++17 ${options} -DROSCONSOLE_BACKEND_LOG4CXX -DROS_BUILD_SHARED_LIBS=1
      -I${include} -fpch-instantiate-templates -x c++-header ${headers} -o ${precompiled}
    COMMAND_ERROR_IS_FATAL ANY)
endif()
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include-pch ${precompiled}>")
