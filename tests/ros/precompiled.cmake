# What each node of ROS 1 includes is read once for all packages of the tests' workspace. CMake includes this at each
# `project`. What a node includes for its model alone is not here: where a package forgets it, its build fails.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang" OR CMAKE_CXX_COMPILER_VERSION VERSION_LESS 11)
  return()
endif()

set(headers ${CMAKE_CURRENT_LIST_DIR}/precompiled.hpp)
set(precompiled ${CMAKE_BINARY_DIR}/precompiled.pch)
if("${headers}" IS_NEWER_THAN "${precompiled}")
  separate_arguments(options NATIVE_COMMAND "${CMAKE_CXX_FLAGS}")
  execute_process(
    COMMAND ${CMAKE_CXX_COMPILER} -std=gnu++17 ${options} -DROSCONSOLE_BACKEND_LOG4CXX -DROS_BUILD_SHARED_LIBS=1
      -fpch-instantiate-templates -x c++-header ${headers} -o ${precompiled}
    COMMAND_ERROR_IS_FATAL ANY)
endif()
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include-pch ${precompiled}>")
